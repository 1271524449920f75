"""How long a lab takes to read, from what stands in it; writes the column "reading" of labs/README.md.

    python tests/labs/reading_time.py            # print a table of all labs
    python tests/labs/reading_time.py --write    # and write the minutes into labs/README.md

Reading is the words of the text at 200 a minute, a formula as one word, and the lines of given code at 12 a minute. The
tasks are the exercises, the prediction and the discussion, and a live view each; they have what is left of the stated time.
"""

import re
import sys
from pathlib import Path

from hapticlab.course.labs import find_labs
from hapticlab.course.notebook import code_of, read

LABS = Path(__file__).parents[2] / "labs"
WORDS, LINES = 200, 12  # a minute
FORMULA = re.compile(r"\$\$.*?\$\$|\$[^$]+\$", re.S)
OPEN = re.compile(r"raise NotImplementedError|^\w+ = None|\"\"\"\n\"\"\"|^hl\.check\(.*\)$", re.M)


def text_of(notebook):
    """Return the text of all cells that are no code."""
    return "\n\n".join("".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "markdown")


def words(text):
    """Return the number of words; a formula is one."""
    return len(re.findall(r"\S*\w\S*", FORMULA.sub(" formula ", text)))


def given_lines(notebook):
    """Return the number of lines of code that are there to be read: not those of an open answer, nor of a check alone."""
    return sum(bool(line.strip()) for code in code_of(notebook) if not OPEN.search(code) for line in code.splitlines())


def reading_time(folder):
    """Return words, given lines, tasks and the minutes of reading of a lab."""
    notebook = read(folder.notebook)
    told, given = words(text_of(notebook)), given_lines(notebook)
    tasks = len(folder.lab().exercises) + sum("hl.live(" in code for code in code_of(notebook))
    return told, given, tasks, round(told / WORDS + given / LINES)


def written(readme, minutes):
    """Return the text of labs/README.md with these minutes of reading, a dict by the lab's number."""
    for number, reading in minutes.items():
        readme = re.sub(rf"^(\| {number} [^|]*\|[^|]*\|[^|]*\| \d+ \|) \d* *\|", rf"\1 {reading} |", readme, flags=re.M)
    return readme


def main():
    found = {folder.number: (*reading_time(folder), folder.lab().minutes) for folder in find_labs(LABS)}
    print("lab   words   given lines   tasks   reading [min]   stated [min]   left for a task [min]")
    for number, (told, given, tasks, reading, stated) in found.items():
        print(f"{number}  {told:6d} {given:13d} {tasks:7d} {reading:15d} {stated:14d} {(stated - reading) / tasks:23.1f}")
    if "--write" in sys.argv:
        readme = LABS / "README.md"
        readme.write_text(written(readme.read_text("utf-8"), {number: row[3] for number, row in found.items()}), "utf-8")


if __name__ == "__main__":
    main()
