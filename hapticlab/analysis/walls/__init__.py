"""Maps of virtual walls: where stiffness and damping stay quiet, and which law does best.

In: a wall law, a paddle, a hand. Out: maps over stiffness and damping, with the theory's limits drawn in.
Read ``wall_map``, ``wall_regions``, ``wall_limits`` and ``wall_map_plot``; ``law_limits`` and ``compare_laws``.
"""
