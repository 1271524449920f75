"""Whether the curves of a plot are those expected, and where they are not, what was mixed up."""

import numpy as np

from .diagnose import FACTORS

#: how far apart points may be, of the range, where they lie on the curve and the lines between them do not
WIDEST = 1 / 6
#: how much of the range may be missing at an end, if it is no more than a step: np.arange leaves its end out
END = 0.02


def plot_fault(expected, found, rtol, atol):
    """The fault of the curves of a plot, in words.

    A curve whose abscissae rise is compared by interpolation at those expected, or else at its own, where they are fewer
    and close enough to show it, so it may be sampled otherwise; any other point by point. Labels are free, units are not. Points
    that are not finite are left out. Lines to guide the eye, copies and curves in other units do no harm. A curve that
    could be the answer and is none does: whoever draws several guesses would be right with one of them.

    Parameters
    ----------
    expected, found : dict of str to dict
        As :func:`hapticlab.course.plotted_curves.curves` returns them; of what is expected, ``x``, ``y`` and the units count.
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
    ('curve 1 is not there', 'Along y: The sign is wrong.')
    """
    curves = [curve for curve in map(_arrays, found.values() if isinstance(found, dict) else ()) if curve]
    if not curves:
        return "no curve of finite numbers; needs a matplotlib Figure or Axes with one", ""
    asked = {name: _arrays(wanted) for name, wanted in expected.items()}
    for name, wanted in asked.items():
        if not any(_fits(wanted, curve, rtol, atol) for curve in curves):
            slip = next((said for curve in curves if (said := _mixed_up(wanted, curve, rtol, atol))), "")
            return _difference(name, wanted, curves, len(expected), slip, _band(wanted, rtol, atol)), slip
    guesses = sum(_is_guess(list(asked.values()), curve, rtol, atol) for curve in curves)
    many = (
        f"{guesses} curve{'s' * (guesses > 1)} too many. Plot only the curves that are asked for, and make a new figure "
        "in each call"
    )
    return many if guesses else "", ""


def _arrays(curve):
    """Return a curve with its finite points as arrays, and how many others it has; None of what is no curve."""
    try:
        x, y = np.array(curve["x"], float), np.array(curve["y"], float)
        units = {side: str(curve[side]) for side in ("x_unit", "y_unit")}
    except (TypeError, ValueError, KeyError):
        return None
    if x.ndim != 1 or x.shape != y.shape:
        return None
    finite = np.isfinite(x) & np.isfinite(y)
    return {"x": x[finite], "y": y[finite], "left out": int((~finite).sum()), **units} if finite.any() else None


def _rising(x):
    """Return the order in which abscissae rise, or None where they turn back."""
    steps = np.diff(x)
    if (steps > 0).all():
        return slice(None)
    return slice(None, None, -1) if (steps < 0).all() else None


def _is_guess(asked, curve, rtol, atol):
    """Whether a curve could be an answer and is none; a straight line beside bent ones guides the eye."""
    if any(_fits(wanted, curve, rtol, atol) for wanted in asked):
        return False
    if _straight(curve, rtol, atol):
        asked = [wanted for wanted in asked if _straight(wanted, rtol, atol)]
    return any(_comparable(wanted, curve) for wanted in asked)


def _straight(curve, rtol, atol):
    ends = [curve["x"].argmin(), curve["x"].argmax()]
    return _near(np.interp(curve["x"], curve["x"][ends], curve["y"][ends]), curve["y"], _band(curve, rtol, atol))


def _by_interpolation(wanted, curve):
    return len(wanted["x"]) > 1 and _rising(wanted["x"]) is not None and _rising(curve["x"]) is not None


def _comparable(wanted, curve):
    """Whether a curve has the units, and the range or the number of points, of what is expected."""
    if any(wanted[side] != curve[side] for side in ("x_unit", "y_unit")):
        return False
    return not _missing(wanted, curve) if _by_interpolation(wanted, curve) else len(wanted["x"]) == len(curve["x"])


def _fits(wanted, curve, rtol, atol):
    if not _comparable(wanted, curve):
        return False
    band = _band(wanted, rtol, atol)
    if not _by_interpolation(wanted, curve):
        return _near(wanted["x"], curve["x"], rtol * np.abs(wanted["x"]).max()) and _near(wanted["y"], curve["y"], band)
    if _near(*_where_asked(wanted, curve)[1:], band):
        return True
    close = _is_coarse(wanted, curve) and _widest(wanted, curve) <= 1.001 * WIDEST * np.ptp(wanted["x"])
    return close and _near(*_where_drawn(wanted, curve)[1:], band)


