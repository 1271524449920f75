"""A question of the concept inventory as data, and how a student's own numbers and order of options are drawn."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from ...errors import CourseError

if TYPE_CHECKING:
    from collections.abc import Iterable

LETTERS = "abcd"


@dataclass(frozen=True)
class Question:
    """One question with four options.

    Parameters
    ----------
    name : str
    about : str
        What it is about, in plain words without a formula, for an instructor's page.
    asks : str
        Markdown with formulas in LaTeX, and with places for numbers such as ``{K:g}``.
    right : str
        The right option, with places.
    wrong : dict of str to str
        Name of a misconception to the option that it leads to; three.
    draws : dict of str to sequence
        The values that a number is drawn from, in the units of the text. ``"p, r"`` draws pairs.
    computes : dict of str to callable
        Further numbers, each a function of the drawn ones by their names.
    picture : str
        Code of a cell below the text that shows a picture.

    Examples
    --------
    >>> wrong = {"a": "{K:g} N", "b": "0 N", "c": "1 N"}
    >>> one = Question("force", "a force", "?", "{F:g} N", wrong, {"K": (200, 300)}, {"F": lambda K: K / 100})
    >>> asked = one.asked("q01", "seed 3, ada")
    >>> asked.key, len(asked.options), sorted(option.misconception for option in asked.options)
    ('c', 4, ['', 'a', 'b', 'c'])
    """

    name: str
    about: str
    asks: str
    right: str
    wrong: Mapping[str, str]
    draws: Mapping[str, Sequence[Any]] = field(default_factory=dict)
    computes: Mapping[str, Callable[..., float]] = field(default_factory=dict)
    picture: str = ""

    def __post_init__(self) -> None:
        if len(self.wrong) != len(LETTERS) - 1:
            raise CourseError(f"{self.name}: {len(self.wrong)} wrong options; a question needs {len(LETTERS) - 1}")

    def numbers(self, key: str) -> dict[str, Any]:
        """Return the numbers of its text, drawn and computed; the same key gives the same."""
        drawn: dict[str, Any] = {}
        for names, values in self.draws.items():
            value = values[_digest(f"{key}, {self.name}, {names}") % len(values)]
            parts = [name.strip() for name in names.split(",")]
            drawn |= dict(zip(parts, value if len(parts) > 1 else [value], strict=True))
        return drawn | {name: function(**drawn) for name, function in self.computes.items()}

    def asked(self, identity: str, key: str) -> Asked:
        """Return the question as one student is asked it; the same key gives the same numbers and order."""
        numbers = self.numbers(key)
        texts = {"": self.right, **self.wrong}
        order = sorted(texts, key=lambda name: _digest(f"{key}, {self.name}, option {name}"))
        options = (AskedOption(letter, texts[name].format(**numbers), name) for letter, name in zip(LETTERS, order, strict=True))
        return Asked(identity, self, self.asks.format(**numbers), tuple(options), numbers)


@dataclass(frozen=True)
class Concept:
    """A concept with its questions."""

    name: str
    title: str
    questions: Sequence[Question]


@dataclass(frozen=True)
class AskedOption:
    """An option as a student sees it; ``misconception`` is empty for the right one."""

    letter: str
    text: str
    misconception: str


@dataclass(frozen=True)
class Asked:
    """A question as one student is asked it."""

    identity: str
    question: Question
    text: str
    options: Sequence[AskedOption]
    numbers: Mapping[str, Any]

    @property
    def key(self) -> str:
        """The letter of the right option."""
        return next(option.letter for option in self.options if not option.misconception)


def fingerprint(form: Iterable[Asked]) -> str:
    """Return twelve digits that tell one student's questions from those of others.

    They follow from what a student reads, so they give away neither the seed nor the right options.
    """
    shown = [[asked.identity, asked.text, *(option.text for option in asked.options)] for asked in form]
    return hashlib.sha256(repr(shown).encode()).hexdigest()[:12]


def _digest(text: str) -> int:
    """A number that follows from a text alone, in every version of Python."""
    return int.from_bytes(hashlib.sha256(text.encode("utf-8", "surrogatepass")).digest()[:8], "big")
