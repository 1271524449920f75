"""Work spread over threads, processes, or whatever maps a function over a sequence."""

import itertools
import multiprocessing
import operator
import os
import signal
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, ThreadPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool

from ..errors import AnalysisError

#: how often in a row processes may end before one of them has finished anything
MOST_BREAKS = 3


def number_of(workers):
    """Return workers as a whole number >= 1, or the callable that it is; -1 is one for each processor."""
    if callable(workers):
        return workers
    try:
        number = operator.index(workers)
    except TypeError:
        number = 0
    if number == -1:
        return os.cpu_count() or 1
    if number < 1:
        like = " (give its map: workers=pool.map)" if callable(getattr(workers, "map", None)) else ""
        raise AnalysisError(
            f"workers = {workers!r}; needs a whole number >= 1, -1 for every processor, or a function like map{like}"
        )
    return number


def spread(function, pieces, workers, *, threads=True):
    """Yield function(piece) for every piece, in any order, each as soon as it is known.

    Parameters
    ----------
    function : callable
        Of a module, where it goes to other processes.
    pieces : iterable
        Taken as they are needed, a few ahead; a callable ``workers`` may take all at once.
    workers : int or callable
        So many threads or processes; or like ``map(function, pieces)``: of a pool, of an executor, of a cluster.
    threads : bool
        Whether a number means threads, which is enough where the work is done outside Python.
    """
    if callable(workers):
        yield from workers(function, pieces)
    elif workers == 1:
        yield from map(function, pieces)
    elif threads:
        yield from _in_threads(function, pieces, workers)
    else:
        yield from _in_processes(function, pieces, workers)


def _in_threads(function, pieces, workers):
    pool = ThreadPoolExecutor(workers)
    try:
        yield from _submitted(pool, function, pieces, {}, 2 * workers)
    finally:
        pool.shutdown(cancel_futures=True)


def _in_processes(function, pieces, workers):
    """Start new processes where some were killed, and give them what was under way."""
    pieces, under_way, breaks = iter(pieces), {}, 0
    while breaks < MOST_BREAKS:
        # spawned, never forked: a fork copies locks that other threads hold, and other systems than Linux have none
        pool = ProcessPoolExecutor(workers, multiprocessing.get_context("spawn"), _ignore_interrupt)
        try:
            for result in _submitted(pool, function, itertools.chain([*under_way.values()], pieces), under_way, 2 * workers):
                breaks = 0
                yield result
            return
        except BrokenProcessPool:
            breaks += 1
        finally:
            pool.shutdown(cancel_futures=True)
    raise AnalysisError(
        f"the worker processes died {MOST_BREAKS} times in a row, and none had finished anything. If this is a script, each of "
        "them runs it again: put what it does under if __name__ == '__main__':. Else they were killed, for want of memory "
        "perhaps: take fewer workers"
    )


def _submitted(pool, function, pieces, under_way, ahead):
    """Yield results from a pool, in any order; ``under_way`` holds the pieces whose result is not out, by their id."""
    futures = {}
    for piece in pieces:
        under_way[id(piece)] = piece
        futures[pool.submit(function, piece)] = piece
        if len(futures) >= ahead:
            yield from _finished(futures, under_way)
    while futures:
        yield from _finished(futures, under_way)


def _finished(futures, under_way):
    for future in wait(futures, return_when=FIRST_COMPLETED).done:
        result = future.result()
        del under_way[id(futures.pop(future))]
        yield result


def _ignore_interrupt():
    """Leave Ctrl-C to the process that started this one."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
