"""Where attacks are run: the lab, what they must not reach, and traps that would tell if they did."""

import os
import socket
import sys
from contextlib import ExitStack, contextmanager
from pathlib import Path

import hapticlab
from hapticlab.grading.assignment import find_assignment
from hapticlab.grading.handed_in.naming import student_of
from hapticlab.grading.run import run
from hapticlab.grading.sessions.limits import MIB, Limits

from . import (
    broken,
    colluding,
    eating,
    ending,
    forging,
    holding,
    injecting,
    kernel,
    leaking,
    package,
    python,
    replies,
    resubmitting,
    spying,
)
from .small_lab import write_lab

SORTS = (broken, eating, ending, forging, spying, injecting, leaking, kernel, holding, python, package, replies, colluding)
#: what is open now and then: whether a file lies in the computer's memory is told by the time that it takes to read
CHANCE = ("pages_by_time_2_finds",)
ATTACKS = tuple(one for sort in (*SORTS, resubmitting) for one in sort.ATTACKS if one.name not in CHANCE)
HONEST = tuple(one for one in broken.ATTACKS if one.name.startswith("honest"))
#: the plainest one, and holes there were
ALWAYS = ("fork_bomb", "memory_that_is_shared", "reply_with_its_number", "honest_split_cells", "honest_magics")
#: what waits for its limits, one of each sort
WAITING = ("hang_in_a_cell", "hang_that_swallows", "stop_its_parent")
PATIENT = tuple(one for one in ATTACKS if one.name in WAITING)
#: what every run of the tests holds beside these: some of each sort
QUICK = tuple(
    one
    for sort, step in (
        *((broken, 7), (eating, 4), (ending, 4), (forging, 5), (spying, 2), (injecting, 6), (leaking, 1), (resubmitting, 1)),
        *((kernel, 6), (holding, 13), (python, 6), (package, 6), (replies, 5), (colluding, 13)),
    )
    for number, one in enumerate(one for one in sort.ATTACKS if not one.patience and one in ATTACKS)
    if number % step == 0 or one.name in ALWAYS
)
LIMITS = Limits(seconds=4.0, memory=400 * MIB)
TOKEN = "hapticlab_was_here"


class Arena:
    """A folder with the lab, its answers, submissions and traps; a context manager.

    Parameters
    ----------
    place : Path
    attacks : sequence of Attack
    """

    def __init__(self, place, attacks):
        self.place, self.attacks = place, attacks
        self.lab, self.answers = write_lab(place)
        self.assignment = find_assignment(self.lab, self.answers.parent, seed=5)
        self.submissions, self.canary = place / "submissions", place / "canary"
        self.journal = place / "results.json.journal.jsonl"
        self.submissions.mkdir()
        self.canary.write_text("alive")

    def __enter__(self):
        self._stack = ExitStack()
        self.tcp = self._stack.enter_context(socket.create_server(("127.0.0.1", 0)))
        port = self.tcp.getsockname()[1]
        self.udp = self._stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
        self.udp.bind(("127.0.0.1", port))
        self.unix = self._stack.enter_context(socket.socket(socket.AF_UNIX))
        name = f"hapticlab-{os.getpid()}-{port}"
        self.unix.bind(f"\0{name}")
        self.unix.listen()
        self.pair = self._stack.enter_context(socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM))
        self.pair.bind(f"\0{name}.d")
        for trap in (self.tcp, self.udp, self.unix, self.pair):
            trap.setblocking(False)
        self._stack.enter_context(_secret())
        surroundings = {
            "ANSWERS": self.answers,
            "CANARY": self.canary,
            "LAB": self.lab,
            "NAMESPACE": os.readlink("/proc/self/ns/pid"),
            "OTHERS": self.submissions,
            "PORT": port,
            "RESULTS": self.place / "results.json",
            "SOCKET": name,
            "TOKEN": TOKEN,
        }
        written = [(one.write(self.submissions, **surroundings).name, one) for one in self.attacks]
        self.names = {student_of(name, self.lab.name): one for name, one in written}
        self.before = self.handed_in()
        return self

    def __exit__(self, *_):
        self._stack.close()

    def handed_in(self):
        """Return what lies in the folders of the submissions, the lab and the answers, path to bytes."""
        folders = (self.submissions, self.lab, self.answers)
        return {path: path.read_bytes() for folder in folders for path in folder.rglob("*") if path.is_file()}

    def graded(self, workers=2, limits=LIMITS):
        """Grade all, in namespaces or not at all, and return what that gave."""
        return run([self.submissions], self.assignment, limits, workers=workers, sandbox="namespaces", journal=self.journal)

    def by_attack(self, graded):
        """Return the report of each attack by its name."""
        return {self.names[report.student].name: report for report in graded.reports}

    def reached(self):
        """Return what attacks reached that they must not, in words."""
        found = [f"{path} is changed" for path, content in self.before.items() if _content(path) != content]
        found += [f"{path} is new" for path in self.handed_in().keys() - self.before.keys()]
        if _content(self.canary) != b"alive":
            found.append("the canary is dead")
        folders = ("/", "/usr", "/etc", "/lib", "/dev", "/tmp", "/dev/shm", sys.prefix, Path(hapticlab.__file__).parent)
        left = (Path(folder, name) for folder in folders for name in (TOKEN, "left_for_the_next.py"))
        found += [f"{path} was written" for path in left if path.exists()]
        found += [f"{name} was reached" for name, trap in (("tcp", self.tcp), ("unix", self.unix)) if _was_called(trap.accept)]
        sent = (("udp", self.udp), ("a pair of sockets", self.pair))
        return found + [f"{name} was reached" for name, trap in sent if _was_called(lambda trap=trap: trap.recv(100))]


def _content(path):
    return path.read_bytes() if path.is_file() else None


def _was_called(receive):
    try:
        receive()
    except BlockingIOError:
        return False
    return True


@contextmanager
def _secret(name="SECRET_OF_THE_GRADER"):
    """Have a secret in the environment that no student's process may see."""
    before, os.environ[name] = os.environ.get(name), "stiffness = 731.25"
    try:
        yield
    finally:
        os.environ.pop(name)
        os.environ.update({name: before} if before else {})
