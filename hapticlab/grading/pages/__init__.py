"""Pages of a graded class: one for the class, one a student, with figures.

In: reports. Out: HTML files that open without a network; whatever a student wrote is escaped.
Read ``pages`` and ``page_text``, ``class_page`` and ``student_page``, ``failing_case``, ``case_figures`` and
``page_figures``.
"""