def _is_coarse(wanted, curve):
    """Whether the lines between the points of a curve may be farther off than its points."""
    return len(curve["x"]) < len(wanted["x"])


def _at(x, curve):
    order = _rising(curve["x"])
    return np.interp(x, curve["x"][order], curve["y"][order])


def _where_asked(wanted, curve):
    """Return abscissae of what is expected, and both curves there; one that ends a step before goes on straight."""
    order = _rising(curve["x"])
    x, y = (np.pad(curve[side][order], 1, "reflect", reflect_type="odd") for side in "xy")
    return wanted["x"], wanted["y"], np.interp(wanted["x"], x, y)


def _where_drawn(wanted, curve):
    """Return abscissae of a curve within the range, and both curves there."""
    inside = (curve["x"] >= wanted["x"].min()) & (curve["x"] <= wanted["x"].max())
    return curve["x"][inside], _at(curve["x"][inside], wanted), curve["y"][inside]


def _widest(wanted, curve):
    """The largest distance between neighbouring points of a curve within the range."""
    return np.abs(np.diff(np.clip(curve["x"], wanted["x"].min(), wanted["x"].max()))).max(initial=0)


def _missing(wanted, curve):
    """Whether a curve ends before what is expected does."""
    low, high, x = wanted["x"].min(), wanted["x"].max(), curve["x"][_rising(curve["x"])]
    if len(x) < 2:
        return True
    first, last = (np.clip(step, 1e-3 * (high - low), END * (high - low)) for step in (x[1] - x[0], x[-1] - x[-2]))
    return bool(x[0] > low + 1.001 * first or x[-1] < high - 1.001 * last)


def _band(wanted, rtol, atol):
    return atol + rtol * np.abs(wanted["y"]).max()


def _near(wanted, got, band):
    with np.errstate(all="ignore"):
        return bool((np.abs(got - wanted) <= band).all())


def _mixed_up(wanted, curve, rtol, atol):
    """The mix-up without which a curve would fit, in words, or an empty text."""
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
                label = " Does the unit in its label match its numbers?" if abs(factor) in (1e3, 1e-3) else ""
                return f"Along {side}: {sentence}{label}"
    return ""


def _unit(name):
    return "a number without unit" if name == "1" else name


def _difference(name, wanted, curves, needed, slip, band):
    """Say how far the first curve is from one that is expected."""
    if len(curves) < needed:
        return f"{len(curves)} curve{'s' * (len(curves) > 1)}, needs {needed}"
    curve = next((c for c in curves if c["x_unit"] == wanted["x_unit"] and c["y_unit"] == wanted["y_unit"]), None)
    if curve is None or slip:
        return f"{name} is not there"
    left_out = f" ({curve['left out']} of its points are nan or inf)" if curve["left out"] else ""
    if not _by_interpolation(wanted, curve):
        counts = f" (it has {len(curve['x'])} points, needs {len(wanted['x'])})" if len(curve["x"]) != len(wanted["x"]) else ""
        return f"{name} is not there{counts}{left_out}"
    return f"{_distance(name, wanted, curve, band)}{left_out}"


def _distance(name, wanted, curve, band):
    """Say where a curve is not what is expected, most of all."""
    x_unit, y_unit = ("" if unit == "1" else f" {unit}" for unit in (wanted["x_unit"], wanted["y_unit"]))
    if _missing(wanted, curve):
        ends = [f"from {c['x'].min():.6g} to {c['x'].max():.6g}{x_unit}" for c in (curve, wanted)]
        return f"{name} goes {ends[0]}; needs {ends[1]}"
    coarse = _is_coarse(wanted, curve)
    x, expected, got = (_where_drawn if coarse else _where_asked)(wanted, curve)
    if coarse and _near(expected, got, band):
        apart, most = _widest(wanted, curve), WIDEST * np.ptp(wanted["x"])
        return f"{name} has points up to {apart:.3g}{x_unit} apart; needs more points, at most {most:.3g}{x_unit} apart"
    worst = int(np.argmax(np.abs(got - expected)))
    return f"at {x[worst]:.6g}{x_unit} it is {got[worst]:.6g}{y_unit}, expected {expected[worst]:.6g}{y_unit}"
