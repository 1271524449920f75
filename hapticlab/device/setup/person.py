"""Whoever holds the handle: everything asked of a person passes through one small object, so that a test can be it."""

import math

from ...errors import PaddleError

#: options that are told by their first letters; more have numbers
FEW = 3


class Person:
    """The person at this terminal. Others have the same methods.

    Examples
    --------
    >>> from hapticlab.device.setup.person import Person, number
    >>> class Quick(Person):
    ...     def ask(self, question):
    ...         return "100"
    >>> number(Quick(), "How far do the stops lie apart [mm]?", low=5, high=1000)
    100.0
    """

    def say(self, text):
        """Tell something."""
        print(text)

    def ask(self, question):
        """Ask for a line of text, or to press Enter when something is done; return what was typed."""
        try:
            return input(f"{question} ").strip()
        except EOFError:
            raise PaddleError("there is no keyboard input here; run this in a terminal, with a person at the paddle") from None

    def choose(self, question, options):
        """Return the key of one of the options, a dict {key: meaning}; a long list has numbers, else the first letter tells."""
        numbers = {str(k): key for k, key in enumerate(options, 1)} if len(options) > FEW else {}
        marks = [f"{k:>2} " for k in numbers] or [""] * len(options)
        lines = [f"  {mark}{key:<14} {options[key]}".rstrip() for mark, key in zip(marks, options, strict=True)]
        self.say("\n".join([question, *lines]))
        while True:
            typed = self.ask(f"[1 to {len(options)}]?" if numbers else f"[{'/'.join(options)}]?").lower()
            typed = numbers.get(typed, typed)
            meant = [key for key in options if typed == key or (not numbers and typed == key[0])]
            if len(meant) == 1:
                return meant[0]
            self.say(f"{typed!r} is not one of {', '.join(options)}")

    def picture(self, build):
        """Return where the drawing of a wiring is, in words, or None: on a terminal alone there is none."""
        return None if build.name == "own" else f"hl.devices.drawing('wiring {build.name}') shows it in a notebook"


def agrees(person, question):
    """Return whether the person says yes."""
    return person.choose(question, {"yes": "do it", "no": "leave everything as it is"}) == "yes"


def number(person, question, *, low, high):
    """Ask until the answer is a number in low ... high, and return it."""
    while True:
        typed = person.ask(question)
        try:
            value = float(typed.replace(",", "."))
        except ValueError:
            person.say(f"{typed!r} is not a number")
            continue
        if math.isfinite(value) and low <= value <= high:
            return value
        person.say(f"{value:g}: needs a number from {low:g} to {high:g}")
