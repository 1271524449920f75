"""Every address that a site must have: of names, arguments, commands, options, steps of the doctor, faults, the chapter."""

from docutils.nodes import make_id

from hapticlab.device.link.messages import FAULTS

from . import arguments
from .pages import commands, doctor
from .pages.public_names import callables, own_names


def expected():
    """Return the set of ``(file, anchor)``."""
    asked = {(f"{name.document}.html", anchor) for name in own_names() for anchor in _of_name(name)}
    for command, parser in commands.commands().items():
        actions = [None, *commands.options(parser)]
        asked |= {("reference/commands.html", commands.anchor(command, action)) for action in actions}
    asked |= {("reference/doctor.html", make_id(doctor.anchor(step))) for step in doctor.STEPS}
    asked |= {("paddle/faults.html", make_id(code)) for code in FAULTS}
    asked |= {("reference/chapter.html", f"eq-23-{number}") for number in range(1, 11)}
    return asked | {("reference/chapter.html", f"fig-23-{number}") for number in range(1, 8)}


def _of_name(name):
    """Yield the anchors of a name, of its members and of every argument of these."""
    yield name.path
    yield from (f"{name.path}.{short}" for short in name.members)
    for path, value in callables(name):
        yield from (arguments.anchor(path, one) for one in arguments.in_signature(value))
