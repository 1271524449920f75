"""``hl.<tab>`` in IPython and Jupyter lists the public names at once.

By itself IPython asks each name what it is, and so opens the first pages and all of SymPy before it shows anything. The names
are known without that. IPython has a list for matchers such as this one; nothing of IPython is imported here.
"""

import re
import sys
from typing import NamedTuple

from ..vocabulary import PAGES

#: one name, a dot, and what was typed of the next
ASKED = re.compile(r"(?<![\w.])(\w+)\.(\w*)$")


class Completion(NamedTuple):
    """A name, and the word beside it in the list of completions."""

    text: str
    type: str


def complete_in(shell):
    """Add the matcher to a shell of IPython; one that has no such list stays as it is."""
    house = sys.modules["hapticlab"]

    def public_names(context):
        asked = ASKED.search(context.text_until_cursor)
        if asked is None or shell.user_ns.get(asked[1]) is not house or asked[2].startswith("_"):
            return {"completions": []}
        names = [name for name in house.__all__ if name.startswith(asked[2])]
        return {"completions": [Completion(name, _kind(name)) for name in names], "matched_fragment": asked[2], "suppress": True}

    public_names.matcher_api_version = 2  # of matchers that take a context
    public_names.matcher_identifier = "hapticlab"
    getattr(getattr(shell, "Completer", None), "custom_matchers", []).append(public_names)


def _kind(name):
    if name in PAGES:
        return "module"
    return "instance" if len(name) == 1 else "class" if name[0].isupper() else "function"
