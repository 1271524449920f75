"""What was made is not made again: a program of a scene, its closed loop, its machine code.

Whoever makes one of them asks a table for it first, :class:`Shared`, under a key of everything that the result depends on.
:func:`content` makes that key of a scene and its options, :func:`instructions` of a program. A key errs on one side alone:
two equal scenes may get two keys, and cost time; two scenes that differ in a single bit never get the same.

>>> import hapticlab as hl
>>> walls = [hl.wall()(k=k, x_o=0.01) for k in (300.0, 300.0, 301.0)]
>>> first, again, other = (hl.compile(wall, T=1e-3) for wall in walls)
>>> first is again, first is other, instructions(first) == instructions(other)
(True, False, True)

The third program holds another value, so that it is a program of its own. Its instructions are the same, and so is its
machine code.
"""

import hashlib
import io
import os
import pickle
import threading
import weakref
from collections import OrderedDict
from types import BuiltinFunctionType, FunctionType

from sympy.core.function import UndefinedFunction
from sympy.core.parameters import global_parameters

from ...scene.notation.symbols import Parameter

#: modules whose classes and functions stay what they are while a process runs; a student's may be defined anew
LASTING = {"builtins", "collections", "copyreg", "hapticlab", "mpmath", "numpy", "sympy"}
#: of an undefined function, what SymPy derives from the rest
_DERIVED = {"_prop_handler", "_sage_", "default_assumptions"}
_TABLES: "weakref.WeakSet[Shared]" = weakref.WeakSet()


class Shared:
    """A table of what was made, bounded by weight: the entries used longest ago go first.

    Several threads that ask for one thing at once wait for the one that makes it. What could not be made is not kept.

    Parameters
    ----------
    most : float
        The entries weigh at most so much together; what weighs more alone is not kept.
    weight : callable, optional
        What an entry weighs; 1 by default.

    Examples
    --------
    >>> squares = Shared(most=2)
    >>> [squares.get(n, lambda n=n: n * n) for n in (2, 3, 4)], len(squares)
    ([4, 9, 16], 2)
    """

    def __init__(self, most, weight=lambda made: 1):
        self.most, self._weight = most, weight
        self._lock, self._entries = threading.Lock(), OrderedDict()
        _TABLES.add(self)

    def __len__(self):
        return len(self._entries)

    @property
    def weight(self):
        """What the entries weigh together."""
        with self._lock:
            return sum(entry.weight for entry in self._entries.values())

    def clear(self):
        """Forget everything."""
        with self._lock:
            self._entries.clear()

    def get(self, key, make):
        """The entry under a key, made now if there is none; without a key (None) it is made and not kept."""
        if key is None:
            return make()
        with self._lock:
            entry = self._entries.setdefault(key, _Entry())
            self._entries.move_to_end(key)
        with entry.making:
            if not entry.ready:
                try:
                    entry.made = make()
                except BaseException:
                    self._remove(key, entry)
                    raise
                entry.weight, entry.ready = self._weight(entry.made), True
                self._bound(key, entry)
            return entry.made

    def _remove(self, key, entry):
        with self._lock:
            if self._entries.get(key) is entry:
                del self._entries[key]

    def _bound(self, key, entry):
        if entry.weight > self.most:
            self._remove(key, entry)
        with self._lock:
            total = sum(one.weight for one in self._entries.values())
            while total > self.most:
                total -= self._entries.popitem(last=False)[1].weight

    def _after_fork(self):
        """Forget in a forked process what other threads were making: they are not in it."""
        self._lock = threading.Lock()
        self._entries = OrderedDict((key, entry) for key, entry in self._entries.items() if not entry.making.locked())


class _Entry:
    def __init__(self):
        self.making, self.made, self.ready, self.weight = threading.Lock(), None, False, 0


def clear():
    """Forget everything that this process has made; what is still in use stays as it is."""
    for table in list(_TABLES):
        table.clear()


def _after_fork():
    for table in list(_TABLES):
        table._after_fork()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_after_fork)


def content(*values):
    """Return a key of everything that values are made of, to the bit; None where something in them may change its meaning.

    That is a class or function of the student's own, which a cell may define anew under the same name, and what cannot be
    pickled.

    Examples
    --------
    >>> import sympy as sp
    >>> content(0.0) == content(-0.0), content(1) == content(1.0), content(sp.Integer(1)) == content(sp.Float(1))
    (False, False, False)
    """
    how = global_parameters.evaluate, global_parameters.distribute, global_parameters.exp_is_pow
    written = io.BytesIO()
    try:
        _Content(written, protocol=4).dump((how, values))
    except Exception:  # whatever an object of the student's own raises where it is written
        return None
    return hashlib.sha256(written.getbuffer()).digest()


class _Content(pickle.Pickler):
    def __init__(self, *arguments, **options):
        super().__init__(*arguments, **options)
        self._same = {}

    def persistent_id(self, obj):
        # Pickle names what it has written by identity; whether equal names and parameters are one object is up to
        # SymPy's cache, so they become one here.
        if type(obj) is str:
            return self._same.setdefault(obj, obj)
        if isinstance(obj, Parameter):
            return self._same.setdefault((type(obj), repr(obj.__getnewargs_ex__())), obj)
        return None

    def reducer_override(self, obj):
        if isinstance(obj, UndefinedFunction):  # a coordinate or a signal: a class made for it, with its start and range
            facts = {name: fact for name, fact in vars(obj).items() if name not in _DERIVED}
            return tuple, ((type(obj), obj.__bases__, facts),)
        defined = isinstance(obj, (type, FunctionType, BuiltinFunctionType))
        if defined and str(obj.__module__).partition(".")[0] not in LASTING:
            raise pickle.PicklingError(f"{obj!r} may be defined again")
        return NotImplemented


def instructions(program):
    """Return a key of what a program computes, whatever its channels are called and its parameters are set to."""
    channels = (program.inputs, program.parameters, program.states, program.outputs)
    types = [[c.type for c in some] for some in channels]
    return hashlib.sha256(repr((types, program.init, program.tick)).encode()).digest()
