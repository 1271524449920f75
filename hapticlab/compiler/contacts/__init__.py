"""Contacts of a scene: which can meet, what force they give, and what happens in the instant of a blow.

In: the contacts and coordinates of an ``ExplicitForm``. Out: terms of the motion, and impacts for the located step.
Read ``broad_phase`` (pairs that can meet), ``scene_contacts`` (what the dynamics know of them), ``contact_starts`` and
``contact_steps`` (checks), ``coordinate_bounds`` and ``constant_checks``; then ``impacts``, ``touch`` and ``impulses``.
"""
