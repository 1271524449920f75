"""Which settings of a trade-off are tried: those first that decide whether others can be any better."""

import math
from dataclasses import replace

from .tradeoff_rows import NOT_TRIED, OK, exactness, percent
from .trials import Trial, tried, tried_again

#: errors that differ by less are the same
SAME = 1.2
#: float32 rounds to some 1e-6 of the force: a larger error than this part of it is the same in float64
ROUNDED = 1e-4


def all_tried(settings, share, done):
    """Return the trials of all settings, in their order; those that another is sure to beat are not run.

    Parameters
    ----------
    settings : sequence of Setting
    share : callable ``(function, settings) -> trials``
    done : callable ``(count)``
        Told how many settings are done.
    """
    found = {}

    def run(function, batch):
        for trial in share(function, batch):
            found[trial.setting] = trial
            done(1)

    first = settings[0].precision
    counts = sorted({s.substeps for s in settings})
    run(tried, [s for s in settings if (s.substeps, s.precision) == (counts[0], first)])
    floors = _floors(found.values())
    for before, count in zip(counts, counts[1:], strict=False):
        batch = {s: found[replace(s, substeps=before)] for s in settings if (s.substeps, s.precision) == (count, first)}
        left_out = {s: _no_better(trial, floors, found) for s, trial in batch.items()}
        run(tried, [s for s, why in left_out.items() if not why])
        found |= {s: Trial(s, NOT_TRIED, why) for s, why in left_out.items() if why}
    twins = {s: found[replace(s, precision=first)] for s in settings if s.precision != first}
    run(tried_again, [s for s, twin in twins.items() if twin.status == OK and twin.error[0] < ROUNDED])
    for s, twin in twins.items():
        limits = {name: getattr(twin, name) for name in ("b_req", "margin", "steps_per_contact", "order")}
        found[s] = replace(found[s] if s in found else _same(s, twin), **limits)
    return [found[s] for s in settings]


def _floors(trials):
    """Return the error that a hold alone makes, with each period and instant of the force: of the most exact method that ran."""
    floors = {}
    for trial in sorted(trials, key=lambda trial: exactness(trial.setting.method)):
        floors[_shared(trial.setting)] = trial.error[0] if trial.status == OK else floors.get(_shared(trial.setting), math.inf)
    return floors


def _shared(setting):
    return setting.T, setting.hold, setting.force_at


def _no_better(trial, floors, found):
    """Return why more substeps than a trial's cannot be better, or an empty text."""
    if trial.status != OK:
        return trial.why if trial.status == NOT_TRIED else ""
    s, error = trial.setting, trial.error[0]
    if error <= SAME * floors[_shared(s)]:
        return f"substeps={s.substeps} already has the error that hold={s.hold!r} alone makes, {percent(error)}"
    before = [t for t in found.values() if t.setting.substeps < s.substeps and replace(t.setting, substeps=s.substeps) == s]
    if any(t.error[0] <= SAME * error for t in before):
        return f"substeps={s.substeps} is no better than fewer, {percent(error)}"
    return ""


def _same(setting, twin):
    """Return the trial of a setting that is not tried again with another precision."""
    if twin.status != OK:
        return replace(twin, setting=setting, costs={})
    why = f"the error of {twin.setting.precision}, {percent(twin.error[0])}, is far above its rounding"
    return Trial(setting, NOT_TRIED, why)
