"""Impedance at the handle, and models reduced to what can be felt.

In: a scene. Out: curves over frequency, peaks, and chains of masses with the same impedance.
Read ``impedance`` and ``impedance_curve``; ``reduction`` with ``mass_chain``, ``moment_matching`` and
``impedance_peaks``; ``reduction_plot``.
"""
