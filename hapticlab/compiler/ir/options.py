"""What a scene is compiled with: each option checked, and told apart in words."""

import math
import operator
from numbers import Real

from ...base.units import in_si
from ...errors import ParameterError, ProgramError, ProgramLimitError
from ...scene.notation.symbols import Parameter

#: of a period, that an error may propose: more of any method are more instructions than a program may have
MOST_SUBSTEPS = 1000
#: each is an instruction at least
_MOST_STEPS = 50_000
#: sampling periods [s] that haptic loops have; any other is said to be unusual
USUAL = (1e-5, 0.1)
#: instructions a tick, past which a program says that it is large
LARGE = 50_000


def proposed(substeps, instead):
    """Return "substeps=..." where a program can have as many, else what to do ``instead``."""
    return f"substeps={math.ceil(substeps)}" if substeps <= MOST_SUBSTEPS else instead


def choice(name, given, known):
    """Return the option, one of the names known."""
    if not (isinstance(given, str) and given in known):
        raise ProgramError(f"{name} = {given!r}; needs one of {', '.join(known)}")
    return given


def period(T):
    """Return the sampling period as a float [s], from a real number > 0 of any library or a text with a unit.

    Examples
    --------
    >>> from hapticlab.compiler.ir.options import period
    >>> period("0.5 ms")
    0.0005
    """
    if isinstance(T, str):
        return period(in_si(T, "s", "T"))
    if isinstance(T, bool) or not isinstance(T, Real):
        raise ParameterError(f"T = {T!r}; a sampling period is a number in s or a text with its unit, T=1e-3 or T='1 ms'")
    try:
        seconds = float(T)
    except OverflowError:  # a whole number past 1e308
        seconds = math.inf
    if not (math.isfinite(seconds) and seconds > 0):
        raise ParameterError(f"T = {T if seconds < math.inf else seconds} s; a sampling period needs T > 0, such as T=1e-3")
    return seconds


def steps(substeps):
    """Return the steps a period as an int >= 1, from a whole number of any library."""
    try:
        count = 0 if isinstance(substeps, bool) else operator.index(substeps)
    except TypeError:
        count = 0
    if count < 1:
        raise ProgramError(f"substeps = {substeps!r}; needs a whole number >= 1")
    if count > _MOST_STEPS:
        raise ProgramLimitError(f"substeps = {count}; a period has at most {_MOST_STEPS}. Use fewer substeps")
    return count


def unusual(T, size):
    """Return notes on a sampling period [s] that no haptic loop has, and on a program of very many instructions."""
    notes = []
    if not USUAL[0] <= T <= USUAL[1]:
        why = "no board computes a force that often" if T < USUAL[0] else "a hand feels each sample as a step"
        notes.append(f"T = {T:g} s: {why}; a haptic loop has a period of 10 us to 100 ms, usually T=1e-3 [s]")
    if size > LARGE:
        notes.append(
            f"{size} instructions per tick are slow to compile and far too many for any board. Use fewer surfaces, "
            "a shorter T or rk4"
        )
    return notes


def live_names(live):
    """Return the names of the live parameters, or None for all.

    Examples
    --------
    >>> from hapticlab.compiler.ir.options import live_names
    >>> live_names("k b")
    ('k', 'b')
    """
    if live is None:
        return None
    if isinstance(live, str):
        return tuple(live.replace(",", " ").split())
    listed = (live,) if isinstance(live, Parameter) or not hasattr(live, "__iter__") else live
    names = tuple(p.name if isinstance(p, Parameter) else p for p in listed)
    if not all(isinstance(name, str) for name in names):
        raise ParameterError(f"live = {live!r}; needs names of parameters, such as live='k b', or None for all")
    return names
