"""Whether a scene fits a board's period and memory, and what would: a cheaper method, hold, law, or a slower rate."""

import inspect
import itertools

from ...errors import HapticlabError, ProgramLimitError
from ...scene.laws.chapter_laws import UNILATERAL, wall
from ...scene.laws.taps import TAPS
from ...scene.notation.checks import applied, is_model, written_in
from ...scene.scene import Scene
from ..methods.chosen_method import chosen_method
from ..methods.method_table import METHODS
from ..tick.compile_scene import compile
from ..tick.handle_samples import hold_named
from .cost import board_named, cost

#: periods that are offered [s]: rates of 2000, 1000, 800, 500, 400, 250, 200, 125 and 100 Hz
PERIODS = (0.5e-3, 1e-3, 1.25e-3, 2e-3, 2.5e-3, 4e-3, 5e-3, 8e-3, 10e-3)
#: alternatives named in a refusal
MOST_NAMED = 3


def fit(scene, board="uno", *, every=1, edges_per_second=0.0, promise=False, **options):
    """Return the cost of a scene or a program on a board, or refuse it and name what would fit.

    Parameters
    ----------
    scene : Scene or Program
        A program can only be offered a slower rate or less telemetry. Of a scene that does not fit, alternatives are
        compiled.
    board : str
        See :func:`~hapticlab.compiler.boards.cost.cost`.
    every : int
        Ticks per telemetry sample.
    edges_per_second : float
        See :func:`~hapticlab.compiler.boards.cost.cost`.
    promise : bool
        Ask for the bound that holds for any operands, not for the typical time and its error of 10 %.
    **options
        Of :func:`hapticlab.compile`: T, method, substeps, hold, live, velocity.

    Returns
    -------
    Cost
        Its ``program`` is ready to send.

    Raises
    ------
    ProgramLimitError
        With the share of the period it would take, and what fits.

    Examples
    --------
    >>> import hapticlab as hl
    >>> from hapticlab.compiler.boards.board_fit import fit
    >>> fit(hl.wall()(k=150, x_o=0.01), T=1e-3).fits
    True
    """
    is_scene, beside = isinstance(scene, Scene), {"every": every, "edges_per_second": edges_per_second}
    taken = cost(compile(scene, **options) if is_scene else scene, board, **beside)
    if taken.promised if promise else taken.fits:
        return taken
    if is_scene:
        offers = _offers(scene, taken, promise, beside, options)
    else:
        offers = [_seldom(taken, promise, beside), _slower(taken, promise)]
    offers = [o for o in offers if o][:MOST_NAMED]
    cure = "; fits " + ", or ".join(offers) if offers else "; simplify the scene, because no cheaper options were found that fit"
    raise ProgramLimitError(_what(taken, promise) + cure)


def _what(taken, promise):
    """Say what a refused program takes."""
    method = taken.program.facts.get("method")
    name = f"{taken.name} with {method}" if method else taken.name
    if taken.memory_problem is None:
        return f"{name}: {taken.in_words(promise)}"
    late = taken.period and taken.T < taken.T_needed(promise)
    return f"{name}: " + (f"{taken.in_words(promise)}, and it " if late else "") + taken.memory_problem


def _slower(taken, promise):
    """Return a rate at which the same program fits, in words, or None."""
    if taken.memory_problem:
        return None
    T = _period(taken, promise)
    return T and f"at T = {T:g} s"


def _period(taken, promise):
    """Return the first period offered that is long enough, or None."""
    long_enough = (T for T in PERIODS if max(taken.T, taken.T_needed(promise)) <= T <= taken.board.T_max)
    return next(long_enough, None)


def _offers(scene, taken, promise, beside, options):
    """Yield what fits, in words: at the same rate what changes the motion least, then slower rates, fastest first."""
    same, slower = [], []
    for changes, other, changed in _cheaper(scene, options):
        if any(set(enough) <= set(changes) for enough in same):
            continue  # a change more than one that is enough
        try:
            found = cost(compile(other, **changed), taken.board, **beside)
            T = taken.T if (found.promised if promise else found.fits) else _period(found, promise)
            if found.memory_problem or T is None:
                continue
            if T != found.T and not _fits_at(T, other, changed, taken.board, beside, promise):
                continue
        except HapticlabError:
            continue
        if T == taken.T:
            same.append(changes)
        elif not changes:
            slower.append((T, 0, f"at T = {T:g} s"))
        else:
            slower.append((T, 1, f"with {', '.join(changes)} at T = {T:g} s"))
    yield _seldom(taken, promise, beside)
    yield from (f"with {', '.join(changes)}" for changes in same)
    rates = set()
    for T, _, words in sorted(slower):
        if T not in rates:
            rates.add(T)
            yield words


def _seldom(taken, promise, beside):
    """The decimation with which all the rest fits, in words, or None."""
    for ticks in (2, 5, 10):
        found = cost(taken.program, taken.board, **beside | {"every": max(beside["every"], ticks)})
        if found.promised if promise else found.fits:
            return f"with every={ticks} (one sample of telemetry per {ticks} ticks)"
    return None


