"""The immutable record of what happened on a paddle, which crosses layers."""

from __future__ import annotations

import csv
import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any
from zipfile import BadZipFile

import numpy as np

from ..errors import AnalysisError
from .arguments import what_is
from .facts import Fact, facts, in_words
from .grid import frame, labelled
from .missed_events import depth_words, ends_inside
from .shows_itself import ShowsItself
from .thumbnail import thumbnail

if TYPE_CHECKING:
    from .annotations import File

UNITS = {"t": "s", "x": "m", "v": "m/s", "F": "N", "x_true": "m", "v_true": "m/s", "F_applied": "N", "x_switch": "m"}
FLAGS = ("saturated", "gap", "overrun")
ABOUT = ("scene", "paddle", "T", "delay", "sensor_delay", "every", "fault")
#: what people try -> what a record has
MEANT = {
    "time": "t", "times": "t", "position": "x", "pos": "x", "velocity": "v", "vel": "v", "speed": "v", "force": "F", "f": "F",
    "period": "T", "dt": "T", "names": "columns", "params": "parameters", "csv": "to_csv",
}  # fmt: skip
TO_PANDAS = ("to_dataframe", "to_frame", "df", "dataframe", "pandas")
#: what a notebook says of each column
MEANINGS = {
    "t": "Time", "x": "Handle position, positive into the wall", "v": "Handle velocity",
    "F": "Force on the environment; the motor applies -F", "x_true": "Position before the sensor",
    "v_true": "Velocity before the sensor", "F_applied": "Force that acted", "saturated": "Samples whose force was limited",
    "gap": "Samples that follow a lost one", "overrun": "Samples whose step missed its period",
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class Telemetry(ShowsItself):
    """The record of a run of a paddle, one row per sample.

    Attributes
    ----------
    t, x, v, F : array, shape (N,), read-only
        Time [s]; handle position [m] and velocity [m/s] as the controller saw them; force on the environment [N],
        computed from sample n, after saturation. It is felt from ``t[n] + delay`` on, for one period.
    T, delay : float
        Sampling period and computational delay [s].
    channels : dict of str to array
        Watched states and, where they differ from what was sensed or commanded, ``x_true``, ``v_true``, ``F_applied``
        and ``x_switch``. Each is also an attribute: ``log.z``. Where events are located inside the period that begins
        with a sample: ``unlocated``, steps that left one out, and ``overlap``, how deep bodies are inside each other at
        its end.
    units : dict of str to str
        Of what was recorded, and of parameters where the scene names them.
    paddle, scene : str
    parameters : dict of str to float
        The scene's parameters; SI.
    fault : str or None
        What stopped the motor, when and why.
    saturated, gap, overrun : array of bool, shape (N,)
        Samples whose force was limited, that follow a lost sample, whose step missed its period.
    every : int
        Periods from one row to the next; above 1 the link carried no more. ``T`` is then the time between rows.
    changes : tuple of (float, dict)
        What was set while it ran: the time [s] from which it holds, and the parameters, SI.
    sensor_delay : float
        How long before a sample the handle was where ``x`` says [s], as far as it is known.

    Examples
    --------
    >>> import numpy as np
    >>> from hapticlab.base.telemetry import Telemetry
    >>> log = Telemetry(t=[0, 1e-3], x=[0, 1e-6], v=[0, 1e-3], F=[0, 0], T=1e-3, channels={"z": [1, 2]})
    >>> log.z
    array([1., 2.])
    >>> log
    Telemetry(2 samples, 0.002 s at T = 0.001 s: t, x, v, F, z)
    """

    t: np.ndarray
    x: np.ndarray
    v: np.ndarray
    F: np.ndarray
    T: float
    delay: float = 0.0
    channels: dict[str, np.ndarray] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)
    paddle: str = ""
    scene: str = ""
    parameters: dict[str, float] = field(default_factory=dict)
    fault: str | None = None
    saturated: np.ndarray | None = None
    gap: np.ndarray | None = None
    overrun: np.ndarray | None = None
    every: int = 1
    changes: tuple[tuple[float, dict[str, float]], ...] = ()
    sensor_delay: float = 0.0

    def __post_init__(self) -> None:
        samples = len(self.t)
        for name in ("t", "x", "v", "F"):
            object.__setattr__(self, name, _column(name, getattr(self, name), samples, float))
        for name in FLAGS:
            given = getattr(self, name)
            object.__setattr__(self, name, _column(name, np.zeros(samples) if given is None else given, samples, bool))
        columns = {name: _column(name, values, samples, float) for name, values in self.channels.items()}
        object.__setattr__(self, "channels", columns)
        object.__setattr__(self, "changes", tuple((float(t), dict(set_)) for t, set_ in self.changes))
        known = {name: UNITS[name] for name in self.columns if name in UNITS}
        object.__setattr__(self, "units", {**known, **self.units})

    @property
    def columns(self) -> tuple[str, ...]:
        """The names of everything recorded, in order."""
        return ("t", "x", "v", "F", *self.channels)

    def __len__(self) -> int:
        return len(self.t)

    def __getattr__(self, name: str) -> np.ndarray:
        channels = self.__dict__.get("channels", {})
        if name in channels:
            return channels[name]
        if name.startswith("__"):
            raise AttributeError(name)
        if name == "plot":
            raise AttributeError(
                "a record has no .plot(). Write hl.plot(log), or name the columns to draw: hl.plot(log, 'x', 'v')"
            )
        recorded = ", ".join(("t", "x", "v", "F", *channels))
        if name in TO_PANDAS:
            raise AttributeError(f"a record has no {name}; log.to_pandas() makes a table of it")
        if name in MEANT:
            raise AttributeError(f"a record has {MEANT[name]}, not {name}: log.{MEANT[name]}; it holds {recorded}")
        raise AttributeError(f"{name!r} was not recorded; this log has {recorded}. Watch it: hl.Scene(..., watch=[{name}])")

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.channels]

    def __repr__(self) -> str:
        stopped = f"; fault: {self.fault}" if self.fault else ""
        seconds = f"{len(self) * self.T:g} s at T = {self.T:g} s"
        missed = np.count_nonzero(self.channels.get("unlocated", np.zeros(1)) > 0)
        left_out = f"; an event was not located in {missed} of them, see unlocated" if missed else ""
        left_out += f"; at the end bodies overlap by {depth_words(self, self.overlap[-1])}" if ends_inside(self) else ""
        return f"Telemetry({self._samples()}, {seconds}: {', '.join(self.columns)}{left_out}{stopped})"

    def _samples(self):
        return f"{len(self)} sample{'s' * (len(self) != 1)}"

    def _sentence(self):
        stopped = f"; fault: {self.fault}" if self.fault else ""
        of = f" of {self.scene}" if self.scene else ""
        return f"{self._samples()}{of}, {len(self) * self.T:g} s at T = {1e3 * self.T:g} ms{stopped}"

    def _facts(self):
        listed = [Fact(name, getattr(self, name), self.units.get(name, ""), MEANINGS.get(name, "")) for name in self.columns]
        raised = [Fact(name, getattr(self, name), "", MEANINGS[name]) for name in FLAGS if getattr(self, name).any()]
        told_last = ("T", "delay", "sensor_delay", "every", "paddle", "parameters", "changes")
        rest = [fact for fact in facts(self) if fact.name in told_last]
        told = {
            "parameters": self._with_units(self.parameters),
            "changes": "\n".join(f"after {' '.join(in_words(t, 's'))}: {self._with_units(set_)}" for t, set_ in self.changes),
        }
        return [*listed, *raised, *(fact._replace(value=told.get(fact.name, fact.value)) for fact in rest)]

    def _with_units(self, parameters):
        shown = {name: " ".join(in_words(value, self.units.get(name, ""))).strip() for name, value in parameters.items()}
        return "; ".join(f"{name} = {words}" for name, words in shown.items())

    def _is_open(self, fact):
        return isinstance(fact.value, np.ndarray)

    def _figure(self):
        return thumbnail(self)

    def _details(self):
        yield "In words", repr(self)

    def to_pandas(self) -> Any:
        """The record with its flags as a ``pandas.DataFrame`` over t, SI; its ``attrs`` have the units and all else.

        Raises
        ------
        AnalysisError
            Where pandas, which is optional, is not installed.

        Examples
        --------
        >>> import hapticlab as hl
        >>> log = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3).run(hl.wall(k=200), duration="10 ms", v=0.1)
        >>> table = log.to_pandas()
        >>> list(table.columns), table.attrs["units"]["F"]
        (['x', 'v', 'F', 'saturated', 'gap', 'overrun'], 'N')
        """
        columns = {name: getattr(self, name) for name in (*self.columns, *FLAGS)}
        about = {name: getattr(self, name) for name in ("parameters", "changes", *ABOUT)}
        return frame(columns, self.units, **about).set_index("t")

    def to_xarray(self) -> Any:
        """The record with its flags as an ``xarray.Dataset`` over t, SI; each variable has its unit in ``attrs["units"]``.

        Its own ``attrs`` have all else as numbers and texts, which a netCDF file takes: ``"parameter k"`` is the value of a
        parameter, ``"changes"`` a text in JSON, and ``"fault"`` is empty where nothing stopped the motor.

        Raises
        ------
        AnalysisError
            Where xarray, which is optional, is not installed.
        """
        variables = {name: (("t",), getattr(self, name)) for name in (*self.columns, *FLAGS) if name != "t"}
        about = {name: getattr(self, name) for name in ABOUT} | {"fault": self.fault or "", "changes": json.dumps(self.changes)}
        about |= {f"parameter {name}": value for name, value in self.parameters.items()}
        return labelled(variables, {"t": self.t}, self.units, **about)

    def save(self, path: File) -> Path:
        """Write everything to a NumPy archive and return its path (``.npz`` is added where missing).

        Parameters
        ----------
        path : str or path
            The file to write; one that is there is replaced.
        """
        path = Path(path)
        path = path if path.suffix == ".npz" else path.with_name(path.name + ".npz")
        plain = {name: getattr(self, name) for name in ("units", "parameters", "changes", *ABOUT)}
        about = json.dumps({"order": list(self.channels), **plain})
        arrays = {name: getattr(self, name) for name in ("t", "x", "v", "F", *FLAGS)}
        np.savez(path, about=np.array(about), **arrays, **{f"channel.{k}": a for k, a in self.channels.items()})  # type: ignore[arg-type]
        return path

    @classmethod
    def load(cls, path: File) -> Telemetry:
        """Read a file that :meth:`save` wrote; it can contain only numbers and text, never code.

        Parameters
        ----------
        path : str or path
            The file to read, an ``.npz``.
        """
        try:
            with open(path, "rb") as raw, np.load(raw, allow_pickle=False) as file:
                about = json.loads(str(file["about"]))
                channels = {name: file[f"channel.{name}"] for name in about.pop("order")}
                arrays = {name: file[name] for name in ("t", "x", "v", "F", *FLAGS)}
                return cls(**arrays, **about, channels=channels)
        except (KeyError, TypeError, ValueError, EOFError, BadZipFile) as problem:
            raise AnalysisError(f"{path} is not a telemetry file ({problem}); give a file that log.save() wrote") from None

    def to_csv(self, path: File) -> File:
        """Write a table whose header carries the units, and return its path; flags appear where any is raised.

        Parameters
        ----------
        path : str or path
            The file to write; one that is there is replaced.
        """
        raised = [name for name in FLAGS if getattr(self, name).any()]
        header = [f"{name} [{self.units.get(name, '1')}]" for name in self.columns] + raised
        columns = [getattr(self, name).tolist() for name in self.columns]
        columns += [getattr(self, name).astype(int).tolist() for name in raised]
        with open(path, "w", newline="", encoding="utf-8") as file:
            table = csv.writer(file, lineterminator="\n")
            table.writerow(header)
            table.writerows(zip(*columns, strict=True))
        return Path(path)


def _column(name, values, samples, type):
    array = np.array(values, type)
    if array.shape != (samples,):
        raise AnalysisError(f"{name} has shape {array.shape}; needs one value per sample, the shape ({samples},) of t")
    array.flags.writeable = False
    return array


def check_record(log, asker, whole=True):
    """Refuse what is no Telemetry, with the call that makes one, and where it is to be whole one with lost samples."""
    if not isinstance(log, Telemetry):
        raise AnalysisError(f"{asker} was given {what_is(log)}; needs the record of a run, log = paddle.run(scene, duration=...)")
    if whole and log.gap.any():
        raise AnalysisError(
            f"{asker}: samples were lost {np.count_nonzero(log.gap)} times, first before t = {log.t[np.argmax(log.gap)]:g} "
            f"s. {asker} needs every sample. Run again, with fewer watched channels or a longer T"
        )
