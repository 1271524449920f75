"""BLIND COMPARISONS in a notebook: a task and a procedure go in, presentations are felt, and answers come out.

``comparison`` has the trials and what a page may do to them, ``head`` the widget that leads through them.
"""
