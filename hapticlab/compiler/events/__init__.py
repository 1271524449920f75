"""Motion with switches and impacts inside a step: Taylor series, and the instant at which a mode ends.

In: the dynamics of a scene, traced. Out: the step of method "taylor" or of a switched linear scene.
Read ``taylor_series`` (recurrences), ``flow`` (the polynomial of one piece), ``guards`` (a comparison as a mode and the
instant that ends it) and ``located_step`` (from one instant to the next), then ``taylor_method`` with ``series_checks``
and ``series_error``, which choose the order; ``switched_linear`` and ``chord_bound`` for linear pieces.
"""
