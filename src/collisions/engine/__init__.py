"""What makes the formulas quick: they are recorded once, and run as blocks of a batch, as plain
floats, or as JavaScript.
"""
