"""Run the pages of docs/papers: the code of each, what it prints, and its figure.

    python tests/benchmarks/papers.py [NAME ...]            run pages, and say which differ from what they show
    python tests/benchmarks/papers.py --write [NAME ...]    and put outputs and figures in the pages

A page holds blocks of Python that run one after the other. A ``text`` block after one of them shows what it prints. One block
makes ``figure``; it runs only where the figure is drawn. A line such as ``cases = 20  # .ci/full: 2000`` gives a number of cases
for a quick run and one for a long run, and both must print the same.
"""

import argparse
import contextlib
import io
import re
import warnings
from pathlib import Path

from cycler import cycler
from matplotlib import rc_context

from hapticlab.base.drawing import HOUSE, STYLES

FOLDER = Path(__file__).parents[2] / "docs" / "papers"
PAGES = {path.stem: path for path in sorted(FOLDER.glob("*.md")) if path.name != "README.md"}
BLOCK = re.compile(r"^```python\n(.*?)^```\n(?:\n```text\n.*?^```\n)?", re.M | re.S)
DRAWS = re.compile(r"^figure = ", re.M)
#: lines that differ in grey print too
LINES = cycler(**{key: [style[key] for style in STYLES] for key in ("color", "linestyle")})
LONG = re.compile(r"^cases = \d+  # \.ci/full: (\d+)$", re.M)


def run(path, *, figure=None, whole=False):
    """Return the text of a page with what its code prints now, and write its figure where ``figure`` names a file."""
    text, names = path.read_text("utf-8"), {}

    def shown(block):
        code = block[1]
        if DRAWS.search(code) and not figure:
            return block[0]
        with contextlib.redirect_stdout(io.StringIO()) as printed, warnings.catch_warnings():
            warnings.simplefilter("error")
            exec(compile(LONG.sub(r"cases = \1", code) if whole else code, path.name, "exec"), names)
        output = printed.getvalue()
        return f"```python\n{code}```\n" + (f"\n```text\n{output}```\n" if output else "")

    with rc_context(HOUSE | {"axes.prop_cycle": LINES}):
        found = BLOCK.sub(shown, text)
        if figure:
            names["figure"].savefig(figure, dpi=80)
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", choices=[[], *PAGES], help="pages; by default all")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--whole", action="store_true", help="as many cases as .ci/full")
    given = parser.parse_args()
    for name in given.names or PAGES:
        path = PAGES[name]
        found = run(path, figure=path.with_suffix(".png") if given.write else None, whole=given.whole)
        print(f"{name}: {'as shown' if found == path.read_text('utf-8') else 'differs'}")
        if given.write:
            path.write_text(found, "utf-8")


if __name__ == "__main__":
    main()
