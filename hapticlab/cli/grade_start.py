"""`hapticlab grade` begins here: what students' sessions need is loaded while this process loads what grades them."""

import sys
from contextlib import nullcontext
from importlib import import_module

from ..base.in_notebook import require_processes
from ..errors import CourseError
from ..grading.sessions.preloaded import Preloaded


def grade(parser, options):
    """Grade submissions; see :func:`hapticlab.cli.grade.grade`."""
    require_processes("Grading", CourseError)
    with Preloaded() if sys.platform == "linux" else nullcontext() as preloaded:
        return import_module("hapticlab.cli.grade").grade(parser, options, preloaded)
