"""The simulated paddle: its plant traced to a program, linked to the scene's, and run in virtual time.

In: a scene's program, a paddle's profile, a hand. Out: ``Telemetry``, the same as a real paddle gives.
Read ``simulated_paddle`` (what the user calls), ``plant`` with ``transition``, ``friction`` and ``stepping``,
``closed_loop`` (plant and scene in one program), ``unused_states`` and ``not_finite``; ``moved_handle`` for a motion
that is given; ``lanes`` for many at once.
"""
