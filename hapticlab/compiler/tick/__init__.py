"""From a scene to its program: one tick in the order it runs.

In: a ``Scene``, a method, a sampling period. Out: a ``Program`` with its notes. Read ``compile_scene`` (what the user
calls, and the force of samples alone) with ``source``, ``leaf_values``, ``handle_samples`` and ``program_builder``:
that is all for a wall. A scene that moves goes through ``motion_program`` (sample, force, outputs, motion) and
``dynamics`` (the accelerations in one state, one period of them); ``live_stability`` and ``live_limits`` say how far
each live parameter may go. What a part needs is passed to it, and what it makes is returned.
"""
