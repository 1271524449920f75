"""The page of the doctor's steps: what each checks is said here; what it can find and advise is read out of its code."""

import ast
import inspect

from hapticlab.device.setup import computer_checks, doctor, doctor_checks

#: step -> what it checks, in the order of the walk
STEPS = {
    "notebook": "Whether JupyterLab and the widgets that the labs and the live view need are installed.",
    "rights": "Whether your user may open serial ports, and what your system is known to put in the way.",
    "computer": "Which serial ports the computer has, and whether one of them belongs to a known board.",
    "port": "Whether the port opens.",
    "firmware": "Whether hapticlab's firmware answers, and speaks the messages of your version of the package.",
    "reset": "Why the board was last reset.",
    "fault": "Whether a fault was pending when the doctor came. Without one, this step has no line.",
    "settings": "Whether the board has settings, and whether they were measured on this paddle.",
    "wiring": "Whether the board is set to the wiring that is built, and whether a person has confirmed it.",
    "latency": "How long a request takes there and back, the median and the worst of 200.",
    "loop": "Whether every step ran on time during two seconds, with the motor off.",
    "link": "Whether every sample of these two seconds arrived undamaged.",
    "noise": "How wide the sensor's reading is while nobody touches the handle.",
    "sensor": "Whether the reading follows the handle from stop to stop without jumps. A person moves it, with the motor off.",
    "home": "Whether the board knows where the handle is. If not, a person moves the handle to both stops.",
    "motor": "Whether the motor pulls the way it is told. The motor gives a force, at most 0.5 N, only if a person agrees.",
}
HEAD = """# Steps of the doctor

[`hapticlab doctor`](commands.md#hapticlab-doctor) and {py:obj}`hl.doctor <hapticlab.doctor>` walk from the cable to the motor.
Every step prints one line: its state, its name and what was found. A line that begins with `->` says what to do. The states are
*ok*, *attention*, *fault*, *no board* and *skipped*. The walk ends at the first step that leaves nothing to go on with.

The tables below are read out of the code; a `…` stands for a number or a name of your computer.

"""


def write(source):
    """Write the page into the copied source."""
    (source / "reference").mkdir(exist_ok=True)
    (source / "reference" / "doctor.md").write_text(page(), "utf-8")


def anchor(step):
    """The anchor of a step."""
    return f"doctor-{step}"


def page():
    """The page of all steps."""
    found = checks()
    return HEAD + "\n".join(_section(step, words, found[step]) for step, words in STEPS.items())


def _section(step, words, rows):
    order = sorted(dict.fromkeys(rows), key=lambda row: [row[0].startswith(state) for state in doctor.STATES][::-1])
    lines = [f"| {' | '.join(_cell(text) for text in row)} |" for row in order]
    table = ["| state | what is found | what to do |", "| --- | --- | --- |", *lines]
    return "\n".join([f"({anchor(step)})=", f"## {step}", "", words, "", *table, ""])


def _cell(text):
    text = "as printed" if text == "…" else text
    return text.replace("|", "\\|").replace("*", "\\*").replace("\n", "; ") or " "


def checks():
    """Step -> the (state, found, cure) that the code can return, in the order of the code."""
    found = {}
    for module in (computer_checks, doctor, doctor_checks):
        tree = ast.parse(inspect.getsource(module))
        functions = {one.name: one for one in tree.body if isinstance(one, ast.FunctionDef)}
        for function in functions.values():
            for call in ast.walk(function):
                if isinstance(call, ast.Call) and getattr(call.func, "attr", getattr(call.func, "id", "")) == "Check":
                    words = [_words(given, function, functions) for given in call.args]
                    found.setdefault(words[0], []).append((*words[1:], *[""] * (4 - len(words))))
    return found


def _words(node, function, functions):
    """The text that an expression gives, with … where only a run knows it; the texts of a choice, the usual one last."""
    match node:
        case ast.Constant(value=str(text)):
            return text
        case ast.JoinedStr(values=parts):
            return "".join(part.value if isinstance(part, ast.Constant) else "…" for part in parts)
        case ast.BinOp(left=left, right=right):
            return _words(left, function, functions) + _words(right, function, functions)
        case ast.IfExp(body=body, orelse=other):
            both = [_words(one, function, functions) for one in (body, other)]
            return " or ".join(text for text in both if text)
        case ast.Name(id=name):
            return _words(_last_value(name, node.lineno, function), function, functions)
        case ast.Call(func=ast.Attribute(value=ast.Dict(values=values), attr="get"), args=[_, default]):
            return " or ".join(_words(one, function, functions) for one in (*values, default))
        case ast.Call(func=ast.Name(id=name)) if name in functions:
            ends = [one.value for one in ast.walk(functions[name]) if isinstance(one, ast.Return)]
            return "; or ".join(dict.fromkeys(_words(one, functions[name], functions) for one in ends))
    return "…"


def _last_value(name, line, function):
    """The value that a name was given last above a line; None where it is an argument, or a part of something."""
    above = [one for one in ast.walk(function) if isinstance(one, ast.Assign) and one.lineno < line]
    given = [one for one in above if isinstance(one.targets[0], ast.Name) and one.targets[0].id == name]
    return max(given, key=lambda one: one.lineno).value if given else None
