"""Drawings of a scene: its schematic, its shapes and walls, its formulas in plain text.

In: a scene. Out: a figure, or sentences for who cannot see it.
Read ``pictures`` first, then ``schematic``, what it reads off the equations (``elements``, ``wall_boundaries``,
``shape_outlines``, ``plain_formulas``), ``layout``, ``force_field`` and ``painting``.
"""
