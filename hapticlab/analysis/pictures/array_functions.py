"""Functions of NumPy that take a node of :mod:`~hapticlab.analysis.pictures.graph`, by what becomes of them there."""

import numpy as np

#: what is done number by number; ``widgets/browser/page/drawing.js`` does the same by the same names
ELEMENTWISE = frozenset(
    "add subtract multiply divide floor_divide remainder fmod power negative absolute sign copysign heaviside sqrt cbrt hypot "
    "sin cos tan arcsin arccos arctan arctan2 sinh cosh tanh arcsinh arccosh arctanh exp exp2 expm1 log log2 log10 log1p "
    "floor ceil trunc rint maximum minimum fmax fmin less less_equal greater greater_equal equal not_equal "
    "logical_and logical_or logical_xor logical_not isfinite isnan where".split()
)
#: the same for truths, which are numbers here
SAME = {"bitwise_and": "logical_and", "bitwise_or": "logical_or", "bitwise_xor": "logical_xor", "invert": "logical_not"}
#: what only moves numbers
MOVES = frozenset((
    np.reshape, np.ravel, np.transpose, np.moveaxis, np.swapaxes, np.expand_dims, np.squeeze, np.broadcast_to, np.stack,
    np.concatenate, np.column_stack, np.vstack, np.hstack, np.roll, np.flip, np.repeat, np.tile, np.take, np.delete,
))  # fmt: skip


def _over(name):
    return lambda graph, a, axis=None: graph.grouped("reduce", name, a, axis)


def _along(name):
    return lambda graph, a, axis=None: graph.grouped("accumulate", name, a, axis)


def _times(factor):
    return lambda graph, a: a * factor


def _matmul(graph, a, b):
    a, b = graph.node(a), graph.node(b)
    return np.sum(a * b, axis=-1) if b.ndim == 1 else np.sum(a[..., :, None] * b, axis=-2)


def _dot(graph, a, b):
    a, b = graph.node(a), graph.node(b)
    return _matmul(graph, a, b) if a.ndim and b.ndim else a * b


def _linspace(graph, start, stop, num=50):
    return start + (stop - start) / max(num - 1, 1) * np.arange(num)


def _round(graph, a, decimals=0):
    return np.rint(a * 10.0**decimals) / 10.0**decimals


def _mean(graph, a, axis=None):
    return np.sum(a, axis=axis) / (a.size if axis is None else a.shape[axis])


#: what others say, by name: functions of the graph and of what they are given
SPELT = {
    "where": lambda graph, condition, then, other: graph.elementwise("where", condition, then, other),
    "interp": lambda graph, x, xp, fp: graph.interp(x, xp, fp),
    "matmul": _matmul, "dot": _dot, "linspace": _linspace, "round": _round, "around": _round, "mean": _mean,
    "max": _over("maximum"), "amax": _over("maximum"), "min": _over("minimum"), "amin": _over("minimum"), "sum": _over("add"),
    "prod": _over("multiply"), "all": _over("logical_and"), "any": _over("logical_or"),
    "cumsum": _along("add"), "cumprod": _along("multiply"),
    "ptp": lambda graph, a, axis=None: np.max(a, axis=axis) - np.min(a, axis=axis),
    "diff": lambda graph, a: a[..., 1:] - a[..., :-1],
    "clip": lambda graph, a, low, high: np.minimum(np.maximum(a, low), high),
    "square": lambda graph, a: a * a, "reciprocal": lambda graph, a: 1 / a, "positive": lambda graph, a: a,
    "radians": _times(np.pi / 180), "deg2rad": _times(np.pi / 180),
    "degrees": _times(180 / np.pi), "rad2deg": _times(180 / np.pi),
    "shape": lambda graph, a: a.shape, "size": lambda graph, a: a.size, "ndim": lambda graph, a: a.ndim,
    "zeros_like": lambda graph, a: np.zeros(a.shape), "ones_like": lambda graph, a: np.ones(a.shape),
}  # fmt: skip
