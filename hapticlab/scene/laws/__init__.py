"""The chapter's force laws, and those of the papers on passive and stable walls.

In: parameters. Out: expressions of x(n), v(n) and past samples, which a ``Scene`` takes as its force.
Read ``chapter_laws`` and ``taps`` (past samples), ``estimators``, ``kalman`` and ``adaptive_window`` (velocity),
``compensation``, ``entry_pulse``, ``passivity_control``, ``fixtures`` and ``proxy``.
"""
