"""One row of a trade-off: a way to compute a scene on one target, with what it gets wrong, costs and needs."""

from __future__ import annotations

import csv
import itertools
import math
from dataclasses import asdict, astuple, dataclass, fields, replace
from typing import TYPE_CHECKING, Any

from ...base.grid import Grid
from ...base.shows_itself import ShowsItself, Tabular
from ...compiler.methods.chosen_method import chosen_method

if TYPE_CHECKING:
    from ...base.annotations import File

#: percentages below this are not told apart
LEAST_PERCENT = 0.001


class Status(str):
    """How the trial of a setting ended: it prints with the instant, its ``name`` is without."""

    name: str

    def __new__(cls, name: str, when: str = "") -> Status:
        self = super().__new__(cls, f"{name} {when}".rstrip())
        self.name = name
        return self

    def __getnewargs__(self):
        return self.name, self.removeprefix(self.name).strip()


OK, TOO_LARGE, NOT_TRIED, REFUSED = map(Status, ("ok", "does not fit", "not tried", "refused"))
#: of settings that ran, whose errors are measured: those that a choice tells of, and those that it need not
UNSURE = ("uncertified", "chaotic", "faulted")
RAN = (OK.name, TOO_LARGE.name, *UNSURE)


@dataclass(frozen=True)
class Row(ShowsItself):
    """A setting of :func:`hapticlab.compile` on one target.

    Attributes
    ----------
    T : float
        Period [s].
    method, substeps, hold, force_at, precision
        The rest of the setting; precision is "float32" or "float64".
    target : str
        "pc" or the name of a board.
    err_max, err_rms, err_hold : float
        Error of the force at the samples, at most and as root of the mean square, and at most of the force held over each
        period, all as parts of the greatest force; nan where it did not run.
    doubt : float
        By which part of the greatest force the solvers of the reference differ: no smaller error is certain.
    sensor_floor : float
        Error at the samples that the encoder alone makes, with a perfect program.
    order_seen, order_claimed : float or None
        By which power of T the error falls from this T to the next shorter, and what the combination promises.
    cycles, measured : float or None
        Of one tick of the program on a board: predicted, typical; and as measured there. None on the pc.
    seconds : float
        Time of a tick of the program [s]: on the pc measured, on a board from its cycles.
    load : float
        Part of the period that is taken: on a board by the rest of the step and the telemetry too.
    margin, steps_per_contact : float or None
        Largest stable step over the step used; steps in the shortest contact, inf where contacts are located or absent.
    b_req, b_device : float or None
        Damping [N s/m] that a device needs for passivity in every hand, and has.
    b_where : str
        Where a scene that is not linear asks for b_req: it is of small motions about there. Else empty.
    status : Status
        "ok", "unstable at t=...", "does not fit", "refused", "uncertified", "chaotic after ...", "faulted after ...",
        "not tried".
    why : str
        The reason of a status other than "ok".
    estimated : bool
        Whether the time on the pc is no measurement: from the boards' machine, for settings that cannot be the least.
    static : bool
        Whether nothing moves in the scene: then method, substeps and hold mean nothing.
    """

    method: str
    T: float
    substeps: int
    hold: str
    force_at: str
    precision: str
    target: str
    err_max: float = math.nan
    err_rms: float = math.nan
    err_hold: float = math.nan
    doubt: float = math.nan
    sensor_floor: float = math.nan
    order_seen: float | None = None
    order_claimed: float | None = None
    cycles: float | None = None
    measured: float | None = None
    seconds: float = math.nan
    load: float = math.nan
    margin: float | None = None
    steps_per_contact: float | None = None
    b_req: float | None = None
    b_device: float | None = None
    b_where: str = ""
    estimated: bool = False
    static: bool = False
    status: Status = OK
    why: str = ""

    def __post_init__(self) -> None:
        if not isinstance(self.status, Status):
            object.__setattr__(self, "status", Status(self.status))

    def __str__(self) -> str:
        held = f"error {percent(self.err_max)} at the samples, {percent(self.err_hold)} held; load {percent(self.load)}"
        return f"{self.target}: {self.name}: {held if self.ran else self.why or self.status}"

    @property
    def passive(self) -> bool | None:
        """Whether the device is passive in every passive hand; None where that is not known."""
        return None if self.b_req is None or self.b_device is None else self.b_req <= self.b_device

    @property
    def ran(self) -> bool:
        """Whether it ran to the end, so that its errors are known."""
        return self.status.name in RAN

    @property
    def name(self) -> str:
        """The setting in a few words."""
        parts = [*([] if self.static else [self.method, self.hold]), f"T = {self.T * 1e3:g} ms"]
        parts += [f"{self.substeps} substeps"] * (self.substeps > 1) + [f"force {self.force_at}"] * (self.force_at != "before")
        return ", ".join([*parts, self.precision])


