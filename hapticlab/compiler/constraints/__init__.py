"""Constraints while a program runs: a closed form, multipliers, or Newton's method.

In: the constraints of an ``ExplicitForm``. Out: accelerations and states that keep them.
Read ``enforcement_choice`` (which way, and why), ``multipliers`` (the linear algebra all three share),
``loop_embedding`` (closed forms), ``enforcement`` (what runs), and ``felt_mass`` (what the handle feels of it).
"""
