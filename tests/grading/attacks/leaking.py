"""Work that tells its student the givens of hidden cases, which are the same when it is handed in again."""

from .attack import attack

#: all givens that are in reach while a case is evaluated, in text; and, in a hidden case, of which k is not a whole number
_GIVENS = """
import gc, sys
def givens():
    frame, seen = sys._getframe(), []
    while frame:
        seen += [*frame.f_locals.values(), *frame.f_globals.values()]
        frame = frame.f_back
    held = [one["givens"] for one in [*seen, *gc.get_objects()] if type(one) is dict and "givens" in one]
    return "the givens: " + repr(held)
def hidden(k):
    return k != round(k)
"""
_RIGHT = "k * (x - 0.01) if x >= 0.01 else 0.0"
#: replies with a sentence beside each value
_BESIDE = """
for module in list(sys.modules.values()):
    if module.__name__.startswith("hapticlab.") and callable(vars(module).get("evaluate")):
        def evaluate(*given, was=module.evaluate):
            found = was(*given)
            return type(found)(found.value if PUBLIC else 1.5, givens(), givens())
        module.evaluate = evaluate
"""
ATTACKS = (
    attack(
        "hidden_givens_printed",
        first=_GIVENS,
        force="""
        def force(x, k):
            print(givens())
            return 1.0""",
    ),
    attack(
        "hidden_givens_printed_once_right",
        first=_GIVENS,
        force=f"""
        def force(x, k):
            print(givens())
            return 1.0 if hidden(k) else {_RIGHT}""",
    ),
    attack(
        "hidden_givens_as_a_value",
        first=_GIVENS,
        force="""
        def force(x, k):
            return givens()""",
        energy="""
        import re
        def energy(x, k):
            return max(map(float, re.findall("[0-9.]+", givens())))""",
    ),
    attack(
        "hidden_givens_as_a_problem",
        first=_GIVENS + "from hapticlab.errors import CourseError",
        force=f"""
        def force(x, k):
            if hidden(k):
                raise CourseError("at " + repr((x, k)) + givens())
            return {_RIGHT}""",
    ),
    attack(
        "hidden_givens_beside_a_value",
        first=_GIVENS + _BESIDE.replace("PUBLIC", "False"),
        force="def force(x, k):\n    return 1.0",
        lost=("energy", "forces", "wall", "stiffness", "why"),
    ),
    attack(
        "hidden_givens_left_in_a_file",
        first=_GIVENS,
        force="""
        def force(x, k):
            with open("left", "a") as file:
                file.write(repr((x, k)) + givens())
            return 1.0""",
        energy="""
        def energy(x, k):
            print(open("left").read())
            return 1.0""",
    ),
)
