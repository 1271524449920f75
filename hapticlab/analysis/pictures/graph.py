"""Arithmetic on arrays that is written down instead of done, so that a page without Python can do it.

A :class:`Node` stands for an array whose shape is known and whose numbers are not. Functions of NumPy take it and return another;
the :class:`Graph` keeps a row for each. The numbers of an array lie in one line, the last index runs first.
"""

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

from .array_functions import ELEMENTWISE, MOVES, SAME, SPELT


class NotRecorded(BaseException):
    """What was asked of a node needs its number; no user's ``except Exception`` catches it."""


class Undecided(BaseException):
    """Somebody asks whether a node is true; no user's ``except Exception`` catches it."""


class Graph:
    """Rows of arithmetic, each written once.

    Attributes
    ----------
    rows : list of tuple
        ("input", name); ("constant", bytes); (function, *rows), elementwise, where a single number goes with all; ("reduce" or
        "accumulate", function, how many numbers each, row); ("interp", x, xp, fp); ("gather", *(row, place)).
    sizes : list of int
    outcomes : dict of int to bool
        What is answered where somebody asks whether a row is true.

    Examples
    --------
    >>> graph = Graph()
    >>> turn = graph.input("turn")
    >>> rim = np.stack([np.cos(turn), np.sin(turn)])
    >>> rim.shape, graph.rows
    ((2,), [('input', 'turn'), ('cos', 0), ('sin', 0), ('gather', (1, 0), (2, 0))])
    """

    def __init__(self):
        self.rows, self.sizes, self.outcomes, self._numbers = [], [], {}, {}

    def row(self, size, *row):
        """Return the number of a row, which is written unless it is there."""
        if row not in self._numbers:
            self._numbers[row] = len(self.rows)
            self.rows.append(row)
            self.sizes.append(size)
        return self._numbers[row]

    def input(self, name):
        """Return the node of a number that is given."""
        return Node(self, self.row(1, "input", name), ())

    def node(self, value):
        """Return the node of a number, an array, or a list of numbers and nodes."""
        if isinstance(value, Node):
            return value
        array = np.asarray(value)
        if array.dtype == object:
            parts = [self.node(one).number for one in array.ravel().tolist()]
            return self.gather(parts, np.arange(len(parts)).reshape(array.shape))
        return Node(self, self.row(array.size, "constant", array.astype(float).tobytes()), array.shape)

    def constant(self, number):
        """Return the numbers of a row that are known, or None."""
        kind, *rest = self.rows[number]
        return np.frombuffer(rest[0]) if kind == "constant" else None

    def elementwise(self, name, *values):
        """Return the node of a function that is applied number by number."""
        nodes = [self.node(value) for value in values]
        shape = np.broadcast_shapes(*(node.shape for node in nodes))
        size, operands = int(np.prod(shape)), [one if one.size == 1 else self.moved(np.broadcast_to, one, shape) for one in nodes]
        known = [self.constant(node.number) for node in operands]
        if all(one is not None for one in known):
            with np.errstate(all="ignore"):
                return self.node(np.broadcast_to(getattr(np, name)(*known), size).reshape(shape))
        return Node(self, self.row(size, name, *(node.number for node in operands)), shape)

    def grouped(self, kind, name, value, axis):
        """Return the node of a function of two that reduces or accumulates along an axis."""
        node = value.reshape(-1) if axis is None else self.moved(np.moveaxis, value, axis, -1)
        count, size = node.shape[-1], node.size
        if kind == "reduce":
            return Node(self, self.row(size // count, kind, name, count, node.number), node.shape[:-1])
        done = Node(self, self.row(size, kind, name, count, node.number), node.shape)
        return done if axis is None else self.moved(np.moveaxis, done, -1, axis)

    def interp(self, x, xp, fp):
        """Return the node of a curve through points, at some places."""
        x, xp, fp = map(self.node, (x, xp, fp))
        return Node(self, self.row(x.size, "interp", x.number, xp.number, fp.number), x.shape)

    def moved(self, function, value, *how, **named):
        """Return the node of what a function does that only moves numbers, of a node or of a list of arrays and nodes."""
        nodes = [value] if isinstance(value, Node) else [self.node(one) for one in value]
        ends = np.cumsum([0, *(node.size for node in nodes)])
        places = [np.arange(node.size).reshape(node.shape) + end for node, end in zip(nodes, ends, strict=False)]
        index = function(places[0] if isinstance(value, Node) else places, *how, **named)
        return self.gather([node.number for node in nodes], np.asarray(index))

    def gather(self, numbers, index):
        """Return the node of numbers picked out of rows that stand one after the other."""
        pool = [pick for number in numbers for pick in self._picks(number)]
        picks = tuple(pool[at] for at in index.ravel().tolist())
        first = picks[0][0]
        if len(picks) == self.sizes[first] and picks == tuple((first, at) for at in range(len(picks))):
            return Node(self, first, index.shape)
        known = [self.constant(number) for number, _ in picks]
        if all(one is not None for one in known):
            return self.node(np.reshape([one[at] for one, (_, at) in zip(known, picks, strict=True)], index.shape))
        return Node(self, self.row(len(picks), "gather", *picks), index.shape)

    def _picks(self, number):
        """Where the numbers of a row come from: pairs (row, place in it)."""
        kind, *picks = self.rows[number]
        if kind == "gather":
            return picks
        if kind == "constant" and self.sizes[number] > 1:
            return [(self.node(one).number, 0) for one in self.constant(number).tolist()]
        return [(number, at) for at in range(self.sizes[number])]


class Node(NDArrayOperatorsMixin):
    """An array whose numbers come later: operators and functions of NumPy take it.

    Attributes
    ----------
    graph : Graph
    number : int
        Of its row there.
    shape : tuple of int
    """

    def __init__(self, graph, number, shape):
        self.graph, self.number, self.shape = graph, number, tuple(map(int, shape))

    size = property(lambda self: int(np.prod(self.shape)))
    ndim = property(lambda self: len(self.shape))
    T = property(lambda self: self.graph.moved(np.transpose, self))

    def __array_ufunc__(self, ufunc, method, *inputs, out=None, axis=0, **options):
        name = SAME.get(ufunc.__name__, ufunc.__name__)
        if method == "__call__" and name in SPELT and not options:
            return SPELT[name](self.graph, *inputs)
        if out and (self.shape or out[0] is not self):  # a view of the array, or who else has it, would not see the change
            raise NotRecorded("+= or another change in place, or out=, on an array")
        if name not in ELEMENTWISE or options or method not in ("__call__", "reduce", "accumulate"):
            raise NotRecorded(f"np.{ufunc.__name__}" + (f".{method}" if method != "__call__" else ""))
        if method != "__call__":
            return self.graph.grouped(method, name, self, axis)
        return self.graph.elementwise(name, *inputs)

    def __array_function__(self, function, _, args, options):
        if function in MOVES:
            return self.graph.moved(function, *args, **options)
        if function.__name__ not in SPELT:
            raise NotRecorded(f"np.{function.__name__}")
        return SPELT[function.__name__](self.graph, *args, **options)

    def __getitem__(self, key):
        return self.graph.moved(lambda places: places[key], self)

    def __len__(self):
        if not self.shape:
            raise TypeError("a single number has no length")
        return self.shape[0]

    def __iter__(self):
        return (self[k] for k in range(len(self)))

    def tolist(self):
        """Return its numbers, as nodes, in lists."""
        return [one.tolist() for one in self] if self.shape else self

    def reshape(self, *shape):
        """Return it in another shape."""
        return self.graph.moved(lambda places: places.reshape(*shape), self)

    def astype(self, kind):
        """Return its numbers as another kind has them, each a float still: whole ones, or 1 and 0 for truths."""
        kind = np.dtype(kind).kind
        if kind not in "fiub":
            raise NotRecorded("astype() of what is not a number")
        return {"f": self, "b": self != 0}.get(kind, np.trunc(self))

    def __bool__(self):
        known = self.graph.constant(self.number)
        if self.size != 1:
            raise NotRecorded("if or a comparison of a whole array")
        if known is not None:
            return bool(known[0])
        if self.number not in self.graph.outcomes:
            raise Undecided(self.number)
        return self.graph.outcomes[self.number]

    def _needs_its_number(self, *_):
        raise NotRecorded("float(), int(), a function of math, a label's text, or a set or dict")

    __float__ = __int__ = __index__ = __complex__ = __round__ = __str__ = __repr__ = __format__ = __hash__ = _needs_its_number
