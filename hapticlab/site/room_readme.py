"""What a person reads in a folder of wheels: the line of each system that installs from it, and the files with their digests."""

import hashlib

README, DIGESTS = "README.txt", "SHA256SUMS"
INSTALL = """hapticlab for a room without a network

Open a terminal in this folder, and paste the line of your system. It needs no network and no compiler. It makes a
virtual environment `hapticlab` in your own folder, and installs hapticlab there.

{lines}
For: {targets}. Linux needs glibc 2.28 or newer, and macOS 13 or newer.
{missing}
Digests are in {digests}; on Linux, `sha256sum -c {digests}` compares them.

{files}
"""
POWERSHELL = """Windows (PowerShell):
  py -{python} -m venv $HOME\\hapticlab; & $HOME\\hapticlab\\Scripts\\pip install --no-index --find-links . "{what}"
then
  & $HOME\\hapticlab\\Scripts\\hapticlab {command}
"""
SHELL = """{system}:
  python{python} -m venv ~/hapticlab && ~/hapticlab/bin/pip install --no-index --find-links . "{what}"
then
  ~/hapticlab/bin/hapticlab {command}
"""
#: beginning of a target -> how it installs, and what it is called
LINES = {"windows": (POWERSHELL, "Windows"), "macos": (SHELL, "macOS"), "linux": (SHELL, "Linux")}


def describe(folder, files, what, served, missing):
    """Write what a person reads in the folder, and the digests."""
    command = "labs" if "notebook" in what else "demo"
    lines = []
    for beginning, (text, system) in LINES.items():
        for target in [target for target in served if target.startswith(beginning)][-1:]:
            lines.append(text.format(system=system, python=target.rpartition(" ")[2], what=what, command=command))
    sizes = [f"{size / 1e6:8.2f} MB  {name}\n" for name, size in files.items()]
    text = INSTALL.format(
        lines="\n".join(lines), targets="; ".join(served), missing="".join(f"Missing: {line}\n" for line in missing),
        digests=DIGESTS, files="".join([*sizes, f"{sum(files.values()) / 1e6:8.2f} MB  all {len(files)} wheels"]),
    )  # fmt: skip
    (folder / README).write_text(text, "utf-8")
    digests = [f"{hashlib.sha256((folder / name).read_bytes()).hexdigest()}  {name}\n" for name in files]
    (folder / DIGESTS).write_text("".join(digests), "utf-8", newline="\n")