_HEADS = (
    ("method", 26), ("T ms", 5), ("sub", 3), ("hold", 4), ("force", 6), ("real", 4), ("target", 10), ("err max", 9),
    ("rms", 9), ("held", 9), ("sensor", 9), ("order", 9), ("cycles", 7), ("time", 8), ("load", 8), ("margin", 6),
    ("contact", 7), ("b_req", 6), ("passive", 7), ("status", 0),
)  # fmt: skip


#: what a notebook shows of a row
_SHOWN = ("target", "method", "T", "substeps", "hold", "precision", "err_max", "err_hold", "load", "b_req", "status")

#: left out where rows of one target are compared, which all ran
_ASIDE = ("target", "rms", "cycles", "time", "contact", "passive", "status")
LEGEND = (
    "err max and held: error of the force at the samples, and held over the period; sensor: caused by the encoder alone; all as",
    "fractions of the greatest force. order: found/expected, as a power of T; load: fraction of the period; margin: longest "
    "stable step",
    "over the step used; contact (in the table): steps in the shortest; b_req: damping that a passive device needs [N s/m]",
)


class Table(Tabular, tuple):
    """Rows of a trade-off; printing it shows them, one a line."""

    def __str__(self) -> str:
        return self._text(_HEADS)

    def _sentence(self):
        return f"{len(self)} settings on {len({row.target for row in self})} targets, {len(self.where(status='ok'))} of them ok"

    def _tables(self):
        yield "", Grid.of(self, *_SHOWN)

    def to_pandas(self) -> Any:
        """Every attribute of every row as a ``pandas.DataFrame`` in SI units, which its ``attrs["units"]`` names."""
        return Grid.of(self).to_pandas()

    def brief(self) -> str:
        """Return the rows in lines of less than 120 columns, without their target and what is of little weight."""
        aside = (*_ASIDE, "force") if all(row.force_at == "before" for row in self) else _ASIDE
        return self._text([(head, width) for head, width in _HEADS if head not in aside])

    def _text(self, heads):
        lines = [{head: head for head, _ in heads}, *map(_cells, self)]
        sides = {"method": "<", "status": "<"}
        return "\n".join(
            " ".join(f"{cells[head]:{sides.get(head, '>')}{width}}" for head, width in heads).rstrip() for cells in lines
        )

    def where(self, **wanted: Any) -> Table:
        """Return the rows whose attributes have these values, as in ``table.where(target="uno", status="ok")``."""
        return Table(row for row in self if all(getattr(row, name) == value for name, value in wanted.items()))

    def to_csv(self, path: File) -> File:
        """Write the rows to a file, SI units, and return its path."""
        with open(path, "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow([*(f.name for f in fields(Row)), "passive"])
            writer.writerows([*astuple(row), row.passive] for row in self)
        return path


def _cells(row):
    """The cells of a row as a line shows them, by the head of the column."""
    order = f"{_plain(row.order_seen, '.1f')}/{_plain(row.order_claimed, 'g')}"
    cells = (
        "none needed" if row.static else row.method, f"{row.T * 1e3:g}", *_step_of(row), row.force_at,
        row.precision.replace("float", "f"), row.target,
        *map(percent, (row.err_max, row.err_rms, row.err_hold, row.sensor_floor)), order,
        _plain(row.measured or row.cycles, ".0f"), duration(row.seconds), percent(row.load), _plain(row.margin, ".3g"),
        _plain(row.steps_per_contact, ".3g"), _plain(row.b_req, ".3g"),
        {None: "-", True: "yes", False: "no"}[row.passive], row.status,
    )  # fmt: skip
    return {head: cell for (head, _), cell in zip(_HEADS, cells, strict=True)}


def _step_of(row):
    return ("-", "-") if row.static else (row.substeps, row.hold)


def _plain(number, form):
    return "-" if number is None or number != number else f"{number:{form}}"


def exactness(method):
    """A number that is larger for a method whose own error is less."""
    chosen = chosen_method(method)
    return (10 if chosen.rest else 11) if chosen.locates else chosen.rest.order


def percent(part):
    """Return a part as a percentage of two digits or whole, or a dash.

    Examples
    --------
    >>> percent(0.01234), percent(16.1), percent(3.2e-7), percent(float("nan"))
    ('1.2 %', '1610 %', '< 0.001 %', '-')
    """
    if part is None or part != part:
        return "-"
    number = 100 * part
    if 0 < number < LEAST_PERCENT:
        return f"< {LEAST_PERCENT} %"
    return f"{number:.0f} %" if abs(number) >= 10 else f"{number:.2g} %"


def duration(seconds):
    """Return a time shorter than a second with its unit.

    Examples
    --------
    >>> duration(1.2345e-6), duration(43e-9)
    ('1.23 us', '43 ns')
    """
    if seconds is None or seconds != seconds:
        return "-"
    factor, unit = (1e9, "ns") if seconds < 1e-6 else (1e6, "us") if seconds < 1e-3 else (1e3, "ms")
    return f"{seconds * factor:.3g} {unit}"


def rows_of(bench, trials, floors, targets):
    """Yield the rows of trials on every target; a board has float32 alone."""
    orders = _orders(trials)
    for trial in trials:
        s = trial.setting
        row = Row(
            **asdict(s), target="pc", err_max=trial.error[0], err_rms=trial.error[1], err_hold=trial.error[2],
            doubt=bench.doubt, sensor_floor=floors[s.T, s.hold], order_seen=orders.get(s), order_claimed=trial.order,
            margin=trial.margin, steps_per_contact=trial.steps_per_contact, b_req=trial.b_req, b_device=bench.paddle.b,
            b_where=trial.b_where, static=not bench.scene.coordinates,
            status=trial.status, why=trial.why,
        )  # fmt: skip
        row = _certain(row, bench)
        for target in targets:
            if target == "pc":
                yield replace(row, seconds=trial.seconds, load=trial.seconds / s.T, estimated=trial.estimated)
            elif s.precision == "float32":
                yield _on_board(replace(row, target=target), trial.costs.get(target))


def _certain(row, bench):
    """Return a row that says what the reference leaves open."""
    if row.status != OK:
        return row
    if bench.chaotic is not None:
        why = "the two solvers of the reference differ from then on; the errors are those before that time"
        return replace(row, status=Status("chaotic", f"after {bench.chaotic:.3g} s"), why=why)
    if bench.faulted is not None:
        why = "the force of the reference is not finite from then on; the errors are those before that time"
        return replace(row, status=Status("faulted", f"after {bench.faulted:.3g} s"), why=why)
    if row.err_max < 10 * bench.doubt:
        return replace(row, status=Status("uncertified"), why=f"the solvers of the reference differ by {percent(bench.doubt)}")
    return row


def _on_board(row, cost):
    if cost is None:
        return row
    if isinstance(cost, str):
        return replace(row, status=TOO_LARGE if row.ran else row.status, why=row.why or cost, load=math.inf)
    row = replace(row, cycles=cost.typical, seconds=cost.typical / cost.board.hz, load=cost.share)
    return replace(row, status=TOO_LARGE, why=cost.memory_problem or cost.in_words()) if row.ran and not cost.fits else row


def _orders(trials):
    """Return for each setting by which power of T its error falls to the next shorter T."""
    found, ran = {}, {trial.setting: trial for trial in trials if trial.status == OK}
    shorter = dict(itertools.pairwise(sorted({s.T for s in ran}, reverse=True)))
    for s, trial in ran.items():
        other = ran.get(replace(s, T=shorter.get(s.T)))
        if other and min(trial.error[1], other.error[1]) > 0:
            found[s] = math.log(trial.error[1] / other.error[1]) / math.log(s.T / other.setting.T)
    return found
