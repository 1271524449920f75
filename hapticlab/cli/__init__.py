"""The command line: ``hapticlab`` and its commands.

In: arguments. Out: printed sentences, or JSON for a program, and an exit code of ``exits``.
Read ``main`` (which command stands where) and ``options`` (what commands share), ``scene_file``
(a scene in a file of its own), then the command you look for: ``assign``, ``board``, ``demo``, ``grade`` (started by
``grade_start``), ``labs`` or ``scenes``.
"""
