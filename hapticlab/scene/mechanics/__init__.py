"""Equations of motion from energies or from other systems: the dynamic model of Fig. 23.7.

In: a Lagrangian with forces and constraints, or a model of ``sympy.physics.mechanics``. Out: M a = f with constraints.
Read ``lagrange`` and ``kane``, ``sympy_models`` with ``sympy_symbols`` (from other systems), ``loop_solutions`` with
``loop_closure``, ``loop_dyads`` and ``loop_terms`` (closed chains in closed form), and ``device_image``.
"""
