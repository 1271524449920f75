"""A class is graded: submissions, the processes that run them, the reports, and what other systems read of these.

``inside`` runs beside a student's code and knows no answer; all other modules run in the grader's own process.
"""
