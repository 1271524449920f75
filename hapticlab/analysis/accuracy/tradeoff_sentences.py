"""One row of a trade-off in sentences: what was found, where it comes from, and what would change it."""

from .tradeoff_rows import duration, exactness, percent

#: an order this far below what is claimed is pointed at
MISSED = 0.3
#: errors that differ by less are the same
SAME = 1.2


def explained(row, others, every):
    """The row in words, one sentence a line.

    Parameters
    ----------
    row : Row
    others : sequence of Row
        Of the same trade-off.
    every : int
        Ticks per telemetry sample, of the load.
    """
    told = [f"{row.name} on {row.target}: {row.status}" + (f", {row.why}" if row.why else "")]
    if row.ran:
        told += [*_error(row, others), *_order(row), *_stability(row)]
    if row.load == row.load:
        told += _cost(row, every)
    return "\n  ".join([*told, *(_passivity(row) if row.b_req is not None else [])])


def _error(row, others):
    yield (
        f"error of the force at the samples {percent(row.err_max)} of the greatest, rms {percent(row.err_rms)}; "
        f"held over the period {percent(row.err_hold)}, which only a shorter T reduces"
    )
    of_hold = {}  # the error of the most exact method with each hold, which is the hold's own
    for r in sorted(others, key=lambda r: (exactness(r.method), r.substeps)):
        if r.ran and (r.T, r.target, r.precision, r.force_at) == (row.T, row.target, row.precision, row.force_at):
            of_hold[r.hold] = r.err_max
    own, best = of_hold[row.hold], min(of_hold, key=of_hold.get)
    if row.err_max > SAME * own:
        yield f"hold={row.hold!r} alone causes {percent(own)} of that; the rest comes from the steps of the method"
    elif of_hold[best] < row.err_max / SAME:
        yield f"exact methods have {percent(own)} with hold={row.hold!r}, and with hold={best!r} {percent(of_hold[best])}"
    if row.sensor_floor > 0:
        side = "below" if row.err_max < row.sensor_floor else "above"
        yield f"{side} the error of the encoder alone, {percent(row.sensor_floor)}"
    if row.doubt > row.err_max / 10:
        yield f"the solvers of the reference differ by {percent(row.doubt)}, so no smaller error is certain"


def _order(row):
    if row.order_seen is not None and row.order_claimed is not None:
        missed = row.order_seen < row.order_claimed - MISSED and row.err_max > 1e-5
        but = f", less than the expected {row.order_claimed:g}" if missed else f"; expected {row.order_claimed:g}"
        yield f"from this T to the next shorter the error falls with order {row.order_seen:.2f}{but}"


def _stability(row):
    if row.margin is not None:
        colour = "green" if row.margin >= 2 else "amber, test it in a long run" if row.margin >= 1 else "unstable sooner or later"
        yield f"the longest stable step is {row.margin:.3g} times the step used: {colour}"
    if row.steps_per_contact is not None and row.steps_per_contact < float("inf"):
        enough = "enough" if row.steps_per_contact >= 10 else "10 are needed, or contacts that are located (method='taylor')"
        yield f"{row.steps_per_contact:.3g} steps in the shortest contact: {enough}"


def _cost(row, every):
    if row.target == "pc":
        about = "estimated from the time of the boards' virtual machine: " if row.estimated else ""
        yield f"{about}{duration(row.seconds)} per tick on this computer, {percent(row.load)} of the period"
    if row.cycles is None:
        return
    yield (
        f"{row.cycles:.0f} cycles per tick (predicted), {duration(row.seconds)}; with the rest of the step and telemetry every "
        f"{every} ticks {percent(row.load)} of the period"
    )
    if row.measured is not None:
        yield f"measured {row.measured:.0f} cycles, {row.measured / row.cycles:.3f} of the prediction"


def _passivity(row):
    answer = "passive in every passive hand" if row.passive else "not passive in every hand"
    yield f"needs a device with b >= {row.b_req:.3g} N s/m, and has {row.b_device:.3g} N s/m: {answer}"
    if row.b_where:
        yield f"this holds for small motions, because the scene is not linear; the most damping is needed at {row.b_where}"
