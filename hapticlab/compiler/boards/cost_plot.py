"""A figure of what a program takes of a board."""

from ...base.drawing import COLD, FRAME, WARM, house_style, new_figure
from ...errors import ProgramError


def plot_cost(cost):
    """Draw what a step takes of its period, part by part: with ordinary operands, and at most.

    Parameters
    ----------
    cost : Cost
        On a board whose time is limited.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    ProgramError
        Time is not limited on this board.
    """
    if not cost.period:
        raise ProgramError(f"{cost.board.name}: its time is not limited, so there is no period to fill. Give board='uno'")
    typical, most = (cost.typical, cost.step[0], cost.frame), (cost.bound, cost.step[2], cost.longest(True))
    rest = most[2] - most[0] - most[1]
    parts = (
        ("scene", (typical[0], most[0]), {"color": COLD}),
        ("sensor, safety, motor", (typical[1], most[1]), {"facecolor": "white", "edgecolor": "black", "hatch": "///"}),
        ("link", (typical[2], rest), {"color": WARM}),
    )
    milliseconds, left = 1e3 / cost.board.hz, [0.0, 0.0]
    with house_style():
        figure = new_figure(height=2.6)
        axes = figure.subplots()
        for label, cycles, look in parts:
            widths = [milliseconds * max(one, 0.0) for one in cycles]
            axes.barh(["typical", "at most"], widths, left=left, height=0.55, label=label, **look)
            left = [sum(pair) for pair in zip(left, widths, strict=True)]
        axes.axvline(1e3 * cost.T, color="black", linestyle="--", label=f"period, {1e3 * cost.T:g} ms")
        axes.invert_yaxis()
        axes.set(xlabel="time of one step [ms]", xlim=(0, 1.15 * max(*left, 1e3 * cost.T)))
        axes.set_title(f"{cost.name} on {cost.board.name}: {cost.verdict}", fontsize="small", wrap=True)
        axes.legend(fontsize="small", loc="upper center", bbox_to_anchor=(0.5, -0.32), ncols=4, **FRAME)
    return figure
