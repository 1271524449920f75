"""Labs as assignments of other systems.

In: a lab's notebook with its marks. Out: sources for nbgrader, otter, Gradescope and PrairieLearn, and grades read back.
Read ``answer_cells`` first, then the system you need: ``nbgrader_source``, ``otter_source``, ``gradescope_zip`` or
``prairielearn_question``; ``gradebook`` writes nbgrader's.
"""
