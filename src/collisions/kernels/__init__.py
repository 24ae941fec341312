"""Formulas on floats or arrays, one model per file, without units, vehicles or errors.

A kernel is called with floats, with arrays, and by ``tracing`` with operands that note what is done to them. So it uses only
+ - * /, ``abs``, ``x ** 0.5``, comparisons, & and |, and ``select`` to choose between values; ``if`` asks its settings alone.
Not is written ``condition ^ True``: of a Python truth ``~`` makes a number, and ``~True`` counts as true.
The condition ``fine``, under which a case is OK without more ado, must deny every refusal: where it holds, none is looked for.
Every output goes into the sum that finds overflow, itself, times 0, or as a part of another: else an infinite one passes as OK.
"""
