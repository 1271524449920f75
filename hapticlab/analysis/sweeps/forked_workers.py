"""Work shared out to copies of this process, which have at once what it knows: scenes, references, what was imported."""

import functools
import multiprocessing
import sys
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager

from .workers import number_of

#: of a copy: what every piece of its work needs
_common = None


def _begin(common):
    global _common
    _common = common


def _work(job):
    function, argument = job
    return function(_common, argument)


@contextmanager
def shared_out(common, workers=None):
    """Give ``share(function, arguments)``, which yields function(common, argument) of all arguments in their order.

    Parameters
    ----------
    common : object
        What every call needs.
    workers : int or callable, optional
        What maps, as ``map``; or copies that work at once, 2 unless given; 1 is this process itself. Only Linux copies a
        process safely, so that elsewhere it is always 1: a new process would need seconds to begin, for seconds of work.
    """
    workers = number_of(2 if workers is None else workers)
    if callable(workers):
        yield lambda function, arguments: workers(functools.partial(function, common), arguments)
        return
    if workers == 1 or sys.platform != "linux":
        yield lambda function, arguments: (function(common, argument) for argument in arguments)
        return
    with ProcessPoolExecutor(workers, multiprocessing.get_context("fork"), _begin, (common,)) as pool:
        yield lambda function, arguments: pool.map(_work, [(function, argument) for argument in arguments])
