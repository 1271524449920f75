"""What of a scene can be left out, and whether what is left has an answer; all of it before a program is built.

In: an ``ExplicitForm``. Out: a smaller one, facts about it (which parts are linear, which coefficients are constant),
or the error that says why it cannot run.
Read ``excluded_modes`` and ``constraint_lengths`` (declared ranges), ``dependence``, ``linear_parts`` and
``constant_coefficients``, then ``mass_matrix``, ``constraint_consistency`` and ``constraint_assembly``.
"""
