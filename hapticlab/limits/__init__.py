"""WHAT IS PROMISED: passivity, stability and design limits of a law on a sampled paddle, from theory.

In: a law, by name, as a scene, as a ``LinearLaw`` or as a function of K, and the constants of a paddle and its hand. Out:
a ``Limit``, which says what it guarantees and what it assumes, or a table, a design or a figure of limits.

Read ``limit`` first. A law becomes numbers in ``port`` (one tick of its program, measured on unit states), ``linear_law``
(one law) and ``affine_law`` (a law whose stiffness is still free).

Passivity holds in every passive hand: ``passivity`` (Eq. 23.10 and its search), ``colgate`` (any linear law, frequency by
frequency), ``nyquist_disk`` and ``indices`` (the same condition drawn as a disk, and as two numbers), ``excess`` (a ledger
of all parts, for nonlinear laws too) with ``local_stiffness``, the slopes that the ledger takes.

Stability holds for one paddle in one hand: ``loop`` (the sampled loop as a matrix), ``stability`` and ``root_locus``.

``bounds`` sets the bounds that carry an author's name side by side. ``two_port`` has the criterion for displays between a
hand and an environment; ``coupler`` and ``admittance`` design by it. ``coupled`` is about two
paddles that are coupled with each other. ``plots`` draws the results.
"""
