"""Which settings of a trade-off are tried: those first that decide whether others can be any better."""

import math
from dataclasses import replace

from ..compiler.methods import METHODS
from .choice import MARGIN, STEPS_PER_CONTACT
from .tradeoff_rows import NOT_TRIED, OK, exactness, percent
from .trials import Trial, tried, tried_again

#: errors that differ by less are the same
SAME = 1.2
#: float32 rounds to some 1e-6 of the force: a larger error than this part of it is the same in float64
ROUNDED = 1e-4
#: methods that show what a hold alone makes of error, beside those of one evaluation
EARLY = ("verlet", "rk4", "exact")


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

    def run(function, batch, why=lambda setting: ""):
        left_out = {s: why(s) for s in batch}
        for trial in share(function, [s for s in batch if not left_out[s]]):
            found[trial.setting] = trial
            done(1)
        found.update({s: Trial(s, NOT_TRIED, reason) for s, reason in left_out.items() if reason})

    first = settings[0].precision
    counts = sorted({s.substeps for s in settings})
    once = [s for s in settings if (s.substeps, s.precision) == (counts[0], first)]
    run(tried, [s for s in once if _early(s.method)])
    groups = _groups(found.values())
    run(tried, [s for s in once if not _early(s.method)], lambda s: _beaten(s, groups.get(_shared(s), ())))
    floors = {key: _floor(group) for key, group in _groups(found.values()).items()}
    for before, count in zip(counts, counts[1:], strict=False):
        batch = [s for s in settings if (s.substeps, s.precision) == (count, first)]
        run(tried, batch, lambda s, fewer=before: _no_better(found[replace(s, substeps=fewer)], floors, found))
    twins = {s: found[replace(s, precision=first)] for s in settings if s.precision != first}
    run(tried_again, [s for s, twin in twins.items() if twin.status == OK and twin.error[0] < ROUNDED])
    for s, twin in twins.items():
        limits = {name: getattr(twin, name) for name in ("b_req", "margin", "steps_per_contact", "order")}
        found[s] = replace(found[s] if s in found else _same(s, twin), **limits)
    return [found[s] for s in settings]


def evaluations(method):
    """Return how often a method evaluates the equations of motion in a step, or what its cost comes to."""
    return {"exact": 2, "taylor": 20}.get(method) or METHODS[method.removeprefix("exact+")].evaluations


def _early(method):
    return method in EARLY or (method in METHODS and METHODS[method].evaluations == 1)


def _shared(setting):
    return setting.T, setting.hold, setting.force_at


def _groups(trials):
    """Return the trials that ran to the end with one period, hold and instant of the force, the most exact last."""
    groups = {}
    for trial in sorted(trials, key=lambda trial: exactness(trial.setting.method)):
        if trial.status == OK:
            groups.setdefault(_shared(trial.setting), []).append(trial)
    return groups


def _floor(group):
    """Return the error that a hold alone makes: that of the most exact method."""
    return group[-1].error[0] if group else math.inf


def _beaten(setting, group):
    """Return which cheaper method already has the error of the hold itself, or an empty text.

    That is the error of an exact method, or one that methods of two different orders agree on.
    """
    if not group:
        return ""
    floor, most = _floor(group), exactness(group[-1].setting.method)
    orders = {exactness(t.setting.method) for t in group if t.error[0] / SAME <= floor <= SAME * t.error[0]}
    if most < exactness("taylor") and len(orders - {1}) < 2:
        return ""
    for t in group:
        cheaper = evaluations(t.setting.method) <= evaluations(setting.method)
        ample = (t.margin is None or t.margin >= MARGIN) and (t.steps_per_contact or math.inf) >= STEPS_PER_CONTACT
        if cheaper and ample and t.error[0] <= SAME * floor:
            return f"{t.setting.method} already has the error that hold={setting.hold!r} alone makes, {percent(floor)}"
    return ""


def _no_better(trial, floors, found):
    """Return why more substeps than a trial's cannot be better, or an empty text."""
    if trial.status != OK:
        return trial.why if trial.status == NOT_TRIED else ""
    s, error = trial.setting, trial.error[0]
    if trial.margin is not None and trial.margin < MARGIN:
        return ""
    if error <= SAME * floors[_shared(s)]:
        return f"substeps={s.substeps} already has the error that hold={s.hold!r} alone makes, {percent(error)}"
    if s.method in METHODS and METHODS[s.method].steps > 1:
        return f"{s.method} evaluates once a step: for what substeps cost, a shorter T shortens the hold too"
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
