"""Mathematics on expressions, instructions and numbers; nothing here knows of scenes.

In: SymPy expressions, instructions of a program, arrays of traced values. Out: the same, solved or differentiated.
Read ``expressions`` and ``graph`` (SymPy to values) first, with ``constants`` (numbers), ``phase`` (large angles) and
``first_sample``; then ``differentiate``, ``derivative_builder`` and ``tangents`` (derivatives three ways);
``linear_solve``, ``complementarity`` and ``matrix_exponential``; ``ranges`` (interval arithmetic); ``gjk`` and
``polygon_distance`` (distances); ``polynomial_crossing`` (the first root).
"""
