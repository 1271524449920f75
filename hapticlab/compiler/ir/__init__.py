"""The straight-line program: its instructions, its checks, and the builder that traces it.

In: Python arithmetic on traced values. Out: a verified ``Program`` of two blocks, ``init`` and ``tick``.
Read ``program`` first, then ``trace`` and ``simplify`` (what is folded while it is written), ``elementary`` (sin, cos,
exp ... over add, multiply and the like), ``structural_zeros``, ``conditions``, ``channels`` and ``options``; ``cache``
keeps what was compiled before.
"""
