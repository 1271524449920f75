"""The reference: a page for every namespace and one for every public name, at the path by which a user finds it."""

from . import uses
from .public_names import NAMESPACES, PAGES, Name, is_property, module_of, names_of, own_names

BLOCK = "```{{eval-rst}}\n{}\n```\n"
#: a constant that prints no more than this says nothing that its page does not say
SHORT = 30


def write(source):
    """Write all pages into the copied source."""
    exists = _exists_in(source)
    for address, text in pages(exists):
        path = source / f"{address}.md"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")


def _exists_in(source):
    return lambda address: (source / f"{address}.md").is_file()


def pages(exists=lambda address: True):
    """Yield ``(address, text)`` of every page of the reference."""
    names = {name.path: name for name in own_names()}
    yield "reference/index", index(exists)
    for namespace in NAMESPACES:
        yield f"reference/{namespace}", namespace_page(namespace, names)
    for name in names.values():
        yield name.document, name_page(name, exists)


#: what the reference holds besides names: page, title, what it answers
BESIDES = (
    ("reference/commands", "Commands", "What does each command do, which options has it, how does it end?"),
    ("reference/doctor", "Steps of the doctor", "What does `hapticlab doctor` check, what can it say, and what do I do?"),
    ("paddle/faults", "Faults of a board", "Why did the board switch the motor off, and what do I do?"),
    ("reference/chapter", "The chapter", "Which function, lab and test holds which equation and which figure?"),
    ("reference/papers", "Papers", "Which function, lab and test is after which paper?"),
    ("reference/glossary", "Glossary", "What does this word mean?"),
)


def index(exists):
    """The first page of the reference."""
    rows = [f"| [hl.{page}]({page}.md) | {_first_sentence(module_of(page))} |" for page in PAGES]
    there = [row for row in BESIDES if exists(row[0])]
    besides = [f"| [{title}](../{address}.md) | {question} |" for address, title, question in there]
    inside = [address.removeprefix("reference/") for address, *_ in there if address.startswith("reference/")]
    tree = "\n".join(["```{toctree}", ":hidden:", ":maxdepth: 1", "", *NAMESPACES, *inside, "```"])
    return "\n".join([
        "# Reference", "",
        "Every public name has a page of its own: its signature, units, ranges, errors, equation, an example with its output,",
        "and where it is used. `hl.find(\"a word\")` searches the same names in Python.", "",
        "| namespace | what it holds |", "| --- | --- |",
        f"| [hl](hl.md) | {_first_sentence(module_of('hl'))} |", *rows, "",
        "| page | what it answers |", "| --- | --- |", *besides, "", tree, "",
    ])  # fmt: skip


def _first_sentence(module):
    return (module.__doc__ or "").strip().partition("\n")[0].replace("|", "\\|")


def namespace_page(namespace, names):
    """The page of a namespace: what its module says, and a table of its names."""
    title = "hl" if namespace == "hl" else f"hl.{namespace}"
    module = module_of(namespace)
    by_value = {id(name.value): name for name in names.values()}
    rows, documents = [], []
    for short in names_of(namespace):
        name = names.get(Name(namespace, short, None).path) or by_value[id(getattr(module, short))]
        rows += [f"   * - :py:obj:`{short} <{name.path}>`", f"     - {name.first_line}"]
        if name.namespace == namespace:
            documents.append(name.document.removeprefix("reference/"))
    table = "\n".join([".. list-table::", "   :widths: 25 75", "   :class: names", "", *rows])
    tree = "\n".join(["```{toctree}", ":hidden:", "", *documents, "```"])
    about = BLOCK.format(f".. automodule:: {module.__name__}\n   :no-members:")
    return "\n".join([f"# {title}", "", about, "## Names", "", BLOCK.format(table), tree, ""])


def name_page(name, exists):
    """The page of one public name."""
    parts = [f"# {name.typed}", "", BLOCK.format(described(name))]
    if name.is_object and len(str(name.value)) > SHORT:
        parts += ["It prints as:", "", f"```text\n{name.value}\n```", ""]
    if used := [*_equations(name), *uses.links(uses.uses_of(name), name.document, exists)]:
        parts += ["## Where it is used", "", *used, ""]
    return "\n".join(parts)


def described(name):
    """What describes a name to Sphinx, in reStructuredText."""
    if name.is_object:
        words = [f"   {line}" for line in name.doc.splitlines()]
        return "\n".join([f".. py:data:: {name.path}", f"   :type: {type(name.value).__name__}", "", *words])
    lines = [f".. auto{'class' if name.is_class else 'function'}:: {name.path}"]
    for short, member in name.members.items():
        lines += ["", f"   .. auto{'property' if is_property(member) else 'method'}:: {name.path}.{short}"]
    return "\n".join(lines)


def _equations(name):
    """Yield a line on the equations and figures that the docstrings of a name and its members cite."""
    text = uses.docstrings(name)
    cited = [f"[Eq. (23.{one})](../chapter.md#eq-23-{one})" for one in sorted(text.equations)]
    cited += [f"[Fig. 23.{one}](../chapter.md#fig-23-{one})" for one in sorted(text.figures)]
    if cited:
        yield f"- Chapter: {', '.join(cited)}"
