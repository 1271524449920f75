"""The parameters that constraints hold: lengths of a mechanism, which no motion leads from one value to another.

Set while it runs, such a length would throw the mechanism to where the constraint holds again, in one step. So they are
constants of a program, unless one declares a finite range and is asked for by name.
"""

import itertools
import math

import numpy as np

from ...errors import ParameterError, SceneError
from ...scene.mechanics.loop_closure import check_range
from ...scene.mechanics.loop_solutions import is_holonomic
from ...scene.mechanics.loop_terms import NotClosed
from ...scene.notation.symbols import Parameter
from ..ir.notes import ParameterNote
from .constraint_consistency import assembled, check_independent, check_rank

#: places of the ranges of live lengths that are looked at: all combinations of the ends and middles of so many
_COMBINED = 3


def held(scene):
    """The parameters of a scene that stand in its constraints, name -> Parameter.

    Examples
    --------
    >>> import hapticlab as hl
    >>> m, k, l = hl.parameters("m k l", units="kg N/m m", values=(0.1, 50, 0.2))
    >>> q, u = hl.coordinate("q", unit="m"), hl.coordinate("u", unit="m", initial=l)
    >>> rod = hl.mechanics.lagrange(m * (q.diff(hl.t) ** 2 + u.diff(hl.t) ** 2) / 2, constraints=[u - q - l])
    >>> list(held(hl.Scene(force=k * (hl.x(hl.n) - q), eom=[rod])))
    ['l']
    """
    used = {p.name for model in scene.models for g in model.constraints for p in g.atoms(Parameter)}
    return {name: p for name, p in scene.parameters.items() if name in used}


def check_live(scene, live):
    """Refuse a parameter that a constraint holds among those asked to be live, unless its range is declared."""
    for name, p in held(scene).items():
        if name in live and not _is_finite(p):
            value = scene.values.get(name, math.nan)
            limits = f"({value / 2:g}, {2 * value:g})" if value > 0 else "(low, high)"
            raise ParameterError(
                f"live: {name} is in a constraint, so the mechanism would jump to its new length when the value changes. "
                f"Bind it, scene({name}=...), and leave it out of live. If you want the jump, declare a range: "
                f"hl.parameters('{name}', units='{p.unit}', ranges={limits})"
            )


def notes_on(scene, folded):
    """The notes of a program on the parameters that constraints hold."""
    return tuple(
        ParameterNote(name, "in a constraint, so not live")
        if name in folded
        else ParameterNote(name, "live, and in a constraint: the mechanism jumps to the new length when the value changes")
        for name in held(scene)
    )


def check_lengths(constraints, coordinates, start, folded, real, embedding=None):
    """Refuse live lengths with which a mechanism cannot be put together, or loses a rank, within their declared ranges.

    Parameters
    ----------
    constraints, coordinates, start
        Of :func:`~hapticlab.compiler.constraints.enforcement_choice.enforcement`.
    folded : collection of names
        Parameters that cannot change.
    real : {"f64", "f32"}
    embedding : Embedding, optional
        Where they are solved in closed form.
    """
    found = {p for g in constraints for p in g.atoms(Parameter)} & set(start)
    live = sorted((p for p in found if p.name not in folded), key=str)
    constraints = sorted(constraints, key=lambda g: not is_holonomic(g))
    positions = [g for g in constraints if is_holonomic(g)]
    for lengths in _places(live, start):
        at = {**start, **lengths}
        try:
            assembly = assembled(constraints, coordinates, at)
            check_independent(assembly, constraints, positions, coordinates)
            at |= dict(zip(coordinates, map(float, assembly.closest(assembly.start[:, None])[:, 0]), strict=True))
            if embedding is not None:
                check_range(embedding.drivers, embedding.groups, at)
            else:
                check_rank(assembled(constraints, coordinates, at), constraints, coordinates, real)
        except (SceneError, NotClosed) as why:
            shown = ", ".join(f"{p.name} = {value:.4g} {p.unit}" for p, value in lengths.items())
            raise SceneError(f"with {shown}, which is live and can have any value in its declared range: {why}") from None


def _places(live, start):
    """Yield parameter -> value over the ranges of live lengths."""
    ways = [(p.low, (p.low + p.high) / 2, p.high) for p in live]
    if len(live) <= _COMBINED:
        yield from (dict(zip(live, values, strict=True)) for values in itertools.product(*ways) if values)
        return
    for p, values in zip(live, ways, strict=True):
        yield from ({**{other: start[other] for other in live}, p: value} for value in values)


def _is_finite(p):
    return bool(np.isfinite([p.low, p.high]).all())
