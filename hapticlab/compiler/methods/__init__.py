"""Integration methods: the textbook's steps, tabled, and what each is worth.

In: a function that gives accelerations. Out: the state one step later.
Read ``method_table`` first, then ``steps`` and ``multistep``; ``implicit_damping`` and ``exact_linear`` do what no
table can say; ``method_checks`` refuses what would lose its order; ``force_timing`` says when in the period the force is
evaluated; ``stability_region`` and ``step_matrix`` say how long a step may be.
"""
