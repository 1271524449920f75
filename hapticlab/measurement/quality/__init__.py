"""The quality of one paddle: everything that was measured of it, as a record, a file, a page, and pages of a class.

In: a paddle with its profile, and results of ``hl.measure`` and ``hl.velocity.compare``. Out: a record that is saved as
JSON and written as one HTML file, and the comparison of a folder of such records.
Read ``record``, ``join``, ``record_file``, ``figures``, ``page``, ``comparison`` and ``comparison_page``.
"""
