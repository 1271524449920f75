"""Statements of lab 05 about the paddle in use, whether they hold, and what is printed where they do not."""


def adding_damping(lab):
    """Return by which factor the exact limits of finger and pinch exceed the bound with their damping added."""
    return [lab.limits[at] / lab.np.interp(lab.hands[at].b, lab.added, lab.bounds) for at in (0, 1)]


CLAIMS = [
    (
        "the handle comes to rest even at five times the bound, to within one encoder count",
        lambda lab: lab.leaned[0].amplitude < lab.count,
        "",
    ),
    ("throws the finger out again and again", lambda lab: lab.leaned[2].state in ("growing", "chatter"), "Dry friction"),
    (
        "At the bound the oscillation after a touch dies out",
        lambda lab: lab.leaned[1].state in ("none", "decaying"),
        "a few counts",
    ),
    ("No hand falls below the bound", lambda lab: min(lab.limits) >= lab.bound, ""),
    ("come close to it: the bound is *tight*", lambda lab: min(lab.limits) < 1.1 * lab.bound, ""),
    ("the bound gives nearly the exact limit in this hand", lambda lab: max(adding_damping(lab)) < 1.1, ""),
    ("gave back more energy than it took", lambda lab: lab.generated.generated > 0, ""),
    (
        "the two energies agree within a few percent",
        lambda lab: abs(-lab.hit.W[-1] / lab.generated.generated - 1) < 0.05,
        "The observer is off",
    ),
    (
        "$KT$ for the backward difference and $2KT$ for Ellis's law, against $KT/2$",
        lambda lab: lab.np.allclose([lab.needs[law][0] / lab.b for law in lab.needs], [0.5, 1, 2], rtol=1e-3),
        "",
    ),
    ("lies outside the disk", lambda lab: lab.mapped[lab.softer].passive and not lab.mapped[lab.stiffer].passive, ""),
    ("less than a tenth is left", lambda lab: lab.swings[1] <= lab.swings[0] / 10, "misses a part of the energy"),
]
