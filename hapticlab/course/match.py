"""Whether the curves of a plot are those expected, and where they are not, what was mixed up."""

import numpy as np

from .diagnose import FACTORS

#: curves beyond those expected, lines of two points to guide the eye aside: one of many guesses is no answer
MORE = 2


def plot_fault(expected, found, rtol, atol):
    """Return what is wrong with the curves of a plot.

    A curve whose abscissae rise is compared by interpolation at those expected, so it may be sampled otherwise; any
    other point by point. Labels are free, units are not; a few curves beyond those expected do no harm.

    Parameters
    ----------
    expected, found : dict of str to dict
        As :func:`hapticlab.course.curves.curves` returns them; of what is expected, ``x``, ``y`` and the units count.
    rtol, atol : float
        Of the ordinates: ``atol + rtol*|largest|``; of abscissae point by point ``rtol`` alone.

    Returns
    -------
    (words, slip) : tuple of str
        Both empty where nothing is wrong; ``slip`` names a known mistake.

    Examples
    --------
    >>> line = {"x": [0.0, 0.01], "y": [0.0, 2.0], "x_unit": "m", "y_unit": "N"}
    >>> plot_fault({"curve 1": line}, {"curve 1": line | {"y": [0.0, -2.0]}}, 1e-3, 0.0)
    ('curve 1 is not there', 'Along y: The sign is turned.')
    """
    curves = [curve for curve in map(_arrays, found.values() if isinstance(found, dict) else ()) if curve]
    if not curves:
        return "no curves; needs a matplotlib Figure or Axes with them", ""
    long = sum(len(curve["x"]) > 2 for curve in curves)
    if long > len(expected) + MORE:
        return f"{long} curves where {len(expected)} would do: leave the others out", ""
    for name, wanted in expected.items():
        wanted = _arrays(wanted)
        if not any(_fits(wanted, curve, rtol, atol) for curve in curves):
            slip = next((said for curve in curves if (said := _mixed_up(wanted, curve, rtol, atol))), "")
            return _difference(name, wanted, curves, len(expected), slip), slip
    return "", ""


def _arrays(curve):
    """Return a curve with its numbers as arrays, abscissae rising; None of what is no curve."""
    try:
        x, y = np.array(curve["x"], float), np.array(curve["y"], float)
        units = {side: str(curve[side]) for side in ("x_unit", "y_unit")}
    except (TypeError, ValueError, KeyError):
        return None
    if x.ndim != 1 or x.shape != y.shape or not len(x):
        return None
    return {"x": x, "y": y, **units}


def _rising(x):
    """Return the order in which abscissae rise, or None where they turn back."""
    steps = np.diff(x)
    if (steps > 0).all():
        return slice(None)
    return slice(None, None, -1) if (steps < 0).all() else None


def _fits(wanted, curve, rtol, atol):
    if any(wanted[side] != curve[side] for side in ("x_unit", "y_unit")):
        return False
    asked, order = _rising(wanted["x"]), _rising(curve["x"])
    if len(wanted["x"]) > 1 and asked is not None and order is not None:
        return not _missing(wanted, curve) and _near(wanted["y"], _at(wanted["x"], curve), rtol, atol)
    if len(wanted["x"]) != len(curve["x"]):
        return False
    return _near(wanted["x"], curve["x"], rtol, 0.0) and _near(wanted["y"], curve["y"], rtol, atol)


def _at(x, curve):
    order = _rising(curve["x"])
    return np.interp(x, curve["x"][order], curve["y"][order])


def _missing(wanted, curve):
    """Whether a curve ends before what is expected does, by more than a thousandth of that."""
    low, high = wanted["x"].min(), wanted["x"].max()
    slack = 1e-3 * (high - low)
    return not (curve["x"].min() <= low + slack and curve["x"].max() >= high - slack)


def _near(wanted, got, rtol, atol):
    with np.errstate(all="ignore"):
        return bool((np.abs(got - wanted) <= atol + rtol * np.abs(wanted).max()).all())


def _mixed_up(wanted, curve, rtol, atol):
    """Return what was mixed up, if a curve would fit with that put right, or an empty text."""
    swapped = {"x": curve["y"], "y": curve["x"], "x_unit": curve["y_unit"], "y_unit": curve["x_unit"]}
    if _fits(wanted, swapped, rtol, atol):
        return f"The axes are swapped: {_unit(wanted['x_unit'])} belongs along x."
    for side in "xy":
        has, needs = curve[f"{side}_unit"], wanted[f"{side}_unit"]
        if has == needs:
            continue
        if not has:
            return f"The {side} axis has no unit: end its label with one, such as [{needs}]."
        return f"The {side} axis is in {_unit(has)}; it should be a quantity in {_unit(needs)}, or a multiple of that."
    for side in "yx":
        for factor, sentence in FACTORS:
            if _fits(wanted, curve | {side: curve[side] / factor}, rtol, atol):
                label = " Is the unit in its label that of its numbers?" if abs(factor) in (1e3, 1e-3) else ""
                return f"Along {side}: {sentence}{label}"
    return ""


def _unit(name):
    return "a number without unit" if name == "1" else name


def _difference(name, wanted, curves, needed, slip):
    """Say how far the first curve is from one that is expected."""
    if len(curves) < needed:
        return f"{len(curves)} curve{'s' * (len(curves) > 1)}, needs {needed}"
    curve = next((c for c in curves if c["x_unit"] == wanted["x_unit"] and c["y_unit"] == wanted["y_unit"]), None)
    if curve is None or slip:
        return f"{name} is not there"
    x_unit, y_unit = ("" if unit == "1" else f" {unit}" for unit in (wanted["x_unit"], wanted["y_unit"]))
    if _rising(wanted["x"]) is None or _rising(curve["x"]) is None:
        counts = f" (it has {len(curve['x'])} points, needs {len(wanted['x'])})" if len(curve["x"]) != len(wanted["x"]) else ""
        return f"{name} is not there{counts}"
    if _missing(wanted, curve):
        ends = [f"from {c['x'].min():.6g} to {c['x'].max():.6g}{x_unit}" for c in (curve, wanted)]
        return f"{name} goes {ends[0]}, needs {ends[1]}"
    got = _at(wanted["x"], curve)
    worst = int(np.argmax(np.nan_to_num(np.abs(got - wanted["y"]), nan=np.inf)))
    return f"at {wanted['x'][worst]:.6g}{x_unit} it is {got[worst]:.6g}{y_unit}, expected {wanted['y'][worst]:.6g}{y_unit}"
