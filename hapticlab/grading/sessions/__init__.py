"""Processes that run a student's code: how they start, what they may take, how they are asked.

In: cells of a submission. Out: answers as plain data, or why there is none.
Read ``limits`` and ``starter``, ``preloaded`` and ``spawned`` (two ways to start), ``memory_group``, then ``asking``.
The code on the other side stands in ``grading.inside``.
"""
