"""The first page of each folder lists the folder's pages, with the question that ``docs/README.md`` says each answers."""

import re

ROW = re.compile(r"^\| \[([\w./]+)\]\(\1\) \| (.+) \|$", re.M)
TITLE = re.compile(r"^# (.+)$", re.M)


def write(source):
    """Add to the ``index.md`` of each folder those pages that its own contents do not list, in the order of the list."""
    listed = {}
    for page, question in ROW.findall((source / "README.md").read_text("utf-8")):
        folder, _, name = page.rpartition("/")
        if folder:
            listed.setdefault(folder, []).append((name, _title(source / page), question))
    for folder, pages in listed.items():
        index = source / folder / "index.md"
        text = index.read_text("utf-8") if index.is_file() else None
        if text and (left := [page for page in pages if page[0].removesuffix(".md") not in text.splitlines()]):
            own, mark, others = text.partition("```{toctree}")
            index.write_text(f"{own.rstrip()}\n\n{contents(left)}\n{mark}{others}", "utf-8")


def contents(pages):
    """Return the table of pages, (file, title, question) of each, and their place in the navigation.

    Examples
    --------
    >>> print(contents([("live.md", "The live paddle", "How do I feel a scene?")]))
    | page | what it answers |
    | --- | --- |
    | [The live paddle](live.md) | How do I feel a scene? |
    <BLANKLINE>
    ```{toctree}
    :hidden:
    <BLANKLINE>
    live
    ```
    <BLANKLINE>
    """
    rows = [f"| [{title}]({name}) | {question} |" for name, title, question in pages]
    names = [name.removesuffix(".md") for name, _, _ in pages]
    return "\n".join(
        ["| page | what it answers |", "| --- | --- |", *rows, "", "```{toctree}", ":hidden:", "", *names, "```", ""]
    )


def _title(path):
    return TITLE.search(path.read_text("utf-8"))[1]
