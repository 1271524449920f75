"""Sphinx's settings; ``whole.py`` hands the folder of sources over."""

from pathlib import Path

import hapticlab
from builder.pages.public_names import classes

project = "hapticlab"
author = "the hapticlab developers"
project_copyright = author
version = release = hapticlab.__version__

extensions = [
    "myst_parser", "sphinx.ext.autodoc", "sphinx.ext.mathjax", "numpydoc", "sphinx_design", "sphinx_copybutton", "builder.hooks",
    "builder.sphinx_names",
]  # fmt: skip
source_suffix = {".md": "markdown"}
root_doc = "index"
# README lists the pages for readers of the repository; the builder and the pictures of pages are no pages
exclude_patterns = ["README.md", "builder", "live", "build.py"]
nitpicky = True
smartquotes = False  # x'' is a second derivative
python_maximum_signature_line_length = 88
language = "en_GB"

myst_enable_extensions = ["colon_fence", "deflist", "dollarmath", "amsmath"]
myst_heading_anchors = 4  # a link names a heading as GitHub does
myst_dmath_double_inline = True
autosummary_generate = False  # the reference writes its pages itself
numpydoc_xref_param_type, numpydoc_xref_ignore = True, "all"  # only these become links
numpydoc_xref_aliases = classes()
numpydoc_show_class_members = False  # the reference says which members a class has
mathjax_path = "tex-svg.js"  # copied from the wheel sphinx-mathjax-offline, with its glyphs inside
mathjax3_config = {"options": {"enableMenu": False}}  # the menu would load its parts from an address that the site lacks
copybutton_selector = "div.highlight-python pre, div.highlight-py pre, div.highlight-sh pre, div.highlight-powershell pre"

html_theme = "pydata_sphinx_theme"
html_title = "hapticlab"
html_favicon = "static/favicon.svg"
html_static_path = ["static"]
html_extra_path = ["extra"]  # for addresses without a page
templates_path = ["templates"]
html_css_files = ["site.css"]
html_search_scorer = str(Path(__file__).parent / "static/search.js")
html_js_files = [("site.js", {"defer": "defer"}), "frames.js"]
html_context = {"default_mode": "auto"}  # as the reader's system has it
html_copy_source = html_show_sourcelink = False
html_show_sphinx = False
html_sidebars: dict[str, list[str]] = {"index": []}
html_theme_options = {
    "logo": {"text": "hapticlab"},
    "header_links_before_dropdown": 9,
    "navigation_with_keys": False,
    "collapse_navigation": True,  # of other sections the side bar shows nothing, which halves the pages
    "show_toc_level": 2,
    "footer_start": ["copyright"],
    "footer_end": ["licences"],
}
html_last_updated_fmt = None
