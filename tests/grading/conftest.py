"""What the tests of a process share: a zygote for each level, as each takes seconds of a processor to start."""

from contextlib import ExitStack, contextmanager

import pytest

from hapticlab.grading import bench, run
from hapticlab.grading.bench import Bench, Reply, as_json
from hapticlab.grading.sessions.starter import Walls, start


@pytest.fixture(scope="session")
def started():
    """Return the Starter of a level, begun once, for limits as they are by default; it hides nothing but the package's labs."""
    with ExitStack() as running:
        known = {}

        def of_level(sandbox="auto", hidden=()):
            if sandbox not in known:
                begun = running.enter_context(start(sandbox))
                known.update(dict.fromkeys([sandbox, begun.level, *(["auto"] if begun.level == "namespaces" else [])], begun))
            return known[sandbox]

        yield of_level


@pytest.fixture(scope="session")
def here(started):
    """Return a context in which all is graded in this process, where worker processes are not the point."""

    @contextmanager
    def graded_here():
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(bench, "start", lambda sandbox, *_: _Lent(started(sandbox)))
            patch.setattr(run, "Workers", _Here)
            yield

    return graded_here


class _Lent:
    """A Starter that stays when whoever has it is done."""

    def __init__(self, starter):
        self._starter = starter

    def __getattr__(self, name):
        return getattr(self._starter, name)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass


class _Here:
    """A crew of one bench in this process; used as :class:`hapticlab.grading.workers.Workers`."""

    def __init__(self, number, *given, preloaded=None):
        self.number, self._bench, self.seconds, self.walls = 1, Bench(*given), 0.0, Walls()

    def __enter__(self):
        self.walls = self._bench.__enter__().walls
        return self

    def __exit__(self, *_):
        self._bench.__exit__()

    def graded(self, tasks, last):
        for task in tasks:
            yield task, Reply.from_json(self._bench.graded(as_json(task, last)))
