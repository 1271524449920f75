"""Questions about a scene that need no run of a paddle: what it requires, its order, its replay.

Read ``requires`` and ``requirement_report``, ``replay`` (the parts that the force did not need, after the fact),
``felt_difference`` with ``thresholds`` and its figure (what else may be left out without a hand noticing),
``error_order`` and ``method_comparison``.
"""
