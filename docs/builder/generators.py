"""What writes pages: each function gets the folder of the copied sources and writes Markdown, or HTML for ``live/``, into it."""

from . import from_the_root, gallery, glossary, lab_pages, licences, sections

#: called in this order, before the examples run; a later one may read what an earlier one wrote
GENERATORS = (
    from_the_root.write,
    glossary.write,
    licences.write,
    sections.write,
)
#: called after these with ``quick=``, in which they run one scene and no lab
LONG = (gallery.write, lab_pages.write)