def _fits_at(T, scene, options, board, beside, promise):
    found = cost(compile(scene, **{**options, "T": T}), board, **beside)
    return found.promised if promise else found.fits


def _cheaper(scene, options):
    """Yield (changes in words, scene, options) of cheaper ways to the same force, the most faithful first."""
    yield (), scene, options
    defaults = {n: p.default for n, p in inspect.signature(compile).parameters.items()}
    used = {**defaults, **options}
    used |= {"method": str(chosen_method(used["method"], scene.explicit())), "hold": hold_named(used["hold"])}
    if used["substeps"] > 1:
        yield ("substeps=1",), scene, {**options, "substeps": 1}
    bound = set(scene.parameters) <= set(scene.values)
    if used["live"] is None and bound and scene.parameters:
        yield ("live='' (parameters fixed)",), scene, {**options, "live": ()}
    if scene.eom and bound and used["method"] in METHODS:
        yield ("method='exact'", "live=''"), scene, {**options, "method": "exact", "live": ()}
    now = METHODS.get(used["method"])
    if scene.eom and now:
        below = [m for m in METHODS.values() if m.evaluations < now.evaluations and m.name != "euler"]
        for m in sorted(below, key=lambda m: -m.order):
            yield (f"method={m.name!r}",), scene, {**options, "method": m.name}
            if bound and used["live"] is None:
                yield (f"method={m.name!r}", "live=''"), scene, {**options, "method": m.name, "live": ()}
        if used["hold"] != "zoh":
            yield ("hold='zoh'",), scene, {**options, "hold": "zoh"}
    for law, other in _cheaper_laws(scene):
        yield (f"law={law!r}",), other(**scene.values), options
    for name, other in _cheaper_velocities(scene):
        yield (f"velocity={name!r}",), other, options


def _cheaper_laws(scene):
    """Yield (law, wall) that need fewer past samples, where the scene is one of :func:`hapticlab.wall`."""
    for law, taps in TAPS.items():
        if scene.name != f"{law} wall":
            continue
        for unilateral, clamp in itertools.product(UNILATERAL, (False, True)):
            kind = {"unilateral": unilateral, "clamp": clamp}
            if scene.force == wall(law, **kind).force:
                cheaper = sorted((o for o in TAPS if len(TAPS[o]) < len(taps)), key=lambda o: -len(TAPS[o]))
                yield from ((o, wall(o, **kind)) for o in cheaper)


def _cheaper_velocities(scene):
    """Yield (estimate, scene) with estimates of less work, where the scene holds one of hapticlab/scene/laws/estimators.py."""
    defined = {type(e.lhs): e for e in scene.eom if not is_model(e) and getattr(type(e.lhs), "role", None) == "signal"}
    for kind in [kind for kind in defined if hasattr(kind, "instead")]:
        own, waiting = set(), {kind}
        while waiting:  # an estimate's equations speak of the handle and of its own signals
            own |= waiting
            waiting = {type(y) for k in waiting for y in applied([defined[k].rhs], "signal")} - own
        rest = [e for e in scene.eom if is_model(e) or type(e.lhs) not in own]
        for other in kind.instead:
            change = {defined[kind].lhs: other.velocity}
            changed = scene.force.xreplace(change), [e if is_model(e) else e.xreplace(change) for e in rest]
            watch = {name: expr.xreplace(change) for name, expr in scene.watch.items()}
            if not own & {type(y) for y in applied([changed[0], *written_in(changed[1]), *watch.values()], "signal")}:
                values = {k: v for k, v in scene.values.items() if k in scene.parameters}
                new = Scene(changed[0], (*changed[1], *other.eom), watch, name=scene.name)
                yield other.name, new(**{k: v for k, v in values.items() if k in new.parameters})


def table(scenes, board="uno", periods=(1e-3, 2e-3)):
    """Return a table of what fits, as text: one line a scene, one column a period.

    Parameters
    ----------
    scenes : iterable of (Scene, dict)
        Each with its options of :func:`hapticlab.compile`.
    """
    given = board_named(board)
    source = ""
    lines = [f"{given.name:<30} {'instr.':>6} {'typical':>8} {'bound':>8} {'bytes':>6}" + _heads(periods)]
    for scene, options in scenes:
        costs = [cost(compile(scene, **{**options, "T": T}), given) for T in periods]
        c = costs[0]
        answers = [("promised" if c.promised else "yes" if c.fits else "no") + f" {c.share:.0%}" for c in costs]
        line = f"{c.name:<30} {c.instructions:>6} {c.typical:>8} {c.bound:>8} {c.arena:>6}"
        lines.append(line + "".join(f"{a:>16}" for a in answers))
        source = c.source
    return "\n".join([*lines, source])


def _heads(periods):
    return "".join(f"{f'{1 / T:g} Hz':>16}" for T in periods)
