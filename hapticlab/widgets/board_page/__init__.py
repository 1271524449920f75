"""The page of a real paddle, which drives a board by Web Serial: in a site alone, never in a shared file or a notebook.

In: scenes that fit boards. Out: one HTML page, its programs compiled. Read ``programs``, then ``page``; what the page does is
in ``browser/board``, of which ``messages.js`` is written from the tables of Python.
"""
