"""Questions about a scene that need no run of a paddle: what it requires, its order, its replay.

Read ``requires`` and ``requirement_report``, ``replay`` (the parts that the force did not need, after the fact),
``error_order`` and ``method_comparison``.
"""
