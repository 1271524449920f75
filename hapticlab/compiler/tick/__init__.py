"""From a scene to its program: one tick in the order it runs.

In: a ``Scene``, a method, a sampling period. Out: a ``Program`` with its notes.
Read ``compile_scene`` (what the user calls), ``lowering`` (the tick: sample, force, outputs, motion),
``handle_samples``, ``dynamics`` (the accelerations in one state), ``program_builder``; then ``live_stability`` and
``live_limits``, which say how far each live parameter may go.
"""
