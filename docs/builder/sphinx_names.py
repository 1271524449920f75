"""What Sphinx needs for the pages of names: anchors of arguments, and where a reference in a docstring leads."""

import inspect
from functools import cache
from importlib import import_module

from docutils import nodes
from sphinx import addnodes

from .arguments import set_anchors
from .pages.public_names import own_names


def setup(app):
    """Sphinx calls this; it is named in the ``extensions`` of conf.py."""
    app.connect("config-inited", link_own_classes_alone, priority=900)  # after numpydoc's own
    app.connect("doctree-read", set_anchors)
    app.connect("doctree-read", name_neighbours)
    app.connect("missing-reference", resolve)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def link_own_classes_alone(_app, config):
    """Take from numpydoc the links of types that lead to the documents of Python, which are elsewhere."""
    config.numpydoc_xref_aliases_complete = config.numpydoc_xref_aliases


def resolve(app, env, node, contnode):
    """Lead a reference to where its name is documented: docstrings name things by where they are defined.

    What is not hapticlab's, and an annotation that no page documents, stays text. Every other reference is a warning.
    """
    if node.get("refdomain") != "py":
        return None
    target = node["reftarget"].rpartition(" ")[2]
    if path := _documented().get(target):
        node["reftarget"] = path
        if contnode.astext() == target:
            contnode = nodes.literal(path.rpartition(".")[2], path.rpartition(".")[2], classes=contnode["classes"])
        return env.domains["py"].resolve_xref(env, node["refdoc"], app.builder, "obj", path, node, contnode)
    return contnode if _is_outside(target) or _in_signature(node) else None


def name_neighbours(app, doctree):
    """In a signature, a name is that of its own namespace, where there are two: ``Task`` in ``hl.people``."""
    for signature in doctree.findall(addnodes.desc_signature):
        for node in signature.findall(addnodes.pending_xref):
            near = f"{signature.get('module')}.{node['reftarget']}"
            node["reftarget"] = _documented().get(near, node["reftarget"])


@cache
def _documented():
    """Every way in which a docstring may name what is public, and its path: ``Hand``, ``hapticlab.device.hand.hand.Hand``."""
    known = {}
    for name in own_names():
        defined, own = getattr(name.value, "__module__", ""), getattr(name.value, "__qualname__", name.short)
        for short, path in [("", name.path), *((f".{one}", f"{name.path}.{one}") for one in name.members)]:
            for spelt in (f"{defined}.{own}{short}", f"{own}{short}", f"{name.short}{short}", f"{name.typed}{short}", path):
                known.setdefault(spelt, path)
    return known


def _in_signature(node):
    while node is not None and not isinstance(node, addnodes.desc_signature):
        node = node.parent
    return node is not None


@cache
def _is_outside(target):
    """Whether a name is that of another package, or Python's own."""
    module, _, attribute = target.rpartition(".")
    if target.startswith("hapticlab"):
        return False
    try:
        return hasattr(import_module(module or "builtins"), attribute) or inspect.ismodule(import_module(target))
    except ImportError:
        return False
