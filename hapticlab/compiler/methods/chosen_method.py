"""What ``method=`` asks for, parsed once: "rk4", "taylor", "exact", "exact+rk4", or a Taylor of one's own."""

from __future__ import annotations

from dataclasses import dataclass

from ..events.taylor_method import Taylor
from ..ir.options import choice
from .method_table import METHODS, Method

#: what a method's name begins with, where its linear parts are taken exactly; the rest follows a plus sign
EXACT = "exact"


@dataclass(frozen=True)
class ChosenMethod:
    """A method as it was asked for. It prints as its text.

    Attributes
    ----------
    exact : bool
        What is linear is advanced by its matrix exponential.
    rest : Method or Taylor, optional
        What advances all else; None of "exact" alone.

    Examples
    --------
    >>> method = chosen_method("exact+rk4")
    >>> print(method, method.exact, method.rest.order, method.locates)
    exact+rk4 True 4 False
    """

    exact: bool
    rest: Method | Taylor | None

    def __str__(self) -> str:
        return "+".join([EXACT] * self.exact + ([self.rest.name] if self.rest else []))

    @property
    def locates(self) -> bool:
        """Whether the instants are located at which walls, contacts and friction change the motion."""
        return self.rest is None or isinstance(self.rest, Taylor)


def chosen_method(given: str | Taylor | ChosenMethod) -> ChosenMethod:
    """The method that a text or a :class:`Taylor` stands for.

    Raises
    ------
    ProgramError
        There is no such method.
    """
    if isinstance(given, ChosenMethod):
        return given
    if isinstance(given, Taylor):
        return ChosenMethod(False, given)
    first, plus, rest = given.partition("+") if isinstance(given, str) else (given, "", "")
    if first == EXACT:
        return ChosenMethod(True, METHODS[choice("method", rest, METHODS)] if plus else None)
    choice("method", given, (*METHODS, Taylor.name, EXACT, f"{EXACT}+rk4"))
    return ChosenMethod(False, Taylor() if given == Taylor.name else METHODS[given])
