"""Formulas on floats or arrays, one model per file, without units, vehicles or errors.

A kernel is called with a ``Problem`` of floats, of arrays, and by ``tracing`` of operands that
record each operation. So it uses only + - * /, ``abs``, ``x ** 0.5``, comparisons, & and |, and
``select`` to choose between values; ``if`` tests settings, what is None, and ``all_zero`` only.
"Not" is written ``condition ^ True``: ``~`` turns a Python bool into an int, and ``~True`` counts
as true. The condition ``ok`` of the final select(ok, OK, ...) must exclude every refusal: where it
holds, the others are not tested. In a case that has an answer no branch that is not taken may
divide by 0, hold an infinite number or take the root of 0: JAX multiplies what such a branch gives
by 0, and its derivative would be NaN. Every output goes into the sum that finds overflow, itself,
times 0, or as a part of another: else an infinite one passes as OK.
"""
