"""What comes from students, as text of an HTML page: bounded, escaped, and with nothing in it that cannot be seen."""

import hashlib
import html
import math
import re
import unicodedata

#: of a name or a sentence, and of what was printed or written
SENTENCE, BLOCK = 700, 20_000
#: joins letters of some scripts; neither turns nor hides anything
JOINERS = "\u200c\u200d"
#: a name that every file system takes, and takes for no other: no capitals, no end that looks like a hash
SAFE_NAME = re.compile(r"(?!.*-[0-9a-f]{16}$)(?!(con|prn|aux|nul|com[0-9]|lpt[0-9])$)[a-z0-9][a-z0-9_-]{0,39}")


def clean(text, most=SENTENCE, *, lines=False):
    """Text for a page.

    Parameters
    ----------
    text : str
        Of anybody. Whatever else comes is shown as :func:`shown` does.
    most : int
        Characters kept; what is left out is counted.
    lines : bool
        Whether line ends and tabs stay.

    Examples
    --------
    >>> clean("<b>ada\u202e</b>")
    '&lt;b&gt;ada[U+202E]&lt;/b&gt;'
    >>> clean("12345678", 3)
    '123 ... (5 characters more)'
    """
    text = text if isinstance(text, str) else shown(text)
    if lines:
        text = text.replace("\r\n", "\n")
    more = len(text) - most
    text = text[:most]
    if not text.isprintable():
        text = "".join(_seen(letter, lines) for letter in text)
    text = re.sub("([\u0300-\u036f]{3})[\u0300-\u036f]+", r"\1", text)  # marks that pile up over other lines
    return html.escape(text) + (f" ... ({more} characters more)" if more > 0 else "")


def _seen(letter, lines):
    """A letter, or the number of one that is not seen: controls, turns of the writing direction, half pairs."""
    if letter.isprintable() or letter in JOINERS or (lines and letter in "\n\t"):
        return letter
    return " " if unicodedata.category(letter) == "Zs" or letter in "\n\t" else f"[U+{ord(letter):04X}]"


def shown(value, depth=0):
    """A plain value in a few characters.

    Examples
    --------
    >>> shown({"x": [0.1, 0.2, 0.3, 0.4, 0.5], "k": 200.0, "T": None})
    '{x: [0.1, 0.2, 0.3, ..., 0.5] (5 numbers), k: 200, T: none}'
    """
    if isinstance(value, str):
        return value[:SENTENCE]
    if isinstance(value, bool) or value is None:
        return "none" if value is None else str(value)
    if isinstance(value, int | float):
        return number(value)
    if isinstance(value, dict | list | tuple) and depth > 2:
        return "..."
    if isinstance(value, dict):
        parts = [f"{name!s:.60}: {shown(part, depth + 1)}" for name, part in [*value.items()][:8]]
        return "{" + ", ".join(parts + ["..."] * (len(value) > 8)) + "}"
    if isinstance(value, list | tuple):
        if len(value) <= 4:
            return f"[{', '.join(shown(part, depth + 1) for part in value)}]"
        few = [shown(part, depth + 1) for part in (*value[:3], value[-1])]
        return f"[{', '.join(few[:3])}, ..., {few[3]}] ({len(value)} numbers)"
    return f"a {type(value).__name__}"


def number(value, digits=6):
    """A number in so many digits; an integer may be larger than any float."""
    try:
        return f"{float(value) + 0.0:.{digits}g}"  # no sign on a zero
    except OverflowError:
        return "a number beyond 1e308"


def pair(got, expected):
    """Two values in as many digits as tell them apart.

    Examples
    --------
    >>> pair(0.3, 0.1 + 0.2), pair(1.0, 2.0)
    (('0.29999999999999999', '0.30000000000000004'), ('1', '2'))
    """
    texts = shown(got), shown(expected)
    numbers = all(isinstance(one, float) and math.isfinite(one) for one in (got, expected))
    if numbers and got != expected and texts[0] == texts[1]:
        digits = next((d for d in range(7, 17) if number(got, d) != number(expected, d)), 17)
        texts = number(got, digits), number(expected, digits)
    return texts


def file_name(student, copy=0):
    """The name of a student's page, without its ending: the same student has the same, two students never.

    Parameters
    ----------
    student : str
        Any text.
    copy : int
        Counts further submissions of the same student.

    Examples
    --------
    >>> file_name("ada"), file_name("Ada"), file_name("../etc")
    ('ada', 'ada-78bc296d54645f2f', 'etc-8888b7626e3e3220')
    """
    if not copy and SAFE_NAME.fullmatch(student):
        return student
    told = student.encode("utf-8", "surrogatepass") + b"\0%d" % copy
    plain = unicodedata.normalize("NFKD", student[:40]).encode("ascii", "ignore").decode()
    slug = re.sub(r"[^a-z0-9]+", "-", plain[:40].lower()).strip("-") or "student"
    return f"{slug}-{hashlib.sha256(told).hexdigest()[:16]}"
