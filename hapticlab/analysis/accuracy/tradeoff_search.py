"""Which settings of a trade-off are tried: those first that decide whether others can be any better."""

import math
import statistics
from dataclasses import replace

from ...compiler.methods.chosen_method import chosen_method
from ...compiler.methods.method_table import METHODS
from .tradeoff_choice import MARGIN, STEPS_PER_CONTACT
from .tradeoff_rows import NOT_TRIED, OK, exactness, percent
from .tradeoff_trials import Trial, timed, tried, tried_again

#: errors that differ by less are the same
SAME = 1.2
#: float32 rounds to some 1e-6 of the force: a larger error than this part of it is the same in float64
ROUNDED = 1e-4
#: more substeps are tried only where those before made the error less by this factor, for half of what is expected
LESS = 1.6
#: settings that take this many times the least time can still be the least, where time was estimated
NEAR = 1.2
#: methods that show what a hold alone makes of error, beside those of one evaluation
EARLY = ("verlet", "rk4", "exact")


def all_tried(settings, share, done, b_device=math.inf):
    """Return the trials of all settings, in their order; those that another is sure to beat are not run.

    Parameters
    ----------
    settings : sequence of Setting
    share : callable ``(function, settings) -> trials``
    done : callable ``(count)``
        Told how many settings are done.
    b_device : float
        Damping of the device [N s/m]: settings it makes passive are timed beside those of less load that it does not.
    """
    found = {}

    def run(function, batch, why=lambda setting: ""):
        left_out = {s: why(s) for s in batch}
        for trials in share(function, _by_hold(s for s in batch if not left_out[s])):
            found.update((trial.setting, trial) for trial in trials)
            done(len(trials))
        done(sum(map(bool, left_out.values())))
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
        run(tried, batch, lambda s, n=before: _no_better(s, found[replace(s, substeps=n)], floors, list(found.values())))
    twins = {s: found[replace(s, precision=first)] for s in settings if s.precision != first}
    again = [s for s, twin in twins.items() if twin.status == OK and twin.error[0] < ROUNDED]
    run(tried_again, again)
    done(len(twins) - len(again))
    for s, twin in twins.items():
        limits = {name: getattr(twin, name) for name in ("b_req", "b_where", "margin", "steps_per_contact", "order")}
        found[s] = replace(found[s] if s in found else _same(s, twin), **limits)
    found |= _timed(found, share, b_device)
    return [found[s] for s in settings]


def _by_hold(settings):
    """Return the settings in groups that differ in the hold alone: many methods do not tell holds apart."""
    groups = {}
    for s in settings:
        groups.setdefault(replace(s, hold=None), []).append(s)
    return list(groups.values())


def _timed(found, share, b_device):
    """Return the trials whose time is an estimate, with it measured where they can be the least for some tolerance.

    The estimate of the others is set right by the ratio that was found of those.
    """
    rough = [trial for trial in found.values() if trial.status == OK and trial.estimated]
    near = {trial.setting: trial for trial in rough if _can_be_least(trial, rough, b_device)}
    groups = {}
    for s, trial in near.items():
        groups.setdefault((s.method, s.T, s.substeps, s.force_at, trial.seconds), []).append(s)
    true = {one.setting: one.seconds for some in share(timed, list(groups.values())) for one in some}
    if not true:
        return {}
    ratio = statistics.median(seconds / near[s].seconds for s, seconds in true.items())
    measured = {s: replace(near[s], seconds=seconds, estimated=False) for s, seconds in true.items()}
    return {t.setting: replace(t, seconds=t.seconds * ratio) for t in rough} | measured


def _can_be_least(trial, others, b_device):
    """Tell whether no setting of much less load, as estimated, is as exact, stable and passive."""

    def good(one):
        stable = (one.margin or 0) >= MARGIN and (one.steps_per_contact or math.inf) >= STEPS_PER_CONTACT
        return stable and (2 if one.b_req is not None and one.b_req <= b_device else 1)

    load = trial.seconds / trial.setting.T
    return not any(
        NEAR * other.seconds / other.setting.T < load and other.error[0] <= SAME * trial.error[0] and good(other) >= good(trial)
        for other in others
    )


def evaluations(method):
    """The evaluations of the equations of motion in a step, or what the cost of a method comes to."""
    chosen = chosen_method(method)
    return (20 if chosen.rest else 2) if chosen.locates else chosen.rest.evaluations


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
    """The cheaper method that already has the error of the hold itself, or an empty text.

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
        if cheaper and _ample(t) and t.error[0] <= SAME * floor:
            return f"{t.setting.method} already has the error that hold={setting.hold!r} alone causes, {percent(floor)}"
    return ""


def _no_better(setting, trial, floors, found):
    """Return why a setting with more substeps than a trial's cannot be better, or an empty text."""
    if trial.status != OK:
        return trial.why if trial.status == NOT_TRIED else ""
    s, error = trial.setting, trial.error[0]
    if trial.margin is not None and trial.margin < MARGIN:
        return ""
    if error <= SAME * floors[_shared(s)]:
        return f"substeps={s.substeps} already has the error that hold={s.hold!r} alone causes, {percent(error)}"
    if s.method in METHODS and METHODS[s.method].steps > 1:
        return f"{s.method} evaluates once per step, so for the cost of substeps a shorter T also shortens the hold"
    before = [t for t in found if t.setting.substeps < s.substeps and replace(t.setting, substeps=s.substeps) == s]
    if any(t.error[0] <= LESS * error for t in before):
        return f"substeps={s.substeps} did not make the error much smaller than fewer substeps did, {percent(error)}"
    expected = error / (setting.substeps / s.substeps) ** exactness(s.method)
    for t in found:
        cheaper = t.setting.substeps * evaluations(t.setting.method) <= setting.substeps * evaluations(s.method)
        if cheaper and _shared(t.setting) == _shared(s) and _ample(t) and t.error[0] <= expected:
            other = f"{t.setting.method} with substeps={t.setting.substeps}"
            return (
                f"{other} has an error of {percent(t.error[0])}, here {percent(expected)} is expected for at least the same work"
            )
    return ""


def _ample(trial):
    """Tell whether a trial is far enough from instability to stand for others."""
    return (trial.margin is None or trial.margin >= MARGIN) and (trial.steps_per_contact or math.inf) >= STEPS_PER_CONTACT


def _same(setting, twin):
    """Return the trial of a setting that is not tried again with another precision."""
    if twin.status != OK:
        return replace(twin, setting=setting, costs={})
    why = f"the error of {twin.setting.precision}, {percent(twin.error[0])}, is far above its rounding"
    return Trial(setting, NOT_TRIED, why)
