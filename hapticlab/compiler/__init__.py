"""How a scene runs: one typed straight-line program, and three engines that execute it.

What follows is the way of a scene through the files of this package, in the order of the data. A belt over a pulley
ties a carriage z, pulled by the handle through a coupler, to a weight y, which lands on the ground: a constraint and a
contact.

>>> import hapticlab as hl
>>> from hapticlab import x, n
>>> K, b_c, m, g, h = hl.parameters("K b_c m g h", units="N/m N*s/m kg m/s^2 m", values=(200, 0.1, 0.05, 9.81, 0.02))
>>> z, y = hl.coordinate("z", unit="m", initial=x(n)), hl.coordinate("y", unit="m", initial=h - x(n))
>>> t, F_c = hl.t, hl.virtual_coupler(z, K=K, b=b_c)
>>> L = m * (z.diff(t) ** 2 + y.diff(t) ** 2) / 2 - m * g * y
>>> lands = hl.Contact(y, hl.impulse(e=0.5), name="lands")
>>> motion = hl.lagrange(L, forces={z: F_c}, constraints=[z + y - h], contacts=[lands])
>>> scene = hl.Scene(force=F_c, eom=[motion], watch=[z, y])

**Scene -> ExplicitForm.** ``scene.mechanics`` derives M a = f of the Lagrangian, ``scene.explicit`` gathers it with
what is written by hand. Nothing is solved in symbols.

>>> form = scene.explicit()
>>> form.coordinates, len(form.models[0].constraints), [c.name for c in form.models[0].contacts]
((y(t), z(t)), 1, ['lands'])

``modes`` (by the intervals of ``ranges``) takes out of it the cases that declared ranges exclude, ``bounds`` and
``held`` keep coordinates and lengths where that was concluded. ``requires`` leaves out what the force does not need
(``dependence``, ``requirements``), for ``replay`` to run after the fact.

**ExplicitForm -> Dynamics.** ``lower`` checks what was asked for, ``lowering`` is the tick, in the order it runs:
sample (``handle``), force, outputs, and one period of motion; ``force_at`` has the force after it, or on average.
Expressions become values of a ``trace`` by ``expressions`` (``phase`` and ``constants`` look after angles and numbers,
``simplify`` after every operation). Whatever must be differentiated, evaluated in numbers or shared is in ``graph``
(``differentiate``, ``algebra``). ``dynamics`` answers one question: in this state at this instant, what are the
accelerations? For M a = f alone that is ``solve``; ``mass`` has looked whether there is an answer, ``first_sample``
where it starts, ``zeros`` leaves out what is structurally zero.

- A constraint: ``constraints`` chooses how it is kept, and refuses one that cannot be: ``consistency`` says why,
  ``assembly`` has walked the configurations. ``enforcing`` does what was chosen while it runs: a closed form
  (``scene.loops`` found it, ``embedding`` traces it), multipliers, or Newton's method, all three on the linear algebra
  of ``constrained``. What the handle feels of it is bounded by ``port_mass``.
- A contact: ``contacts`` is what dynamics knows of it. ``contact_starts`` and ``contact_steps`` have looked at the
  start and the step. Laws with a force are a case of f; of the others, see below.

**Dynamics -> method.** ``methods`` tables the textbook's explicit ``steps``, which ask dynamics for accelerations;
``damping`` takes dampers implicitly, ``multistep`` keeps rates of steps before, ``suited`` refuses what would lose its
order; ``step_matrix``, ``stability_region`` and ``order`` say what a method is worth. ``exact`` (of the parts that
``linear`` and ``coefficients`` find, by the ``exponential``) takes what is linear, ``switched`` what is linear between
switches, by a map a mode where none can be reached, else as "taylor" does. "taylor" is ``advance``: ``stiffness``
checks the motion and chooses the order; ``guards`` turns every comparison into a mode and the instant it ends; ``flow``
makes the polynomial of a piece in given modes by the recurrences of ``taylor``; ``crossing`` finds its first root;
``located`` steps from one to the next. At a touch ``impacts`` differentiates what is needed once, ``touch`` says what
happens in that instant (which contacts strike, rest, lose energy), ``impact`` has the laws of one blow, and
``complementarity`` solves for several.

A motion without samples, to compare a program's force with: ``driven`` lets the handle follow a given path inside the
step, ``instant`` leaves the stepping to whoever asks.

**Method -> Program.** ``tracing`` gathers states and inputs, named by ``channels``, and leaves out what no output sees;
``options`` has checked what was asked for. How long a step may be, and what live parameters may be set to, is known
before it runs: ``tangents`` differentiates the instructions in numbers (``slopes``, of the motion), ``step_matrix`` takes
a method's step of what comes out, ``stable_values`` tells at which values it is stable, and ``value_limits`` how far each
may go. The result is an ``ir`` program:

>>> program = hl.compile(scene, "taylor", T=1e-3)
>>> [c.name for c in program.outputs]
['F', 'z', 'y', 'unlocated']
>>> [note for note in program.notes if "closed form" in note]
['z in closed form, driven by y: no drift']

Fig. 23.7 of the chapter has three processes, each with its model. Here they are:

- Collision detector, on the geometric model (``scene.shapes``, ``scene.curves``). Broad phase: ``pairs``, once, when
  the scene is compiled. Narrow phase: ``scene.gaps`` with ``faces`` and ``gjk``, or tracked in ``scene.curves``. When
  bodies touch: ``guards`` and ``crossing`` of method "taylor"; a case of the force at the sample, with other methods.
- Interaction calculator, on the interaction model (``scene.force_laws``, ``scene.contact_laws``). ``contacts``, with
  forces that go into f or into ``complementarity``; impulses, that is new initial conditions, by ``impacts``, ``touch``
  and ``impact``, which ask the dynamic model for its mass.
- Forward dynamics solver, on the dynamic model with its constraints (``scene.mechanics``). ``dynamics`` with
  ``enforcing`` and ``solve``, stepped by ``methods``, ``exact`` or ``located``.

**Program -> numbers.** ``engine`` chooses one of three that give the same bits: ``interpreter`` (the reference),
``llvm`` (``llvm_emit``, ``side_by_side``; ``branches`` around what ``skipped`` finds that only one case needs), and the
board's own code on this computer, ``vm`` and ``native`` (``toolchain``). The functions that all share are in
``elementary``. A scene that was compiled is not compiled again, nor is a program: ``shared`` keeps both. For a board
``bytecode`` writes the program, ``cheaders`` its tables; ``cost`` (``angles``, ``traffic``) says what it takes there,
``fit`` what would.
"""
