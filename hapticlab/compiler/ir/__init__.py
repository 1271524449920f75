"""The straight-line program: its instructions, its checks, and the builder that traces it.

In: Python arithmetic on traced values. Out: a verified ``Program`` of two blocks, ``init`` and ``tick``.
Read ``program`` first, then ``operations``: a record of each operation, with its ``simplify`` rule, its Taylor series
(``recurrences``) and, for sin, cos, exp ..., its arithmetic (``elementary``). ``trace`` records programs, written in
``values``, ``structural_zeros`` and ``conditions``; then ``channels`` and ``options``. ``cache`` keeps what was compiled
before.
"""
