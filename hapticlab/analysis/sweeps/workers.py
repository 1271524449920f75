"""Work spread over threads, processes, or whatever maps a function over a sequence."""

import itertools
import multiprocessing
import operator
import os
import pickle
import signal
import threading
from collections.abc import Iterable
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, ProcessPoolExecutor, ThreadPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager

from ...base.in_notebook import is_in_browser
from ...errors import AnalysisError

#: how often in a row processes may end before one of them has finished anything
MOST_BREAKS = 3
#: how long to wait at a time [s]; on Windows Ctrl-C is heard in between only
LOOK = 0.2
#: pieces that what maps like map gets at once: few at first, for something to be known soon, then twice as many each time
FIRST_BATCH, LARGEST_BATCH = 16, 256


def number_of(workers):
    """Return workers as a whole number >= 1, or the callable that it is; -1 is one for each processor.

    A browser has one, whatever is asked for: the results are the same, later.
    """
    if callable(workers):
        return workers
    try:
        number = 0 if isinstance(workers, bool) else operator.index(workers)
    except TypeError:
        number = 0
    if number == -1:
        number = os.cpu_count() or 1
    if number < 1:
        like = " (give its map: workers=pool.map)" if callable(getattr(workers, "map", None)) else ""
        like = " (workers=client.get_executor().map)" if hasattr(workers, "get_executor") else like
        raise AnalysisError(
            f"workers = {workers!r}; needs a whole number >= 1, -1 for every processor, or a function like map{like}"
        )
    return 1 if is_in_browser() else number


def spread(function, pieces, workers, *, threads=True):
    """Yield function(piece) for every piece, in any order, each as soon as it is known.

    Parameters
    ----------
    function : callable
        Of a module, where it goes to other processes.
    pieces : iterable
        Taken as they are needed, a few ahead; a callable ``workers`` gets them in lists, as Dask wants it, of up to
        LARGEST_BATCH each.
    workers : int or callable
        So many threads or processes; or like ``map(function, pieces)``: of a pool, of an executor, of a cluster.
    threads : bool
        Whether a number means threads, which is enough where the work is done outside Python.
    """
    if callable(workers):
        yield from _mapped(function, iter(pieces), workers)
    elif workers == 1:
        yield from map(function, pieces)
    elif threads:
        yield from _in_threads(function, pieces, workers)
    else:
        yield from _in_processes(function, pieces, workers)


def _mapped(function, pieces, workers):
    size = FIRST_BATCH
    try:
        while batch := [*itertools.islice(pieces, size)]:
            results, size = workers(function, batch), min(2 * size, LARGEST_BATCH)
            if not isinstance(results, Iterable):
                raise AnalysisError(f"the workers returned {results!r}; needs a map that returns all results, one by one")
            for result in results:
                if callable(getattr(result, "result", None)):
                    raise AnalysisError(
                        f"the workers returned {result!r}; needs a map that returns results, not futures. For a Dask client "
                        "give workers=client.get_executor().map"
                    )
                yield result
    except BrokenExecutor as error:
        raise AnalysisError(
            "a worker of the pool given as workers was killed, which ends the pool. Make a new pool and sweep again, with "
            "resume= to keep the finished points"
        ) from error


def _in_threads(function, pieces, workers):
    pool = ThreadPoolExecutor(workers)
    try:
        yield from _submitted(pool, function, enumerate(pieces), {}, 2 * workers)
    finally:
        pool.shutdown(cancel_futures=True)


class _Processes(ProcessPoolExecutor):
    """Processes that import nothing from the working folder before they have the import path of this one."""

    def submit(self, *task):
        with safe_path():  # a process starts where there is a task for it
            return super().submit(*task)


@contextmanager
def safe_path():
    """Have the processes that start meanwhile import nothing from the working folder; they take the environment along."""
    before = os.environ.get("PYTHONSAFEPATH")
    os.environ["PYTHONSAFEPATH"] = "1"
    try:
        yield
    finally:
        os.environ.pop("PYTHONSAFEPATH")
        os.environ.update({} if before is None else {"PYTHONSAFEPATH": before})


def _in_processes(function, pieces, workers):
    """Start new processes where some were killed, and give them what was under way."""
    pieces, under_way, breaks = enumerate(_sendable(pieces)), {}, 0
    while breaks < MOST_BREAKS:
        # spawned, never forked: a fork copies locks that other threads hold, and other systems than Linux have none
        pool = _Processes(workers, multiprocessing.get_context("spawn"), _begin)
        try:
            todo = itertools.chain([*under_way.items()], pieces)
            for result in _submitted(pool, function, todo, under_way, 2 * workers):
                breaks = 0
                yield result
            return
        except BrokenProcessPool:
            breaks += 1
        finally:
            pool.shutdown(cancel_futures=True)
    raise AnalysisError(
        f"the worker processes ended {MOST_BREAKS} times in a row before they finished any point. If this is a script, each "
        "worker runs it again: put its statements under if __name__ == '__main__':. Otherwise the workers were killed, "
        "perhaps for lack of memory: use fewer workers"
    )


def _sendable(pieces):
    """Refuse at the first piece what no other process can be given, and pass all of them on."""
    for number, piece in enumerate(pieces):
        try:
            if number == 0:
                pickle.dumps(piece)
        except (pickle.PicklingError, AttributeError, TypeError) as error:
            raise AnalysisError(
                f"this cannot be sent to worker processes: {error}. Define its functions, such as a hand's intent, with def "
                "in a module that is imported, or sweep with workers=1"
            ) from error
        yield piece


def _submitted(pool, function, pieces, under_way, ahead):
    """Yield results from a pool, in any order, for (number, piece); ``under_way`` keeps those whose result is not out."""
    futures = {}
    for number, piece in pieces:
        under_way[number] = piece
        futures[pool.submit(function, piece)] = number
        while len(futures) >= ahead:
            yield from _finished(futures, under_way)
    while futures:
        yield from _finished(futures, under_way)


def _finished(futures, under_way):
    for future in wait(futures, LOOK, FIRST_COMPLETED).done:
        result = future.result()
        del under_way[futures.pop(future)]
        yield result


def _begin():
    """Leave Ctrl-C to the process that started this one, and end with it, even if it is killed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with, args=[multiprocessing.parent_process()], daemon=True).start()


def _end_with(parent):
    parent.join()
    os._exit(1)
