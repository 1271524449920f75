"""What an owner of a paddle reads: the pages of docs/paddle, which come with the package."""

import webbrowser
from pathlib import Path

from ..base.in_notebook import is_in_browser
from ..errors import PaddleError

PACKAGE = Path(__file__).resolve().parents[1]
#: of a wheel, and of a checkout
PLACES = (PACKAGE / "docs", PACKAGE.parent / "docs" / "paddle")


def guide(parser, options):
    """Print where a page is, and open it if asked."""
    page = next((found for place in PLACES if (found := place / options.pages[options.page]).is_file()), None)
    if page is None:
        raise PaddleError(f"{options.pages[options.page]} did not come with this hapticlab; install hapticlab again")
    print(page)
    if options.open and is_in_browser():
        raise PaddleError("Python in a browser opens no other program; read the page in a cell: print(open(PATH).read())")
    if options.open and not webbrowser.open(page.as_uri()):
        raise PaddleError("this computer has no program that opens it; read the file with an editor")
    return 0
