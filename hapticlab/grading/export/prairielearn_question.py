"""A lab as a question of PrairieLearn: a student uploads the notebook, and an external grader calls `hapticlab grade`."""

import hashlib
import html
import json
import uuid

from .gradescope_zip import GUARD, bundle

#: of one grading job; it is the most that PrairieLearn allows
SECONDS = 600
QUESTION = """\
<pl-question-panel>
  <p>{title}. Do the lab in this notebook, then upload it; all of it runs when it is graded.</p>
  <pl-file-download file-name="{notebook}"></pl-file-download>
  <pl-file-upload file-names="{notebook}"></pl-file-upload>
</pl-question-panel>
<pl-submission-panel>
  <pl-external-grader-results></pl-external-grader-results>
  <pl-file-preview></pl-file-preview>
</pl-submission-panel>
"""
RUN = """\
#!/usr/bin/env bash
# PrairieLearn runs this for each submission, in the image that info.json names; it writes results/results.json.
set -uo pipefail
root="${{GRADE_ROOT:-/grade}}"
results="$root/results/results.json"
mkdir -p "$root/results"
# A student's code runs as another user, who must read neither answers nor data.
chmod -R go= "$root/tests" "$root/data" "$root/results" "$root/student"
# The variant decides which hidden cases are drawn: no name of a student comes here.
variant=$(python3 -I - "$root/data/data.json" <<'END'
import json, re, sys
try:
    seed = str(json.load(open(sys.argv[1], encoding="utf-8"))["variant_seed"])
except (OSError, ValueError, KeyError, TypeError):
    seed = ""
print("variant-" + re.sub(r"[^A-Za-z0-9]", "_", seed)[:40])
END
)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/submitted"
cp -R -P "$root/student" "$work/submitted/$variant"
{guard}$guard python3 -P -m hapticlab grade "$work/submitted/$variant" \\
    --lab "$root/tests/labs/{name}" --instructor "$root/tests/answers" \\
    --seed {seed} --sandbox auto --workers 1 --fresh --format prairielearn -o "$results"
rm -f "$results.journal.jsonl"
# what fails here is no fault of the student, and costs no attempt
failed='{{"gradable": false, "format_errors": ["The grader failed, or took too long. Tell your instructor."]}}'
[ -s "$results" ] || echo "$failed" >"$results"
"""
DOCKERFILE = """\
# The image in which PrairieLearn grades: docker build -t {image} . && docker push {image}
FROM python:3.12-slim
{copy}RUN pip install --no-cache-dir {package}
"""


def prairielearn_files(folder, answers, image, seed=0):
    """Return the files of a question, path to bytes.

    Parameters
    ----------
    folder : LabFolder
    answers : Path
        With solution.py and hidden.py.
    image : str
        Docker image with hapticlab inside.
    seed : int
        Of the hidden cases.
    """
    lab, name = folder.lab(), folder.name
    texts = {
        "info.json": json.dumps(_info(lab, name, image), indent=4) + "\n",
        "question.html": QUESTION.format(title=html.escape(f"Lab {lab.number}: {lab.title}"), notebook=folder.notebook.name),
        "tests/run.sh": RUN.format(guard=GUARD, name=name, seed=seed),
    }
    files = {f"tests/{path}": content for path, content in bundle(folder, answers).items()}
    handed_out = {f"clientFilesQuestion/{folder.notebook.name}": folder.notebook.read_bytes()}
    return {**{path: text.encode() for path, text in texts.items()}, **handed_out, **files}


def dockerfile(image, package, wheel=None):
    """Return the Dockerfile of the image that grades; a wheel lies beside it.

    Examples
    --------
    >>> print(dockerfile("grader", "hapticlab==1.0"))
    # The image in which PrairieLearn grades: docker build -t grader . && docker push grader
    FROM python:3.12-slim
    RUN pip install --no-cache-dir "hapticlab==1.0"
    """
    copy = f"COPY {wheel.name} /\n" if wheel else ""
    return DOCKERFILE.format(image=image, copy=copy, package=f'"/{wheel.name}"' if wheel else f'"{package}"')


def _info(lab, name, image):
    """Return info.json; the same lab has the same uuid each time."""
    return {
        "uuid": str(uuid.UUID(bytes=hashlib.sha256(f"hapticlab {name}".encode()).digest()[:16], version=4)),
        "title": f"Lab {lab.number}: {lab.title}",
        "topic": "Haptics",
        "type": "v3",
        "singleVariant": True,
        "gradingMethod": "External",
        "externalGradingOptions": {
            "enabled": True,
            "image": image,
            "entrypoint": "/grade/tests/run.sh",
            "timeout": SECONDS,
            "enableNetworking": False,
        },
    }
