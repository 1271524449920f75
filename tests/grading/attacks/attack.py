"""One submission of the corpus, and how it is put together from honest answers and others."""

from dataclasses import dataclass, field
from textwrap import dedent

from .small_lab import HONEST, POINTS, notebook

#: written in an attack's code where it needs to know its surroundings, and replaced when the attack is written to a folder
PLACEHOLDERS = (
    "@ANSWERS@",
    "@CANARY@",
    "@LAB@",
    "@NAMESPACE@",
    "@OTHERS@",
    "@PORT@",
    "@RESULTS@",
    "@SOCKET@",
    "@TOKEN@",
)
EVERYTHING = tuple(POINTS)
#: what would hurt this computer is done only where a namespace of processes was made around it, in an attack's code
WALLED = "os.readlink('/proc/self/ns/pid') != '@NAMESPACE@'"
#: what would hurt it if root did it
HARMLESS = f"(os.getuid() or {WALLED})"


@dataclass(frozen=True)
class Attack:
    """A submission, what it loses, and why.

    Attributes
    ----------
    name : str
        The student.
    files : dict of str to bytes
        What is handed in, by the path beside the other submissions.
    lost : tuple of str
        Exercises that earn nothing; all others are honest and earn their points.
    ended : dict of str to str
        Exercises whose process ended early, and why.
    unreadable : bool
        Nothing of it can be graded, and the report says why.
    patience : bool
        It runs into time limits: seconds where others take milliseconds.
    """

    name: str
    files: dict
    lost: tuple = ()
    ended: dict = field(default_factory=dict)
    unreadable: bool = False
    patience: bool = False

    @property
    def earned(self):
        """What its honest part is worth."""
        return sum(points for name, points in POINTS.items() if name not in self.lost)

    def write(self, place, **surroundings):
        """Write the files into a folder; return what is handed in."""
        for path, content in self.files.items():
            for name in PLACEHOLDERS:
                content = content.replace(name.encode(), str(surroundings.get(name.strip("@"), "")).encode())
            (place / path).parent.mkdir(parents=True, exist_ok=True)
            (place / path).write_bytes(content)
        return place / next(iter(self.files)).split("/")[0]


def attack(name, *, first="", last="", beside=None, ended=None, patience=False, lost=(), **replaced):
    """Return an attack in a notebook: honest answers, except the replaced ones, between a first and a last cell.

    Parameters
    ----------
    name : str
    first, last : str
        Cells before and after all others.
    beside : dict of str to bytes
        Files handed in with the notebook, in a folder.
    ended, patience, lost
        As of Attack; what is replaced is lost as well, unless ``lost`` is None.
    **replaced : str
        Exercise to the code that answers it.
    """
    cells = HONEST | {exercise: dedent(code).strip() for exercise, code in replaced.items()}
    sources = [dedent(first).strip(), *cells.values(), dedent(last).strip()]
    wrong = () if lost is None else (*[name for name in replaced if name in POINTS], *lost)
    content = notebook([source for source in sources if source])
    files = {f"{name}.ipynb": content} if beside is None else {f"{name}/42_small_wall.ipynb": content, **_in(name, beside)}
    return Attack(name, files, wrong, ended or {}, patience=patience)


def file(name, path, content):
    """Return an attack that is a file nobody can grade."""
    return Attack(name, {path: content}, EVERYTHING, unreadable=True)


def _in(folder, files):
    return {f"{folder}/{path}": content for path, content in files.items()}
