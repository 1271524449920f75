"""What a student sees of an error: the own line, and a sentence that names mistake and cure.

In: an exception and its traceback. Out: text, or nothing where neither hapticlab nor what it hands out is involved.
Read `own_line`, then `foreign`, the table of what other libraries say, `swallowed`, and `shown`.
"""
