"""The page of commands: from the parser of the command line, with examples from the documents."""

import argparse
import re

from hapticlab.cli import exits
from hapticlab.cli.begin import GROUPS
from hapticlab.cli.options import parser

from .uses import FOLDERS, ROOT

#: exit code -> when a command ends with it
EXITS = {
    0: "The command did what it was asked to do.",
    exits.FAILED: "The run failed, and a sentence says why; the doctor also ends so where it found a fault or no board.",
    exits.USAGE: "The command or one of its options is wrong; nothing ran.",
    exits.INTERRUPTED: "Ctrl-C ended the command.",
    exits.BROKEN_PIPE: "The program that read the output ended first.",
}
HEAD = """# Commands

`hapticlab -h` lists the commands, and `hapticlab COMMAND -h` the options of one. Each command and each option has an address of
its own on this page.

"""


def write(source):
    """Write the page into the copied source."""
    (source / "reference").mkdir(exist_ok=True)
    (source / "reference" / "commands.md").write_text(page(), "utf-8")


def page():
    """The page of all commands, in the groups of the first screen."""
    made = commands()
    grouped = [name for names in GROUPS.values() for name in names]
    order = [*grouped, *(name for name in made if name not in grouped)]
    return HEAD + "\n".join(_section(name, made[name]) for name in order) + _exits()


def commands():
    """Command -> its parser; a second name of the same command is left out."""
    made = {}
    for name, one in parser().commands.items():
        if one not in made.values():
            made[name] = one
    return made


def options(command):
    """The options and arguments of a command's parser, without its help."""
    return [action for action in command._actions if not isinstance(action, argparse._HelpAction)]


def anchor(name, action=None):
    """The anchor of a command, or of one of its options: ``hapticlab-grade-lab``, by the longest spelling."""
    if action is None:
        return f"hapticlab-{name}"
    spelt = max(action.option_strings, key=len, default=action.dest) if action.option_strings else action.dest
    return f"hapticlab-{name}-{spelt.lstrip('-').lower().replace('_', '-')}"


def _section(name, command):
    usage = re.sub(r"^usage: ", "", _narrow(command))
    shown = [f"({anchor(name)})=", f"## hapticlab {name}", "", _sentence(command.description), "", f"```text\n{usage}```", ""]
    if described := "\n\n".join(_option(name, command, action) for action in options(command)):
        shown += [f"```{{eval-rst}}\n.. program:: hapticlab {name}\n\n{described}\n```", ""]
    if lines := examples(name):
        shown += ["For example:", "", "```sh\n" + "\n".join(lines) + "\n```", ""]
    return "\n".join(shown)


def _narrow(command):
    """The usage of a command in lines of at most 80 columns, whatever the terminal."""
    made = argparse.HelpFormatter(command.prog, width=80)
    made.add_usage(command.usage, command._actions, command._mutually_exclusive_groups)
    return re.sub(r"\x1b\[[\d;]*m", "", made.format_help())


def _sentence(text):
    return text[:1].upper() + text[1:] + ("" if text.endswith(".") else ".")


def _option(name, command, action):
    words = " ".join(_expanded(command, action).split())
    if action.choices and "{" not in str(action.metavar):
        words += f"; one of {', '.join(map(str, action.choices))}"
    if action.required and action.option_strings:
        words += "; required"
    return f".. _{anchor(name, action)}:\n\n.. option:: {_spelt(action)}\n\n   {words}"


def _expanded(command, action):
    words = command._get_formatter()._expand_help(action) if action.help else SAID[action.dest]
    return words.replace("*", "\\*")


#: arguments that explain themselves on the screen by their name alone
SAID = {"file": "the scene file: Python that defines `scene`, and optionally `paddle` and `duration`".replace("`", "``")}


def _spelt(action):
    """As it is typed: ``--lab NN, -o FILE``; an argument by its name."""
    metavar = action.metavar or (f"{{{','.join(map(str, action.choices))}}}" if action.choices else action.dest.upper())
    if not action.option_strings:
        return metavar
    value = "" if action.nargs == 0 else f" {metavar}"
    return ", ".join(f"{one}{value}" for one in action.option_strings)


def examples(name, most=3):
    """The longest different lines of the documents that run a command, from their blocks, or else from their sentences."""
    pages = [ROOT / "README.md", *(path for folder in FOLDERS for path in sorted((ROOT / "docs" / folder).glob("*.md")))]
    text = "\n".join(path.read_text("utf-8") for path in pages)
    blocks = "\n".join(re.findall(r"^ *```sh\n(.*?)^ *```", text, re.M | re.S))
    in_blocks = re.findall(rf"^ *(?:\S+/)?(hapticlab {name}(?: [^#\n]*)?)(?:#.*)?$", blocks, re.M)
    in_sentences = re.findall(rf"`(hapticlab {name}(?: [^`\n]*)?)`", text)
    found = dict.fromkeys(" ".join(line.split()) for line in in_blocks or in_sentences)
    return sorted(found, key=len)[-most:]


def _exits():
    rows = "\n".join(f"| {code} | {words} |" for code, words in EXITS.items())
    return f"\n(exit-codes)=\n## Exit codes\n\n| code | what it means |\n| --- | --- |\n{rows}\n"
