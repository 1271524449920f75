"""Which lower bounds of pyproject.toml may rise by SPEC 0: ``python .ci/spec0.py [--write]``, by hand at a release.

SPEC 0 of Scientific Python supports a Python for 36 months after its first release and a package for 24 months. Every
package that a user of hapticlab installs is looked up at its index, by PEP 691 with the dates of PEP 700. ``--write`` puts the
table into docs/project/versions.md. Nothing is changed in pyproject.toml: a person decides.
"""

import datetime
import json
import sys
import tomllib
import urllib.request
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import InvalidSdistFilename, InvalidWheelFilename, parse_sdist_filename, parse_wheel_filename
from packaging.version import Version

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "project" / "versions.md"
BEGIN, END = "<!-- written by .ci/spec0.py --write -->\n", "<!-- end -->\n"
EXTRAS, MONTHS, JSON = ("notebook", "data", "wasm", "site"), 24, "application/vnd.pypi.simple.v1+json"


def bounds(project):
    """Return package -> the least lower bound, of what users install."""
    texts = [*project["dependencies"], *(text for extra in EXTRAS for text in project["optional-dependencies"][extra])]
    found = {}
    for one in map(Requirement, texts):
        lower = [Version(part.version) for part in one.specifier if part.operator in (">=", "==")]
        if lower:
            found[one.name] = min(*lower, found.get(one.name, lower[0]), lower[0])
    return found


def releases(name):
    """Return version -> the date of its first file, of the index; no version that is not final."""
    asked = urllib.request.Request(f"https://pypi.org/simple/{name.replace('_', '-')}/", headers={"Accept": JSON})
    with urllib.request.urlopen(asked, timeout=60) as answer:
        files, found = json.load(answer)["files"], {}
    for file in files:
        try:
            read = parse_wheel_filename if file["filename"].endswith(".whl") else parse_sdist_filename
            version, date = read(file["filename"])[1], datetime.date.fromisoformat(file["upload-time"][:10])
        except (InvalidWheelFilename, InvalidSdistFilename):
            continue
        if not version.is_prerelease:
            found[version] = min(date, found.get(version, date))
    return found


def may_rise_to(known, today):
    """Return the lowest feature release of the last 24 months; the last one, where all are older.

    Examples
    --------
    >>> day = datetime.date
    >>> known = {Version("1.8"): day(2023, 5, 1), Version("1.9"): day(2024, 5, 1), Version("1.9.1"): day(2025, 1, 1)}
    >>> str(may_rise_to(known | {Version("2.0"): day(2025, 6, 1)}, day(2026, 6, 1)))
    '2.0'
    """
    features = sorted(version for version in known if version.micro == 0 and not version.is_postrelease)
    since = today - datetime.timedelta(days=round(MONTHS * 365.25 / 12))
    return next((version for version in features if known[version] >= since), features[-1])


def table(today):
    """Return the table of bounds as Markdown."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    lines = ["| package | lower bound | released | may rise to | released |", "| --- | --- | --- | --- | --- |"]
    for name, lower in bounds(project).items():
        known = releases(name)
        first = next((version for version in sorted(known) if version >= lower), None)
        rise = may_rise_to(known, today)
        more = f"{rise} | {known[rise]}" if rise > lower else "stays | "
        lines.append(f"| {name} | {lower} | {known.get(first, 'not there')} | {more} |")
    return "\n".join(lines)


def main(words):
    today = datetime.datetime.now(datetime.UTC).date()
    found = f"On {today}:\n\n{table(today)}\n"
    print(found)
    if "--write" in words:
        before, _, rest = PAGE.read_text("utf-8").partition(BEGIN)
        PAGE.write_text(f"{before}{BEGIN}\n{found}\n{END}{rest.partition(END)[2]}", "utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
