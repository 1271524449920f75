"""Lines of a source as text, without reading it as Python: what continues a line, what is a magic, where statements end."""

import re

PARTS = re.compile(
    r'#[^\n]*|"""(?:[^\\]|\\.)*?(?:"""|\Z)|\'\'\'(?:[^\\]|\\.)*?(?:\'\'\'|\Z)'
    r'|"(?:[^"\\\n]|\\.)*"?|\'(?:[^\'\\\n]|\\.)*\'?|\\\n|[()\[\]{}]|\n',
    re.DOTALL,
)
#: no statement of Python begins like these
MAGIC = re.compile(r"[ \t]*(?:[%!?]|(?:pip|conda)[ \t]+[a-z])(?:\\\n|[^\n])*\n?|[ \t]*[\w.*\[\]'\"]+\?\??[ \t]*(?:\n|\Z)")
ASSIGNED_MAGIC = re.compile(r"[\w., \t]+=[ \t]*[%!](?:\\\n|[^\n])*\n?")
#: never the continuation of a bracket: whoever left one open above loses no more than that statement
NEW = re.compile(r"(?:async[ \t]+def|def|class|import|while|with|try|return)\b|@\w+[^\n]*\n(?:async|def|class|@)")
CONTINUES = re.compile(r"[ \t]+\S|(?:else|elif|except|finally)\b")
OPENING, CLOSING = ("(", "[", "{"), (")", "]", "}")
EMPTY = re.compile(r"[ \t\f]*(?:#[^\n]*)?(?:\n|\Z)")


def logical_lines(source):
    r"""Yield the lines of a source, each with those that continue it: in a bracket, a string, after a backslash.

    Examples
    --------
    >>> list(logical_lines("k = (1,\n 2)\n!echo it's\nd = '''a\nb'''\n"))
    ['k = (1,\n 2)\n', "!echo it's\n", "d = '''a\nb'''\n"]
    """
    start = 0
    while start < len(source):
        end = _end(source, start)
        yield source[start:end]
        start = end


def _end(source, start):
    """Return where the logical line ends that begins here."""
    magic = MAGIC.match(source, start) or ASSIGNED_MAGIC.match(source, start)
    if magic:
        return magic.end()
    depth = 0
    for part in PARTS.finditer(source, start):
        text = part.group()
        depth = max(0, depth + (text in OPENING) - (text in CLOSING))
        if text == "\n" and (depth == 0 or NEW.match(source, part.end())):
            return part.end()
    return len(source)


def statements(source):
    r"""Return the statements of a script at its top level, as texts that make up the source again.

    Blank lines and comments go with the statement after them.

    Examples
    --------
    >>> statements("import math\n\n@twice\ndef f(x):\n    return x\nif 1:\n    k = 2\nelse:\n    k = 3\n")
    ['import math\n', '\n@twice\ndef f(x):\n    return x\n', 'if 1:\n    k = 2\nelse:\n    k = 3\n']
    """
    found, waiting, decorated = [], [], False
    for line in logical_lines(source):
        waiting.append(line)
        if EMPTY.fullmatch(line):
            continue
        if found and (decorated or CONTINUES.match(line)):
            found[-1] += waiting
        else:
            found.append(waiting)
        waiting, decorated = [], line.startswith("@")
    if found:
        found[-1] += waiting
    return ["".join(lines) for lines in found]
