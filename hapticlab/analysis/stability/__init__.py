"""Limits of a given scene on a given paddle: linear, passive, or by trial.

In: a scene, a paddle, an operating point. Out: a limit that says what it is.
Read ``operating_points``, ``linearization`` and ``slopes``; ``condition_switches`` and ``switch_states``; ``step_limit``;
``port_passivity`` with ``passive_hands``, ``port_limits`` and ``limit_plots``; ``closed_motions``, ``motion_search`` and
``worst_motion``; ``trial_limits``.
"""
