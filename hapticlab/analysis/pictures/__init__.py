"""Drawings of a scene: its schematic, its shapes and walls, its formulas in plain text.

In: a scene. Out: a figure, sentences for who cannot see it, or data that a page draws from.
Read ``pictures`` first, then ``schematic`` with ``layout``, what both read off the equations (``elements``, ``row_of_bodies``,
``wall_boundaries``, ``shape_outlines``, ``plain_formulas``), ``force_field``, and ``painting``. ``recording`` writes down how
a picture moves, for pages without Python: by ``graph``, ``array_functions`` and ``graph_data``.
"""
