"""docs/teaching/server.md, a server: its exchange and its commands anywhere, and all of it word for word on a JupyterHub.

The long version needs root on Linux, an environment with jupyterhub that every user may run, and configurable-http-proxy on
PATH or in the folder that HAPTICLAB_PROXY names; ``.ci/hub`` installs both and runs it. It makes users, and writes to /etc and
/srv, in namespaces of its own, and reaches 127.0.0.1 alone.
"""

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest
from hand_in import INSTRUCTOR, ROOT, WRONG, earned, handed_in
from hub_trial import HUB, LAB, NOTEBOOK, PAGE, blocks, files

from hapticlab.cli.main import main
from hapticlab.cli.options import parser
from hapticlab.course.notebook import read

NEEDED = ("unshare", "nsenter", "mount", "ip", "su", "useradd", "chpasswd", "node")
PROXY = os.environ.get("HAPTICLAB_PROXY", "")


def lacking():
    """Return what this computer lacks for the whole page."""
    if sys.platform != "linux" or os.geteuid() != 0:
        return "root on Linux"
    if find_spec("jupyterhub") is None:
        return "jupyterhub in this environment"
    places = [Path(sys.prefix).resolve(), Path(sys.executable).resolve()]
    shut = [str(one) for place in places for one in (place, *place.parents) if not one.stat().st_mode & 1]
    if shut:
        return f"a Python that every user may run; {shut[0]} is closed to others"
    if not shutil.which("configurable-http-proxy", path=PROXY or None):
        return "configurable-http-proxy on PATH, or its folder in HAPTICLAB_PROXY"
    return next((f"the command {name}" for name in NEEDED if not shutil.which(name)), "")


def commands(tool):
    """Return the page's commands of a tool, as words."""
    lines = (shlex.split(line) for _, _, block in blocks() for line in block.splitlines())
    return [words[1:] for words in lines if words[0] == tool]


def test_every_command_of_hapticlab_is_understood():
    parsed = [parser().parse_args(words) for words in commands("hapticlab")]
    assert [options.command.rpartition(".")[2] for options in parsed] == ["assign", "grade"]


def test_every_command_of_nbgrader_is_one():
    app = pytest.importorskip("nbgrader.apps.nbgraderapp").NbGraderApp
    named = [words[0] for words in commands("nbgrader")]
    assert len(named) == 8 and set(named) <= set(app.subcommands)


def test_blocks_and_files_of_the_page_are_all_seen():
    assert len(blocks()) + len(files()) == PAGE.count("```") // 2
    assert {who for who, _, _ in blocks()} == {"root", "prof", "bob"}
    assert HUB in files()["/srv/jupyterhub/jupyterhub_config.py"]
    assert [line for line in PAGE.splitlines() if len(line) > 125] == []


@pytest.fixture
def exchange(tmp_path, monkeypatch):
    """Return a function that makes a part of nbgrader for somebody: the page's configuration, with folders of this test."""
    loader = pytest.importorskip("traitlets.config.loader").PyFileConfigLoader
    pytest.importorskip("nbgrader")
    from nbgrader.auth import Authenticator
    from nbgrader.coursedir import CourseDirectory

    (tmp_path / "exchange").mkdir()
    (tmp_path / "exchange").chmod(0o1777)
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    monkeypatch.setenv("PATH", path)  # for alembic, which makes a gradebook
    monkeypatch.setenv("JUPYTER_DATA_DIR", str(tmp_path / "data"))
    text = files()["/etc/jupyter/nbgrader_config.py"].replace("/srv/nbgrader/exchange", str(tmp_path / "exchange"))
    (tmp_path / "nbgrader_config.py").write_text(text, "utf-8")

    def part(of_nbgrader, root, student="*"):
        config = loader("nbgrader_config.py", path=str(tmp_path)).load_config()
        config.CourseDirectory.merge({"root": str(root), "student_id": student, "assignment_id": LAB.name})
        config.Exchange.merge({"assignment_dir": str(root), "cache": str(root / "cache")})
        return of_nbgrader(coursedir=CourseDirectory(config=config), authenticator=Authenticator(config=config), config=config)

    return part


