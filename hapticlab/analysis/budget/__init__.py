"""A design under a budget: method, step, hold, estimator and law of one scene, measured in three figures.

In: a task (a scene, a motion of the handle, a paddle and a board) and designs as plain data. Out: the error at the handle,
the load of the board and the passivity margin of each design, and the designs that no other one dominates. Read ``task``,
``tasks`` and ``design``, then ``measured``, ``front`` and ``front_plot``.
"""
