"""A lab as an autograder of Gradescope: a zip whose run_autograder calls `hapticlab grade`, answers and all.

Gradescope unpacks it to ``/autograder/source``, runs setup.sh once, and run_autograder for each submission.
"""

import zipfile
from pathlib import Path

from ...course.labs import CHECKS
from ...course.marks import CLAIMS, HIDDEN, SOLUTION, WRONG
from ...errors import CourseError

#: Gradescope's system may bring an older Python than hapticlab needs: uv finds one or brings it, where every user may read
SETUP = """\
#!/usr/bin/env bash
# Gradescope runs this once, when it builds the autograder.
set -euo pipefail
cd "$(dirname "$0")"
apt-get update
apt-get install -y --no-install-recommends python3-pip
PIP_BREAK_SYSTEM_PACKAGES=1 python3 -m pip install uv
export UV_PYTHON_INSTALL_DIR=/opt/hapticlab-python
python3 -m uv venv --python ">=3.11" /opt/hapticlab
python3 -m uv pip install --python /opt/hapticlab/bin/python {package}
"""
#: Gradescope ends what takes 600 s, and PrairieLearn what info.json says, without a word of why: this says it before
GUARD = """\
# A busy computer may stretch what a submission may use beyond what the system allows for all.
guard=$(command -v timeout) && guard="$guard --signal=INT --kill-after=15 ${GRADE_SECONDS:-570}"
"""
RUN = """\
#!/usr/bin/env bash
# Gradescope runs this for each submission; it writes results/results.json.
set -uo pipefail
root="${{AUTOGRADER_ROOT:-/autograder}}"
python="${{HAPTICLAB_PYTHON:-/opt/hapticlab/bin/python}}"
results="$root/results/results.json"
mkdir -p "$root/results"
# A student's code runs as another user, who must read neither answers nor earlier results.
chmod -R go= "$root/source/answers" "$root/source/labs" "$root/results" "$root/submission"
[ ! -e "$root/submission_metadata.json" ] || chmod go= "$root/submission_metadata.json"
# Who it is decides which hidden cases are drawn: the first of a group, by e-mail.
student=$("$python" -I - "$root/submission_metadata.json" <<'END'
import json, re, sys
try:
    users = json.load(open(sys.argv[1], encoding="utf-8"))["users"]
    name = str(users[0].get("email") or users[0]["id"])
except (OSError, ValueError, KeyError, IndexError, TypeError, AttributeError):
    name = ""
print(re.sub(r"[^A-Za-z0-9@._+-]", "_", name).lstrip(".-")[:100] or "student")
END
)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/submitted"
cp -R -P "$root/submission" "$work/submitted/$student"
{guard}$guard "$python" -P -m hapticlab grade "$work/submitted/$student" \\
    --lab "$root/source/labs/{name}" --instructor "$root/source/answers" \\
    --seed {seed} --sandbox auto --workers 1 --fresh --format gradescope -o "$results"
code=$?
rm -f "$results.journal.jsonl"
# 1 says that the submission could not be graded; why stands in the results, which a student reads
[ -s "$results" ] && exit 0
[ "$code" -ne 124 ] || echo "Grading took too long, and was ended. No points were written down." >&2
exit "$code"
"""


def bundle(folder, answers):
    """Files of a lab that a grader elsewhere needs: path to bytes, ``labs/NN_name/...`` and ``answers/NN_name/...``.

    Parameters
    ----------
    folder : LabFolder
    answers : Path
        With solution.py and hidden.py.
    """
    missing = [name for name in (SOLUTION, HIDDEN) if not (answers / name).is_file()]
    if missing:
        raise CourseError(f"{answers} has no {' and no '.join(missing)}; an instructor's folder of a lab needs both")
    files = {**_files(folder.path, f"labs/{folder.name}"), **_files(answers, f"answers/{folder.name}")}
    for name in (WRONG, CLAIMS):
        files.pop(f"answers/{folder.name}/{name}", None)
    return files


def gradescope_files(folder, answers, package, seed=0, wheel=None, personal=False):
    """Return the files of the autograder, path to bytes.

    Parameters
    ----------
    folder : LabFolder
    answers : Path
        With solution.py and hidden.py.
    package : str
        What pip installs, ``hapticlab==0.2.0``, where no wheel is given.
    seed : int
        Of the hidden cases.
    wheel : Path, optional
        Of hapticlab, to go into the zip and to be installed from there.
    personal : bool
        Whether students have numbers of their own, drawn by the e-mail that Gradescope knows them by.
    """
    installed = f'"./{wheel.name}"' if wheel else f'"{package}"'
    run = RUN.format(guard=GUARD, name=folder.name, seed=f"{seed} --personal" if personal else seed)
    scripts = {"setup.sh": SETUP.format(package=installed), "run_autograder": run}
    files = {name: text.encode() for name, text in scripts.items()}
    return {**files, **({wheel.name: wheel.read_bytes()} if wheel else {}), **bundle(folder, answers)}


def write_zip(path, files):
    """Write files into a zip, the same bytes each time; the scripts that Gradescope runs are executable.

    Parameters
    ----------
    path : str, Path or binary file
    files : dict of str to bytes

    Examples
    --------
    >>> import io
    >>> first, again = io.BytesIO(), io.BytesIO()
    >>> write_zip(first, {"setup.sh": b""}), write_zip(again, {"setup.sh": b""})
    (None, None)
    >>> first.getvalue() == again.getvalue(), zipfile.ZipFile(first).infolist()[0].external_attr >> 16 == 0o100755
    (True, True)
    """
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            entry = zipfile.ZipInfo(name, date_time=(2020, 1, 1, 0, 0, 0))
            entry.create_system, entry.compress_type = 3, zipfile.ZIP_DEFLATED  # of Unix, or the rights are not read
            entry.external_attr = (0o100755 if name in ("setup.sh", "run_autograder") else 0o100644) << 16
            archive.writestr(entry, content)


def _files(folder, place):
    """Return the files of a folder under another name; none that Python or Jupyter made, no older checks."""
    paths = [path for path in sorted(folder.rglob("*")) if path.is_file()]
    inside = {path.relative_to(folder): path for path in paths}
    return {
        f"{place}/{name.as_posix()}": path.read_bytes()
        for name, path in inside.items()
        if not any(part.startswith((".", "__")) for part in name.parts) and not Path(name).name.startswith(f"{CHECKS}.")
    }
