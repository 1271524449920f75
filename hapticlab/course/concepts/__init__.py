"""The concept inventory: questions about eight concepts, whose every wrong option is a named misconception.

In: a seed, a student's name and an occasion. Out: that student's questions with own numbers and an own order of options, and
the notebook that asks them. Read ``question``, ``misconceptions``, one concept such as ``leak``, ``inventory`` and
``questionnaire``. ``docs/teaching/concepts.md`` is for instructors.
"""
