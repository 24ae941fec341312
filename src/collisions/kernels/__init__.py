"""Formulas on floats or arrays, one model a file; nothing here knows of units, vehicles or errors."""
