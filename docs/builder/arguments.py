"""The arguments of what is public: in the signature, in the docstring, and the anchor of each on its page."""

import inspect
from typing import get_overloads

from docutils import nodes
from numpydoc.docscrape import NumpyDocString
from sphinx import addnodes

#: sections of a docstring whose entries get anchors; of a class, attributes are described where its arguments are
SECTIONS = ("Parameters", "Other Parameters", "Attributes")


def in_signature(value):
    """Names of the arguments that a call takes, without ``self``; none for what has no signature, as SymPy's classes."""
    try:
        signatures = [inspect.signature(one) for one in get_overloads(value) or [value]]
    except (TypeError, ValueError, AttributeError):
        return []
    named = [one for one in signatures if len(signatures) == 1] or [_without_positional(one) for one in signatures]
    every = dict.fromkeys(name for one in named for name in one.parameters)
    names = [name for name in every if name not in ("self", "cls") and not name.startswith("_")]
    return [] if inspect.isclass(value) and names == ["args", "kwargs"] else names


def _without_positional(signature):
    """Of one of several signatures, what a call may name: each calls its first argument what it is there."""
    kept = [one for one in signature.parameters.values() if one.kind is not inspect.Parameter.POSITIONAL_ONLY]
    return signature.replace(parameters=kept)


def in_docstring(value, sections=SECTIONS):
    """Names that the sections of a docstring describe."""
    described = NumpyDocString(inspect.getdoc(value) or "")
    return [name for section in sections for entry in described[section] for name in split(entry.name)]


def split(names):
    """Names that share one description: ``k, B, x_o``, ``**options``."""
    return [one.strip().lstrip("*").strip() for one in names.split(",")]


def anchor(path, argument):
    """The anchor of an argument on the page of its name: ``hapticlab.design.coupler.b_c``."""
    return f"{path}.{argument}"


def set_anchors(app, doctree):
    """Give every described argument of a page its anchor; Sphinx calls this for every page that it has read."""
    taken = {one for node in doctree.findall() if isinstance(node, nodes.Element) for one in node.get("ids", ())}
    for described in doctree.findall(addnodes.desc):
        path = next((one for sign in described.findall(addnodes.desc_signature) for one in sign["ids"]), None)
        for field in _fields(described) if path else ():
            for term in field.findall(nodes.term):
                wanted = [anchor(path, one) for one in split(_named(term))]
                term["ids"] += [one for one in wanted if one not in taken and not taken.add(one)]


def _fields(described):
    """Yield the lists of arguments of a description, without those of the descriptions inside it."""
    for field in described.findall(nodes.field):
        inside = field.parent
        while not isinstance(inside, addnodes.desc):
            inside = inside.parent
        if inside is described and field[0].astext() in SECTIONS:
            yield field


def _named(term):
    strong = next(term.findall(nodes.strong), None)
    return strong.astext() if strong else term.astext().partition(" : ")[0]
