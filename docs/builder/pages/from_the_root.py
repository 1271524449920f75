"""Pages of the site that stand at the root of the repository, where readers of the repository look for them."""

import os
import re
from pathlib import Path, PurePosixPath

ROOT = Path(__file__).resolve().parents[3]
#: file of the repository -> page of the site
PAGES = {"CHANGELOG.md": "project/changelog.md", "CONTRIBUTING.md": "project/contributing.md"}
LINK = re.compile(r"\]\(([^)#\s:]+\.\w+)(#[^)\s]*)?\)")


def write(source):
    """Write these pages, and lead the links of all others to them."""
    for file, page in PAGES.items():
        (source / page).parent.mkdir(exist_ok=True)
        (source / page).write_text(relinked((ROOT / file).read_text("utf-8"), page, stood=file), "utf-8")
    for path in source.rglob("*.md"):
        page, text = path.relative_to(source).as_posix(), path.read_text("utf-8")
        if page not in PAGES.values() and (found := relinked(text, page, stood=f"docs/{page}")) != text:
            path.write_text(found, "utf-8")


def relinked(text, page, stood):
    """Return the text of a page whose links to files beyond or inside docs/ lead to pages of the site.

    Examples
    --------
    >>> relinked("[how](../../CONTRIBUTING.md#words)", "how_to/browser.md", stood="docs/how_to/browser.md")
    '[how](../project/contributing.md#words)'
    >>> relinked("[safety](docs/paddle/SAFETY.md)", "project/contributing.md", stood="CONTRIBUTING.md")
    '[safety](../paddle/SAFETY.md)'
    """

    def there(found):
        file = os.path.normpath(PurePosixPath(stood).parent / found[1])
        target = PAGES.get(file) or (file.removeprefix("docs/") if file.startswith("docs/") else None)
        return found[0] if target is None else f"]({os.path.relpath(target, PurePosixPath(page).parent)}{found[2] or ''})"

    return LINK.sub(there, text)
