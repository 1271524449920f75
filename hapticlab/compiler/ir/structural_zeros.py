"""Arithmetic that leaves structural zeros out: constants 0, known before anything runs, of which nothing is recorded.

It works on floats, arrays over lanes and traced values. Where a student's mass matrix or a Jacobian is sparse, the
factors, the products and the series of it cost what is there, and no more.
"""

import numpy as np

from .values import Value

#: a structural zero, which divides without an exception, as every engine does
ZERO = np.float64(0.0)


def is_zero(a):
    """True of the constant zero; an array is never one."""
    a = a.constant if isinstance(a, Value) else a
    return not isinstance(a, np.ndarray) and a == 0


def plus(a, b):
    """Return a + b, free where one of them is a structural zero."""
    return b if is_zero(a) else a if is_zero(b) else a + b


def minus(a, b):
    """Return a - b, free where b is a structural zero."""
    return a if is_zero(b) else -b if is_zero(a) else a - b


def times(a, b):
    """Return a * b, ZERO where one of them is a structural zero."""
    return ZERO if is_zero(a) or is_zero(b) else a * b


def scaled(k, a):
    """Return k * a for a number k, a structural zero left as it is."""
    return a if is_zero(a) else -a if k == -1.0 else k * a


def less_product(a, b, c):
    """Return a - b * c, a itself where the product is a structural zero."""
    if is_zero(b) or is_zero(c):
        return a
    return -(b * c) if is_zero(a) else a - b * c


def dot(a, b):
    """Return the sum of products of two equally long lists, ZERO where all of them are structural zeros.

    Examples
    --------
    >>> from hapticlab.compiler.ir.trace import Builder
    >>> from hapticlab.compiler.ir.structural_zeros import dot
    >>> b = Builder()
    >>> x, y = b.leaf("input", 0, "f64"), b.leaf("input", 1, "f64")
    >>> [i.op for i in b.block([dot([x, 0.0, 2.0], [y, x, 0.0])]).instructions]
    ['input', 'input', 'mul']
    """
    total = ZERO
    for one, other in zip(a, b, strict=True):
        total = plus(total, times(one, other))
    return total
