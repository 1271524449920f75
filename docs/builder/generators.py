"""What writes pages: each function gets the folder of the copied sources and writes Markdown, or HTML for ``live/``, into it."""

from .pages import (
    chapter,
    commands,
    cross_links,
    doctor,
    from_the_root,
    gallery,
    glossary,
    lab_pages,
    licences,
    papers,
    reference,
    sections,
)

#: called in this order, before the examples run; a later one may read what an earlier one wrote
GENERATORS = (
    from_the_root.write,
    licences.write,
)
#: called after these with ``quick=``, in which they run one scene and no lab
LONG = (gallery.write, lab_pages.write)
#: called last, since they link only pages that are there
INDEXES = (
    commands.write,
    doctor.write,
    chapter.write,
    papers.write,
    reference.write,
    glossary.write,
    cross_links.write,
    sections.write,
)
