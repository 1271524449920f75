"""Grading on the workers of a Dask cluster; the only place where distributed opens.

What travels is JSON text: there the submission, and the lab with its answers in bytes, as the other computers need not have
them; back the report. A worker that is killed loses its submission's result alone, and Dask gives that to another one.
"""

import atexit
import base64
import json
import shutil
import tempfile
import threading
from dataclasses import asdict
from pathlib import Path

from ..errors import CourseError, EngineMissingError
from .assignment import files_of, find_assignment
from .bench import Bench, Reply, as_json
from .sessions.limits import Limits
from .sessions.starter import Walls, weakest
from .workers import processor_seconds

#: how many submissions a thread of the cluster may have waiting
AHEAD = 2
#: how long a scheduler has to answer at first [s]
PATIENCE = 10
#: of a worker's process: benches nobody works at, by what they were made of
_idle: dict[tuple, list] = {}
_lock = threading.Lock()


class ClusterWorkers:
    """The workers of a cluster; a context manager, used as :class:`hapticlab.grading.workers.Workers`.

    Parameters
    ----------
    address : str
        Of the scheduler, "tcp://host:8786".
    assignment : Assignment
    limits : Limits
    sandbox : {"auto", "namespaces", "user", "landlock", "none"}
    hidden : sequence of str
        Paths of this computer, which the others may see too.
    """

    def __init__(self, address, assignment, limits, sandbox="auto", hidden=()):
        self.address, self.number, self.walls, self.seconds = address, 0, Walls(), 0.0
        self._setup, self._digest = _packed(assignment, limits, sandbox, hidden), assignment.digest

    def __enter__(self):
        self._client = _client(self.address)
        try:
            self.number = sum(self._client.nthreads().values())
            if not self.number:
                raise CourseError(f"{self.address} has no workers; start some: dask worker {self.address}")
            self._before = self._client.run(processor_seconds, on_error="ignore")
            said = [json.loads(text) for text in self._client.run(_ready, self._setup).values()]
            if any(one["digest"] != self._digest for one in said):
                raise CourseError(
                    "the workers of the cluster have a different version of hapticlab; install the same version there"
                )
        except BaseException:
            self._client.close()
            raise
        self.walls = weakest([Walls(**one["walls"]) for one in said])
        return self

    def __exit__(self, *_):
        self._client.run(_close, on_error="ignore")
        now = self._client.run(processor_seconds, on_error="ignore")
        self.seconds = sum(seconds - self._before.get(worker, 0.0) for worker, seconds in now.items())
        self._client.close()

    def graded(self, tasks, last):
        """Yield (task, Reply) as each is known."""
        tasks, busy = iter(tasks), {}
        while True:
            while len(busy) < AHEAD * self.number and (task := next(tasks, None)) is not None:
                busy[self._client.submit(_graded, self._setup, as_json(task, last), pure=False)] = task
            if not busy:
                return
            for future in _done(self._client, busy):
                yield busy.pop(future), _reply(future)


def _client(address):
    try:
        from distributed import Client
    except ImportError:
        raise EngineMissingError(f"{address} is a Dask cluster; to connect to it, do: pip install distributed") from None
    try:
        return Client(address, set_as_default=False, timeout=PATIENCE)
    except (OSError, ValueError) as problem:
        raise CourseError(f"{address}: no Dask scheduler answers there ({problem}); start one: dask scheduler") from None


def _done(client, futures):
    from distributed import wait

    with client.as_current():
        return wait(list(futures), return_when="FIRST_COMPLETED").done


def _reply(future):
    """The outcome of a task; where its workers were killed again and again, that."""
    return Reply(died=True) if future.exception() is not None else Reply.from_json(future.result())


def _packed(assignment, limits, sandbox, hidden):
    """Return as text all that a worker elsewhere needs."""
    hidden = [*hidden, *([str(assignment.answers)] if assignment.answers else [])]
    folders = {"labs": assignment.folder.path, **({"answers": assignment.answers} if assignment.answers else {})}
    files = {
        f"{place}/{assignment.folder.name}/{name}": base64.b64encode(path.read_bytes()).decode()
        for place, folder in folders.items()
        for name, path in files_of(folder).items()
    }
    given = {"seed": assignment.seed, "personal": assignment.personal}
    held = {"files": files, "name": assignment.folder.name, "given": given, "limits": asdict(limits)}
    return json.dumps({**held, "sandbox": sandbox, "hidden": hidden})


def _bench(setup):
    """Return a bench made of what was sent, its files in a folder that goes when it is closed."""
    held, folder = json.loads(setup), Path(tempfile.mkdtemp(prefix="hapticlab-"))
    try:
        for name, content in held["files"].items():
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(base64.b64decode(content))
        answers = folder / "answers"
        assignment = find_assignment(folder / "labs" / held["name"], answers if answers.is_dir() else None, **held["given"])
        bench = Bench(assignment, Limits(**held["limits"]), held["sandbox"], (str(folder), *held["hidden"]))
        return bench.__enter__(), folder
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise


def _with_bench(setup, work):
    """Return work(bench), with one that nobody else works at."""
    with _lock:
        waiting = _idle.setdefault(setup, [])
        held = waiting.pop() if waiting else None
    held = held or _bench(setup)
    try:
        return work(held[0])
    finally:
        with _lock:
            _idle[setup].append(held)


def _ready(setup):
    return _with_bench(
        setup,
        lambda bench: json.dumps({"walls": asdict(bench.walls), "digest": bench.assignment.digest}),
    )


def _graded(setup, text):
    return _with_bench(setup, lambda bench: bench.graded(text))


@atexit.register
def _close():
    """Close what this process has open."""
    with _lock:
        several = [held for waiting in _idle.values() for held in waiting]
        _idle.clear()
    for bench, folder in several:
        bench.__exit__()
        shutil.rmtree(folder, ignore_errors=True)
