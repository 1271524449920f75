"""A class of any size: honest work in many versions, wrong work, attackers, and who is near or beyond a limit of time."""

import random
from dataclasses import replace

from . import broken, eating, ending, forging, spying
from .attack import Attack, attack
from .small_lab import POINTS

#: as good as the honest ones
VERSIONS = {
    "force": (
        "def force(x, k):\n    depth = x - 0.01\n    return k * depth * (depth > 0)",
        "def force(x, k):\n    return max(0.0, k * (x - 0.01))",
        "force = lambda x, k: k * np.clip(x - 0.01, 0, None)",
    ),
    "energy": (
        "def energy(x, k):\n    return k * float(np.dot(x[:-1], x[1:] - x[:-1]))",
        "def energy(x, k):\n    return sum(k * a * (b - a) for a, b in zip(x, x[1:]))",
    ),
    "forces": (
        "def forces(x, k):\n    return [k * one for one in x]",
        "def forces(x, k):\n    print('k =', k)\n    return np.multiply(k, x)",
    ),
    "wall": ("wall = hl.wall()",),
    "stiffness": ("stiffness = 1462.5 / 2", "stiffness = np.float64(731.25)"),
    "why": ("why = 'B'", "why = 'b'"),
}
#: as students get it wrong
WRONG = {
    "force": ("def force(x, k):\n    return k * x", "def force(x, k):\n    return -k * (x - 0.01)", "force = None"),
    "energy": ("def energy(x, k):\n    return k * x[-1]**2 / 2", "def energy(x, k):\n    return nothing"),
    "forces": ("def forces(x, k):\n    return -k * x", "def forces(x, k):\n    return 1000 * k * x", "def forces(x, k):"),
    "wall": ('k, x_o = hl.parameters("k x_o", units="N/m m")\nwall = hl.Scene(force=-k * (x(n) - x_o))', "wall = 3"),
    "stiffness": ("stiffness = 0.73125", "stiffness = '731'"),
    "why": ("why = 'a'", "why = 'why not'"),
}
#: honest, and three quarters of the limit of time
SECONDS, SLEEP = 2.0, "import time\ntime.sleep(1.5)\n"
WAITING = tuple(one for one in eating.ATTACKS if one.name in ("sleep", "hang_in_a_call", "stops_itself"))
ATTACKERS = tuple(one for sort in (broken, ending, forging, spying) for one in sort.ATTACKS if not one.patience)


def mixed(number, seed=0):
    """Return so many submissions for a limit of SECONDS: of ten four honest, three wrong somewhere, three of the corpus.

    Of a hundred one waits for the limit, and one is near it.
    """
    drawn = random.Random(seed)
    return tuple(_one(f"s{student:04d}", drawn, student) for student in range(number))


def _one(name, drawn, student):
    if student % 100 == 9:
        return _renamed(drawn.choice(WAITING), name)
    if student % 10 >= 7:
        return _renamed(drawn.choice(ATTACKERS), name)
    answers = {exercise: drawn.choice(several) for exercise, several in VERSIONS.items()}
    wrong = drawn.sample(sorted(POINTS), drawn.randint(1, 3)) if student % 10 >= 4 else ()
    answers |= {exercise: drawn.choice(WRONG[exercise]) for exercise in wrong}
    if student % 100 == 0:
        answers["force"] = SLEEP + answers["force"]
    return replace(attack(name, first=f"# {name}", lost=None, **answers), lost=tuple(wrong))


def _renamed(one, name):
    """Return an attack as another student's."""

    def path(old):
        first, slash, rest = old.partition("/")
        return f"{name}{slash}{rest}" if slash else f"{name}.{first.rpartition('.')[2]}"

    return Attack(name, {path(old): content for old, content in one.files.items()}, one.lost, unreadable=one.unreadable)
