"""A class is graded on a Dask cluster one of whose workers is killed: the same bytes as in one process."""

import pytest
from attacks.small_lab import HONEST, notebook, write_lab

from hapticlab.errors import CourseError
from hapticlab.grading import cluster
from hapticlab.grading.assignment import find_assignment
from hapticlab.grading.run import run
from hapticlab.grading.sessions.limits import Limits

distributed = pytest.importorskip("distributed")
LIMITS = Limits(seconds=3.0)


#: before the instructor's hidden.py: the second worker that draws cases is killed when it draws them again
KILL = """
import os, signal
from distributed import get_worker
def count():
    try:
        get_worker()
    except ValueError:
        return  # the grader's own process, or a worker without a cluster
    pid = str(os.getpid())
    with open({drawn!r}, "a+") as file:
        file.seek(0)
        before = file.read().split()
        due = "killed" not in before and pid in before and pid != before[0]
        file.write((due and "killed" or pid) + "\\n")
    if due:
        os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.mark.wide
def test_a_cluster_that_loses_a_worker_gives_the_same_bytes(here, tmp_path):
    lab, answers = write_lab(tmp_path)
    drawing = (answers / "hidden.py").read_text().replace("def cases(random):", "def cases(random):\n    count()", 1)
    (answers / "hidden.py").write_text(KILL.format(drawn=str(tmp_path / "drawn")) + drawing)
    assignment = find_assignment(lab, answers.parent, seed=5)
    (tmp_path / "class").mkdir()
    for number in range(6):
        cells = HONEST | {"stiffness": f"stiffness = {730.25 + number % 3}"}
        (tmp_path / "class" / f"s{number}.ipynb").write_bytes(notebook(cells.values()))
    given = [tmp_path / "class"], assignment, LIMITS
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as started:
        graded = run(*given, workers=started.scheduler_address)
    assert (tmp_path / "drawn").read_text().split().index("killed") > 1, "a worker was killed"
    assert [report.earned for report in graded.reports] == [9.0, 10.0, 9.0] * 2 and not graded.failed
    with here():
        alone = run(*given, workers=1)
    assert [report.to_json() for report in graded.reports] == [report.to_json() for report in alone.reports]
    assert graded.walls == alone.walls and graded.processor > 0


def test_an_address_where_nobody_answers_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(cluster, "PATIENCE", 0.5)
    lab, answers = write_lab(tmp_path)
    (tmp_path / "ada.ipynb").write_bytes(notebook(HONEST.values()))
    with pytest.raises(CourseError, match=r"no Dask scheduler answers there.*start one: dask scheduler"):
        run([tmp_path / "ada.ipynb"], find_assignment(lab, answers.parent), LIMITS, workers="tcp://127.0.0.1:1")
