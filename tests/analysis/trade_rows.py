"""A row of a trade-off, for the tests that choose among rows."""

import math

import hapticlab as hl
from hapticlab.analysis.accuracy.tradeoff_rows import Row


def one_row(**changes):
    """Return a row that meets what is asked, but for the changes."""
    given = {
        "method": "verlet", "T": 1e-3, "substeps": 1, "hold": "soh", "force_at": "before", "precision": "float32",
        "target": "uno", "err_max": 5e-3, "err_rms": 1e-3, "err_hold": 0.05, "doubt": 1e-9, "load": 0.3, "margin": 20.0,
        "steps_per_contact": math.inf, "b_req": 0.2, "b_device": 0.3, "cycles": 4000, "seconds": 2.5e-4,
    }  # fmt: skip
    return Row(**given | changes)


def asked(**given):
    """The arguments of a trade-off, of those of its records too."""
    tried, same = (
        {name: given.pop(name) for name in record.__dataclass_fields__ if name in given}
        for record in (hl.methods.Tried, hl.methods.Conditions)
    )
    return given | {"tried": hl.methods.Tried(**tried), "conditions": hl.methods.Conditions(**same)}
