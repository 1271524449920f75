"""The figure of two coupled paddles: where both handles were, and what each one felt."""

from ...base.drawing import COLD, WARM, house_style, new_figure

SIDES = (("left", COLD, "-"), ("right", WARM, "--"))


def plot_coupled(run):
    """Draw the positions of both handles above the forces on both, over the same time."""
    with house_style():
        figure = new_figure(height=4.6)
        above, below = figure.subplots(2, 1, sharex=True)
        for name, colour, dashes in SIDES:
            log = getattr(run, name)
            above.plot(log.t, 1e3 * log.x, dashes, color=colour, label=name)
            below.plot(log.t, -log.F, dashes, color=colour, label=name)
        above.set(ylabel="handle position x [mm]")
        above.legend(loc="upper right", ncols=2)
        below.set(xlabel="time t [s]", ylabel="force of the motor, -F [N]")
        figure.suptitle(f"link: {1e3 * run.to_right.median:.3g} ms to the right, {1e3 * run.to_left.median:.3g} ms to the left")
    figure.alt = _in_words(run)
    return figure


def _in_words(run):
    """Return what the figure shows, for who cannot see it."""
    moved = [
        f"the {name} handle moves between {1e3 * log.x.min():.3g} and {1e3 * log.x.max():.3g} mm, and its motor gives "
        f"{-log.F.max():.3g} to {-log.F.min():.3g} N"
        for name, log in (("left", run.left), ("right", run.right))
    ]
    return f"Positions and forces of two coupled paddles over {run.left.t[-1]:.3g} s: {'; '.join(moved)}."
