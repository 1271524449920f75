"""What leads through the trials, above the covered picture: buttons, the number of the trial, what to do; opens anywidget."""

import struct
from functools import cache

from ..browser_view import BROWSER, Age, open_anywidget

#: what the page says: a presentation begins, it ends, an answer, and that the page is there
KINDS = ("show", "hide", "answer", "alive")


class Words:
    """Reads what a page says, three float64: which of KINDS, a value, and the page's clock [s].

    Parameters
    ----------
    clock : callable
        Seconds.

    Examples
    --------
    >>> Words(lambda: 7.0).read(struct.pack("<3d", 0, 1, 3.0))
    ('show', 1, 0.0)
    """

    def __init__(self, clock):
        self._age = Age(clock)

    def read(self, message):
        """Return the kind, the value, and how long ago the page said it [s]."""
        kind, value, said = struct.unpack("<3d", message)
        return KINDS[int(kind)], int(value), self._age.of(said)


def head(about, state):
    """Return the widget, told once what the comparison is about, and its state, which may change.

    Raises
    ------
    EngineMissingError
        Without anywidget.
    """
    return _class()(about=about, state=state)


@cache
def _class():
    anywidget, traitlets = open_anywidget()

    class BlindHead(anywidget.AnyWidget):
        """Buttons, the number of the trial, and what to do."""

        _esm = (BROWSER / "blind.js").read_text("utf-8")
        _css = (BROWSER / "blind.css").read_text("utf-8")
        about = traitlets.Dict().tag(sync=True)
        state = traitlets.Dict().tag(sync=True)

    return BlindHead
