"""Rigid shapes in the plane and the gaps between them: the geometric model of Fig. 23.7.

In: shapes placed by coordinates. Out: signed gaps with normals, as expressions.
Read ``plane``, ``shapes`` and ``polygons``, then ``gaps``, ``curves`` and ``closest_points``.
"""
