"""The public names: what each is, which members it has, and the addresses of all of them and of their arguments."""

import inspect
from dataclasses import dataclass
from functools import cached_property
from importlib import import_module

import sympy as sp

from hapticlab.vocabulary import PAGES, SAYS

#: ``hl`` itself, and every page of names in it
NAMESPACES = ("hl", *PAGES)


@dataclass(frozen=True)
class Name:
    """One public name: where a user finds it, and what it stands for."""

    namespace: str
    short: str
    value: object

    @property
    def path(self):
        """As it is imported: ``hapticlab.design.coupler``; also its target in Sphinx."""
        return ".".join(["hapticlab", *([] if self.namespace == "hl" else [self.namespace]), self.short])

    @property
    def typed(self):
        """As a user types it: ``hl.design.coupler``."""
        return self.path.replace("hapticlab", "hl", 1)

    @property
    def is_class(self):
        """Whether it is a class that a page shows with its members; a class of SymPy's is written like a function."""
        return inspect.isclass(self.value)

    @property
    def is_object(self):
        """Whether it is neither class nor function, but a record or a symbol."""
        return not (self.is_class or inspect.isroutine(self.value))

    @property
    def document(self):
        """The page of the name in the documents, without its ending; no two differ by capitals alone, as some disks ask."""
        rivals = [one for one in names_of(self.namespace) if one.lower() == self.short.lower()]
        capital = "capital_" if len(rivals) > 1 and not self.short.islower() else ""
        return f"reference/{self.namespace}/{capital}{self.short}"

    @property
    def doc(self):
        """What it says of itself: its docstring, or the line that ``hl.find`` shows of an object that can carry none."""
        return SAYS.get(self.typed) or inspect.getdoc(self.value) or ""

    @property
    def first_line(self):
        """The first line of what it says of itself."""
        return self.doc.partition("\n")[0]

    @cached_property
    def members(self):
        """Methods and properties of a class that are hapticlab's own, by name; private ones and SymPy's hooks are left out."""
        if not self.is_class or issubclass(self.value, sp.Basic | sp.core.function.FunctionClass):
            return {}
        found = {name: inspect.getattr_static(self.value, name) for name in dir(self.value) if not name.startswith("_")}
        return {name: member for name, member in found.items() if _is_documented(member)}


def _is_documented(member):
    function = member.fget if isinstance(member, property) else getattr(member, "func", None) or inspect.unwrap(_plain(member))
    return inspect.isfunction(function) and (function.__module__ or "").startswith("hapticlab")


def is_property(member):
    """Whether a member of a class is read, not called."""
    return isinstance(member, property | cached_property)


def _plain(member):
    return member.__func__ if isinstance(member, classmethod | staticmethod) else member


def module_of(namespace):
    """The module of a namespace."""
    return import_module("hapticlab" if namespace == "hl" else f"hapticlab.{namespace}")


def names_of(namespace):
    """The short names of a namespace, without the pages in ``hl`` itself."""
    return [name for name in module_of(namespace).__all__ if namespace != "hl" or name not in PAGES]


def own_names():
    """Yield every public name, once; what stands in ``hl`` and on a page is that of ``hl``."""
    seen = set()
    for namespace in NAMESPACES:
        for short in names_of(namespace):
            name = Name(namespace, short, getattr(module_of(namespace), short))
            if namespace == "hl" or id(name.value) not in seen:
                yield name
            if namespace == "hl":
                seen.add(id(name.value))


def callables(name):
    """Yield ``(path, function or class)`` of a name and its methods: all that take arguments."""
    if not name.is_object:
        yield name.path, name.value
    for short, member in name.members.items():
        if not is_property(member):
            yield f"{name.path}.{short}", _plain(member)


def classes():
    """Name of a public class, as docstrings say it of an argument, and its path; names of two are left out."""
    found = [(name.short, name.path) for name in own_names() if name.is_class and name.short[0].isupper()]
    once = {short for short, _ in found if [one for one, _ in found].count(short) == 1}
    return {short: path for short, path in found if short in once}
