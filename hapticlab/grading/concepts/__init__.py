"""What a class learned: answers to the concept inventory before and after a course, their statistics, and the pages of both.

In: folders of notebooks, which are read as text and never run. Out: a page of the class, one for each student, two tables.
Read ``paper``, ``item_statistics``, ``class_summary``, ``pages``; ``simulated_students`` writes a class to try it with.
"""
