"""What a recorded run shows: chatter, energy at the port and in storage, and plots of it.

In: ``Telemetry``. Out: findings that print as sentences, arrays, figures.
Read ``energy``, ``energy_books``, ``storage``, ``staircase`` and ``passivity_trace``; ``chatter`` with
``chatter_signs``, ``chatter_end`` and ``chatter_findings``; ``driven_motion``; ``plots`` and ``finding_plots``.
"""
