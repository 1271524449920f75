"""What ``method=`` asks for, parsed once: "rk4", "taylor", "exact", "exact+rk4", a Taylor of one's own, or None: automatic."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...base.shows_itself import ShowsItself
from ..events.taylor_method import Taylor
from ..ir.options import choice
from .method_table import METHODS, Method

if TYPE_CHECKING:
    from ...scene.explicit import ExplicitForm

#: what a method's name begins with, where its linear parts are taken exactly; the rest follows a plus sign
EXACT = "exact"


@dataclass(frozen=True)
class Exact(ShowsItself):
    """Advance the linear part by its matrix exponential; ``rest`` names the method for the nonlinear part.

    Its error is rounding, at any stiffness, so that it has no order. A step costs a product with a constant matrix, and
    the parameters in it become constants. Where motion is linear between switches it makes a map a mode and locates the
    switches. Not to be confused with "taylor", which takes nonlinear motion too. Source: Van Loan, IEEE Trans.
    Automatic Control 23 (1978).

    Parameters
    ----------
    rest : str or Method, optional
        Such as "rk4"; without it, everything has to be linear.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.methods.Exact(rest="rk4")
    Exact(rest='rk4')
    """

    rest: str | Method | None = None


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


#: what ``method=`` takes
AnyMethod = str | Method | Taylor | Exact | type[Taylor] | type[Exact] | ChosenMethod


def chosen_method(given: AnyMethod | None, form: ExplicitForm | None = None) -> ChosenMethod:
    """The method that a text or a record stands for; of None the one that the equations of motion need.

    Raises
    ------
    ProgramError
        There is no such method.
    """
    if isinstance(given, ChosenMethod):
        return given
    if given is None:
        return ChosenMethod(False, Taylor() if form is not None and to_locate(form) else METHODS["rk4"])
    if given is Taylor or given is Exact:  # the class, as other methods are given
        given = given()
    if isinstance(given, (Method, Taylor)):
        return ChosenMethod(False, given)
    if isinstance(given, Exact):
        rest = getattr(given.rest, "name", given.rest)
        given = EXACT if rest is None else f"{EXACT}+{rest}"
    first, plus, rest = given.partition("+") if isinstance(given, str) else (given, "", "")
    if first == EXACT:
        return ChosenMethod(True, METHODS[choice("method", rest, METHODS)] if plus else None)
    choice("method", given, (*METHODS, Taylor.name, EXACT, f"{EXACT}+rk4"))
    return ChosenMethod(False, Taylor() if given == Taylor.name else METHODS[str(given)])


def to_locate(form: ExplicitForm) -> list[str]:
    """The names of the contacts and frictions whose touch, impact, sticking or sliding must be located inside a step."""
    return [element.name for model in form.models for element in model.contacts if element.is_located]


def why_automatic(form: ExplicitForm) -> str:
    """The sentence on the method that was taken because none was asked for."""
    if names := to_locate(form):
        return f"method = 'taylor', chosen automatically: {', '.join(names)} must be located inside the step"
    return "method = 'rk4', chosen automatically: no contact or friction of this motion must be located inside the step"
