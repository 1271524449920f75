"""How a scene runs: one typed straight-line program, and the engines that execute it.

What follows is the way of a scene through the files of this package, in the order of the data. A belt over a pulley
ties a carriage z, pulled by the handle through a coupler, to a weight y, which lands on the ground: a constraint and a
contact.

>>> import hapticlab as hl
>>> from hapticlab import x, n
>>> K, b_c, m, g, h = hl.parameters("K b_c m g h", units="N/m N*s/m kg m/s^2 m", values=(200, 0.1, 0.05, 9.81, 0.02))
>>> z, y = hl.coordinate("z", unit="m", initial=x(n)), hl.coordinate("y", unit="m", initial=h - x(n))
>>> t, F_c = hl.t, hl.laws.virtual_coupler(z, K=K, b=b_c)
>>> L = m * (z.diff(t) ** 2 + y.diff(t) ** 2) / 2 - m * g * y
>>> lands = hl.contact.Contact(y, hl.contact.impulse(e=0.5), name="lands")
>>> motion = hl.mechanics.lagrange(L, forces={z: F_c}, constraints=[z + y - h], contacts=[lands])
>>> scene = hl.Scene(force=F_c, eom=[motion], watch=[z, y])

**Scene -> ExplicitForm.** ``scene.mechanics.lagrange`` derives M a = f of the Lagrangian, ``scene.explicit`` gathers it with
what is written by hand. Nothing is solved in symbols.

>>> form = scene.explicit()
>>> form.coordinates, len(form.models[0].constraints), [c.name for c in form.models[0].contacts]
((y(t), z(t)), 1, ['lands'])

``excluded_modes`` (by the intervals of ``ranges``) takes out of it the cases that declared ranges exclude,
``coordinate_bounds`` and ``constraint_lengths`` keep coordinates and lengths where that was concluded.
``analysis.programs.requires`` leaves out what the force does not need (``dependence``,
``analysis.programs.requirement_report``), for ``analysis.programs.replay`` to run after the fact.

**ExplicitForm -> tick.** ``compile_scene`` checks what was asked for (``chosen_method`` reads ``method=``,
``options`` the rest). A scene without coordinates needs no other path: the sample is taken (``handle_samples``), its
leaves get their values (``leaf_values``), the force follows, and that is the tick. Any other is a ``motion_program``, in
the order the tick runs: sample, force, outputs, and one period of motion; ``force_timing`` has the force on average.
Expressions become ``values`` of a ``trace`` by ``expressions`` (``phase`` and ``constants`` look after angles and
numbers). Each does one of the ``operations``: a record of each says how it is computed, simplified and
differentiated, here and on a board. Whatever must be differentiated, evaluated in numbers or shared is in ``graph``
(``differentiate``, ``derivative_builder``).

**Tick -> Dynamics.** ``dynamics`` answers one question: in this state at this instant, what are the accelerations? For
M a = f alone that is ``linear_solve``; ``mass_matrix`` has looked whether there is an answer, ``first_sample`` where it
starts, ``structural_zeros`` leaves out what is structurally zero.

- A constraint: ``enforcement_choice`` chooses how it is kept, and refuses one that cannot be:
  ``constraint_consistency`` says why, ``constraint_assembly`` has walked the configurations. ``enforcement`` does what
  was chosen while it runs: a closed form (``scene.mechanics.loop_solutions`` found it, ``loop_embedding`` traces it),
  multipliers, or Newton's method, all three on the linear algebra of ``multipliers``. What the handle feels of it is
  bounded by ``felt_mass``.
- A contact: ``scene_contacts`` is what dynamics knows of it. ``contact_starts`` and ``contact_steps`` have looked at
  the start and the step. Laws with a force are a case of f; of the others, see below.

**Dynamics -> method.** ``method_table`` tables the textbook's explicit ``steps``, which ask dynamics for accelerations;
``implicit_damping`` takes dampers implicitly, ``multistep`` keeps rates of steps before, ``method_checks`` refuses what
would lose its order; ``step_matrix``, ``stability_region`` and ``analysis.programs.error_order`` say what a method is
worth. ``exact_linear`` (of the parts that ``linear_parts`` and ``constant_coefficients`` find, by the
``matrix_exponential``) takes what is linear, ``switched_linear`` what is linear between switches, by a map a mode where
none can be reached, else as "taylor" does. "taylor" is ``taylor_method``: ``series_checks`` checks the motion and
chooses the order; ``guards`` turns every comparison into a mode and the instant it ends; ``flow`` makes the polynomial
of a piece in given modes by ``taylor_series`` and its ``recurrences``; ``polynomial_crossing`` finds its first root;
``located_step`` steps from one to the next. At a touch ``impacts`` differentiates what is needed once, ``touch`` says
what happens in that instant (which contacts strike, rest, lose energy), ``impulses`` has the laws of one blow, and
``complementarity`` solves for several.

A motion without samples, to compare a program's force with: ``analysis.accuracy.continuous_handle`` lets the handle
follow a given path inside the step, ``analysis.accuracy.accelerations_at`` leaves the stepping to whoever asks.

**Method -> Program.** ``program_builder`` gathers states and inputs, named by ``channels``, and leaves out what no
output sees. How long a step may be, and what live parameters may be set to,
is known before it runs: ``tangents`` differentiates the instructions in numbers (``analysis.stability.slopes``, of the
motion), ``step_matrix`` takes a method's step of what comes out, ``live_stability`` tells at which values it is stable,
and ``live_limits`` how far each may go. The result is a ``program``:

>>> program = hl.compile(scene, "taylor", T=1e-3)
>>> [c.name for c in program.outputs]
['F', 'z', 'y', 'unlocated', 'overlap']
>>> [note for note in program.notes if "closed form" in note]
['z in closed form, driven by y: no drift']

Fig. 23.7 of the chapter has three processes, each with its model. Here they are:

- Collision detector, on the geometric model (``scene.shapes.shapes``, ``scene.shapes.curves``). Broad phase:
  ``broad_phase``, once, when the scene is compiled; of polygons ``gjk``, while it runs. Narrow phase:
  ``scene.shapes.gaps`` with ``polygon_distance`` and ``gjk``, or tracked in ``scene.shapes.curves``. When bodies
  touch: ``guards`` and ``polynomial_crossing`` of method "taylor"; a case of the force at the sample, with other
  methods.
- Interaction calculator, on the interaction model (``scene.contact.penalty_laws``, ``scene.contact.instant_laws``).
  ``scene_contacts``, with forces that go into f or into ``complementarity``; impulses, that is new initial conditions,
  by ``impacts``, ``touch`` and ``impulses``, which ask the dynamic model for its mass.
- Forward dynamics solver, on the dynamic model with its constraints (``scene.mechanics.lagrange``). ``dynamics`` with
  ``enforcement`` and ``linear_solve``, stepped by ``method_table``, ``exact_linear`` or ``located_step``.

**Program -> numbers.** ``engine`` chooses one of three, which give the same bits in float32 as long as all numbers
are finite: ``interpreter`` (the reference), ``llvm`` (``llvm_emit``, ``side_by_side``; ``llvm_branches`` around what
``skipped_arms`` finds that only one case needs), and the board's own code on this computer, ``vm`` and
``firmware_library`` (``toolchain``). The functions that all share are in ``elementary``. A scene that was compiled is
not compiled again, nor is a program: ``cache`` keeps both. For a board ``bytecode`` writes the program, ``c_headers``
its tables; ``cost`` (``large_angles``, ``link_traffic``) says what it takes there, ``board_fit`` what would.
"""
