"""``hl.plot``: the figure of a record over time or over position, and of plain curves."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from ...base.curves import draw_curves
from ...base.drawing import STYLES, axis_label, house_style, new_figure
from ...base.telemetry import Telemetry, check_record
from ...errors import AnalysisError

if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import Literal

    from matplotlib.figure import Figure

    from ...base.curves import Curve, Marks

#: forces, which a board holds from one sample to the next
HELD = ("F", "F_applied")
#: thousands of cycles would be a black bar
MANY = 5000


@overload
def plot(record: Telemetry, /, *names: str, over: str = "t", title: str = "", alt: str = "") -> Figure: ...


@overload
def plot(curves: Mapping[str, Curve] | Mapping[str, Mapping[str, Curve]], /, *, xlabel: str = "", ylabel: str = "",
         log: Literal["", "x", "y", "xy"] = "", at_x: Marks | None = None, at_y: Marks | None = None,
         xlim: tuple[float, float] | None = None, ylim: tuple[float, float] | None = None, height: float | None = None,
         title: str = "", alt: str = "") -> Figure: ...  # fmt: skip


def plot(shown: Any, /, *names: str, **options: Any) -> Figure:
    """Draw a record, or curves that you computed yourself.

    Quantities of a record are drawn against time, one below the other, and shaded where the environment exerts a force; with
    ``over="x"`` they are drawn against position, where a force that generates energy runs through a loop. Curves share one
    pair of axes.

    Parameters
    ----------
    shown : Telemetry, or dict of str to (xs, ys)
        A record; or curves by their labels, in the units that your axis labels state. A third entry of a curve says how it
        is drawn, ``(xs, ys, "points")``: "line", "points" or "both". A fourth draws an interval of that half width around
        each point. The xs may be words. A dict of such dicts draws one panel for each, with common axes.
    *names : str
        Of a record: what was recorded, ``"x"``, ``"v"``, ``"F"``, a watched state; ``"x"`` and ``"F"`` by default, over
        position ``"F"``. Lengths are shown in millimetres. A force is drawn as it is held: in steps, one per period.
    over : str
        Of a record: the recorded quantity that runs to the right, "t" by default.
    xlabel, ylabel : str
        Of curves: what an axis shows, with its unit in brackets.
    log : {"", "x", "y", "xy"}
        Of curves: which axes are logarithmic.
    at_x, at_y : dict of str to float, or to (low, high)
        Of curves: words at a place on an axis, with a dotted line across, or with a grey band between two ends.
    xlim, ylim : (low, high), optional
        Of curves: the ends of an axis.
    height : float, optional
        Of curves: height of the figure [inch].
    title : str
    alt : str
        What there is to see, for who cannot see it; by default what the axes and lines say.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    AnalysisError
        For a name that was not recorded, and for curves that are not lists of numbers of one length.

    Examples
    --------
    >>> import hapticlab as hl
    >>> log = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(push=1.0)).run(hl.wall()(k=300), duration=0.1)
    >>> [axes.get_ylabel() for axes in hl.plot(log, "x", "F").axes]
    ['handle position x [mm]', 'force F [N]']
    >>> hl.plot(log, over="x").axes[0].get_xlabel()
    'handle position x [mm]'
    >>> limits = {"K = 2b/T": ([0.5, 1, 2], [400, 200, 100], "both")}
    >>> figure = hl.plot(limits, xlabel="period T [ms]", ylabel="stiffness K [N/m]", log="xy", at_y={"wanted": 150})
    """
    if isinstance(shown, Telemetry) or not hasattr(shown, "items"):
        return _draw_record(shown, names, **options)
    if names:
        raise AnalysisError(f"plot of curves, and {names[0]!r}; names belong to a record. Put a curve's name before it, as a key")
    if "over" in options:
        raise AnalysisError("plot of curves has no over=; a curve brings its own xs. Say what they are: xlabel='...'")
    known = draw_curves.__kwdefaults__ or {}
    if wrong := [option for option in options if option not in known]:
        raise AnalysisError(f"plot of curves has no {wrong[0]}=; it takes {', '.join(f'{option}=' for option in known)}")
    return draw_curves(shown, **options)


def _draw_record(log, names, over="t", title="", alt="", **unknown):
    check_record(log, "plot", whole=False)
    if unknown:
        raise AnalysisError(f"plot of a record has no {next(iter(unknown))}=; it takes over=, title= and alt=")
    names = names or (("x", "F") if over == "t" else ("F",))
    if not all(isinstance(name, str) for name in (*names, over)):
        raise AnalysisError(f'plot of {names}; needs separate names, as in hl.plot(log, "x", "F")')
    missing = [name for name in (*names, over) if name not in log.columns]
    if missing:
        recorded = ", ".join(log.columns)
        raise AnalysisError(f"{missing[0]} was not recorded; this log has {recorded}. Watch it: hl.Scene(..., watch=[...])")
    in_time = over == "t"
    across = (1.0, "time t [s]") if in_time else axis_label(over, log.units.get(over, "1"))
    with house_style():
        many = in_time and len(names) > 2  # three rows, and what is around them, within 520 pixels
        figure = new_figure(height=1.1 + 1.2 * len(names) if many else 1.2 + (1.7 if in_time else 3.0) * len(names))
        rows = figure.subplots(len(names), 1, sharex=True, squeeze=False)[:, 0]
        for axes, name in zip(rows, names, strict=True):
            _draw_quantity(axes, log, name, across[0] * getattr(log, over), held=over in ("t", "x"))
            if many:
                axes.set_ylabel("\n".join(textwrap.wrap(axes.get_ylabel(), 16)))
        rows[-1].set_xlabel(across[1])
        if in_time:
            _shade_force(figure, rows, log)
        rows[0].set_title("\n".join(filter(None, [title, log.fault and f"fault: {log.fault}"])), fontsize="small")
        figure.alt = alt or None
    return figure


def _draw_quantity(axes, log, name, across, *, held):
    scale, label = axis_label(name, log.units.get(name, "1"))
    thin = {"linewidth": 0.6} if len(log.t) > MANY else {}
    steps = {"drawstyle": "steps-post"} if held and name in HELD and log.every == 1 else {}
    axes.plot(across, scale * np.asarray(getattr(log, name)), **STYLES[0], **thin, **steps)
    axes.set_ylabel(label)


def _shade_force(figure, rows, log):
    """Shade the periods with a force, where there are others too: a wall's force is 0 outside."""
    acts = log.F != 0
    if not acts.any() or acts.mean() > 0.99:  # also where a body's first sample alone has none
        return
    for axes in rows:
        shade = {"color": "#8a8a8a", "alpha": 0.25, "linewidth": 0, "zorder": 0, "transform": axes.get_xaxis_transform()}
        shaded = axes.fill_between(log.t, 0, 1, where=acts, step="post", **shade)
    figure.legend([shaded], ["the environment exerts a force"], fontsize="small", loc="outside lower right")
