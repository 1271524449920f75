"""Read loop equations as polynomials in unknown lengths and in cosines and sines of unknown angles."""

import math

import numpy as np
import sympy as sp


class NotClosed(Exception):
    """These equations are not among the forms that are solved here."""


_EVALUATE = {
    sp.Add: lambda *a: sum(a), sp.Mul: lambda *a: math.prod(a), sp.Pow: lambda a, b: np.power(a + 0.0, b),
    sp.sin: np.sin, sp.cos: np.cos, sp.tan: np.tan, sp.atan: np.arctan, sp.atan2: np.arctan2, sp.asin: np.arcsin,
    sp.acos: np.arccos, sp.exp: np.exp, sp.log: np.log, sp.Abs: np.abs, sp.tanh: np.tanh,
}  # fmt: skip


def number(expr, at):
    """An expression as a float or an array, at the values ``at`` of its symbols and functions of time."""
    if expr in at:
        return at[expr]
    if expr.is_number:
        return float(expr)
    if expr.func not in _EVALUATE:
        raise NotClosed(f"{expr} has no closed form")
    return _EVALUATE[expr.func](*(number(a, at) for a in expr.args))


class Terms:
    """Reads equations as polynomials in unknown lengths and in cosines and sines of unknown angles.

    Parameters
    ----------
    start : dict
        Every symbol and function of time -> its initial value [SI], the unknown's too: it chooses the assembly.
    generic : dict
        The same for a state that is nothing in particular: what vanishes there vanishes everywhere.
    """

    def __init__(self, start, generic):
        self.start, self.generic = start, generic

    def zero(self, expr):
        """Whether an expression vanishes identically."""
        parts = [abs(number(part, self.generic)) for part in sp.Add.make_args(sp.sympify(expr))]
        return abs(number(expr, self.generic)) <= 1e-11 * max(parts)

    def terms(self, expr, unknown, angles=None):
        """{Monomial: coefficient}; a monomial is a tuple of unknown lengths, cosines and sines.

        ``angles`` collects the unknown angles, so that several equations are written in the same ones.
        """
        found = self._terms(expr, unknown, {} if angles is None else angles)
        for atom in {a for monomial in found for a in monomial if isinstance(a, sp.cos)}:
            # of cos^2 + sin^2 nothing is left but its coefficient
            twin, square = sp.sin(atom.args[0]), found.get((atom, atom))
            if square is not None and (twin, twin) in found and self.zero(square - found[twin, twin]):
                del found[atom, atom], found[twin, twin]
                found[()] = found.get((), sp.S.Zero) + square
        return {monomial: c for monomial, c in found.items() if not self.zero(c)}

    def _terms(self, expr, unknown, angles):
        if not expr.has(*unknown):
            return {(): expr}
        if expr in unknown:
            return {(expr,): sp.S.One}
        if isinstance(expr, sp.Add):
            total = {}
            for part in expr.args:
                for monomial, c in self._terms(part, unknown, angles).items():
                    total[monomial] = total.get(monomial, sp.S.Zero) + c
            return total
        if isinstance(expr, sp.Mul):
            return self._times(expr.args, unknown, angles)
        if isinstance(expr, sp.Pow) and expr.exp == 2:
            return self._times((expr.base, expr.base), unknown, angles)
        if isinstance(expr, (sp.cos, sp.sin)):
            return _of_angle(expr, unknown, angles)
        raise NotClosed(f"{expr} is neither a length nor the cosine or sine of an angle")

    def _times(self, factors, unknown, angles):
        total = {(): sp.S.One}
        for factor in factors:
            other = self._terms(factor, unknown, angles)
            product = {}
            for a, c in total.items():
                for b, d in other.items():
                    key = tuple(sorted((*a, *b), key=sp.default_sort_key))
                    product[key] = product.get(key, sp.S.Zero) + c * d
            total = product
        if any(len(monomial) > 2 for monomial in total):
            raise NotClosed("the equation is of third degree")
        return total


def _of_angle(expr, unknown, angles):
    """The terms of cos or sin of an unknown angle, in the first angle met that differs from it by known ones."""
    parts = sp.Add.make_args(sp.expand(expr.args[0]))
    own = sp.Add(*(part for part in parts if part.has(*unknown)))
    if any(not (part / u).is_number for part in sp.Add.make_args(own) for u in unknown if part.has(u)):
        raise NotClosed(f"{expr} does not contain an angle")
    sign = -1 if own.could_extract_minus_sign() else 1
    angle = angles.setdefault(sign * own, sp.expand(sign * expr.args[0]))
    known = sp.expand(expr.args[0] - sign * angle)
    cos, sin = sp.cos(angle), sp.sin(angle)
    if isinstance(expr, sp.cos):
        both = {(cos,): sp.cos(known), (sin,): -sign * sp.sin(known)}
    else:
        both = {(cos,): sp.sin(known), (sin,): sign * sp.cos(known)}
    return {m: c for m, c in both.items() if c != 0}