@pytest.mark.wide
@pytest.mark.filterwarnings("ignore:Exception ignored in")  # nbgrader leaves timestamp.txt open
@pytest.mark.filterwarnings("ignore:unclosed file")
def test_the_exchange_takes_labs_out_and_back_and_pages_to_students(exchange, tmp_path, here, monkeypatch):
    from nbgrader.exchange import default

    course = tmp_path / "haptics"
    shutil.copytree(LAB.path, course / "release" / LAB.name)  # equals what nbgrader makes of a source
    exchange(default.ExchangeReleaseAssignment, course).start()
    wrong = {"ada": None, "bob": WRONG["02"]}
    for student in wrong:
        home = tmp_path / student
        home.mkdir()
        exchange(default.ExchangeFetchAssignment, home, student).start()
        (home / NOTEBOOK).write_text(json.dumps(handed_in(read(home / NOTEBOOK), LAB, wrong[student])), "utf-8")
        exchange(default.ExchangeSubmit, home, student).start()
    exchange(default.ExchangeCollect, course).start()
    monkeypatch.chdir(course)
    (grade,) = (words for words in commands("hapticlab") if words[0] == "grade")
    short = [{"../answers": str(INSTRUCTOR), "namespaces": "auto"}.get(word, word) for word in grade]
    del short[short.index("--gradebook") : short.index("--gradebook") + 2]
    with here():
        assert main([*short, "-o", "marks.json", "--format", "json"]) == 0
    marks = {one["student"]: one["earned"] for one in json.loads(Path("marks.json").read_text("utf-8"))["reports"]}
    assert marks == {student: earned(LAB, wrong[student]) for student in wrong} and marks["bob"] < 10
    (loop,) = (block for who, under, block in blocks() if (who, under) == ("prof", "Feedback"))
    subprocess.run(["bash", "-ec", "\n".join(loop.splitlines()[1:-1])], check=True)  # without `cd` and nbgrader's own line
    exchange(default.ExchangeReleaseFeedback, course).start()
    for student in wrong:
        exchange(default.ExchangeFetchFeedback, tmp_path / student, student).start()
        (page,) = (tmp_path / student / LAB.name / "feedback").rglob("*.html")
        assert page.read_text("utf-8") == Path(f"pages/students/{student}.html").read_text("utf-8")
    # nbgrader follows a link that was handed in, so the page mounts the exchange with nosymfollow
    linked = tmp_path / "exchange" / "haptics" / "inbound" / f"eve+{LAB.name}+2026-01-01 00:00:00.000000 UTC+x"
    linked.mkdir()
    (linked / LAB.notebook.name).symlink_to(INSTRUCTOR / LAB.name / "solution.py")
    exchange(default.ExchangeCollect, course).start()
    solution = (INSTRUCTOR / LAB.name / "solution.py").read_text("utf-8")
    assert (course / "submitted" / "eve" / NOTEBOOK).read_text("utf-8") == solution


@pytest.fixture(scope="module")
def facts(tmp_path_factory):
    """What happened when every line of the page was given, from the users' accounts to the feedback."""
    if lacks := lacking():
        pytest.skip(f"a course on a server needs {lacks}")
    place = tmp_path_factory.mktemp("server")
    for folder in (place, *place.parents):
        if folder.stat().st_uid == os.geteuid() and folder != Path(folder.root):
            folder.chmod(folder.stat().st_mode | 0o011)  # other users pass through
    environment = {
        **os.environ,
        "PATH": os.pathsep.join(filter(None, [PROXY, os.environ["PATH"]])),
        "PYTHONPATH": str(ROOT / "tests" / "grading"),
    }
    away = ["unshare", "--mount", "--net", "--pid", "--fork", "--mount-proc", "--kill-child"]
    command = [*away, sys.executable, str(ROOT / "tests" / "grading" / "hub_trial.py"), str(place)]
    done = subprocess.run(command, env=environment, text=True, capture_output=True)
    assert done.returncode == 0, f"{done.stdout[-2000:]}\n{done.stderr[-8000:]}"
    return json.loads((place / "facts.json").read_text("utf-8"))


@pytest.mark.slow
def test_students_fetch_solve_and_submit_in_their_own_servers(facts):
    judged = [one.name for one in LAB.lab().exercises if one.judged]
    for key, wrong in (("checked", {}), ("bob_checked", WRONG["02"])):
        said = dict(re.match(r"02\.(\w+): (.*)", one).groups() for one in facts[key] if one.startswith("02."))
        assert [name for name in judged if said[name].startswith("right")] == [name for name in judged if name not in wrong]
    assert [one.split(":")[0] for one in facts["bob_checked"] if not one.startswith("02.")] == ["PermissionError"]


@pytest.mark.slow
def test_no_student_reads_answers_or_reaches_another_student(facts):
    assert facts["open_to_ada"] == []
    assert facts["servers_of_others"] == [403, 403, 200]
    assert {address.split(":")[0] for address in facts["listening"]} == {"0100007F"}, "127.0.0.1 alone"


@pytest.mark.slow
def test_a_link_and_a_false_name_are_told_and_bring_nothing(facts):
    said, well = facts["linked"]
    assert not well and "Too many levels of symbolic links" in said and facts["through_the_link"] == []
    said, well = facts["forged"]
    assert well and re.search(r"claims to be\s+submitted\s+by\s+bob\s+but\s+is\s+owned\s+by\s+ada", said)


@pytest.mark.slow
def test_the_marks_of_hapticlab_are_in_the_gradebook(facts):
    assert "pushed marks of 2 students" in facts["graded"] and "sandbox: namespaces" in facts["graded"]
    rows = [line.split(",") for line in facts["marks"].splitlines()]
    column = {name: place for place, name in enumerate(rows[0])}
    scores = {row[column["student_id"]]: float(row[column["score"]]) for row in rows[1:]}
    assert scores == {"ada": 10.0, "bob": earned(LAB, WRONG["02"])}


@pytest.mark.slow
def test_where_no_user_may_make_namespaces_root_grades_or_landlock_holds(facts):
    status, said = facts["forbidden"]["prof"]
    assert status == 1 and "sandbox namespaces" in said and "points" not in said
    for who, level in {"root": "namespaces", "landlock": "landlock"}.items():
        status, said = facts["forbidden"][who]
        assert status == 0 and f"sandbox: {level}" in said and "ada: 10 of 10 points" in said


@pytest.mark.slow
def test_each_student_fetches_their_own_page(facts):
    assert facts["bob_feedback"] == facts["bobs_page"] and "8 of 10 points" in facts["bob_feedback"]
    assert "10 of 10 points" in facts["ada_feedback"] and "bob" not in facts["ada_feedback"]
