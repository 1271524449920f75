"""What students handed in, from the platforms' archives to one file a person.

In: folders, zips and rosters of any platform; nothing of it runs here. Out: one submission a student, and a reply for
each that was left out.
Read ``archives``, ``folders`` and ``naming``, ``file_choice``, ``notebook_text`` and ``submission``; ``roster`` and
``replies``.
"""
