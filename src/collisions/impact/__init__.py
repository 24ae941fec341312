"""The impact: its inputs, the solvers, and the answer with everything that is worked
out from it.
"""
