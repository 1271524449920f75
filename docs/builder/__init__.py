"""The builder of the site: Markdown of ``docs/`` and everything that the package says of itself come in, HTML goes out.

Read ``whole.py`` first, which takes every step; then ``generators.py``, the list of what writes pages, and ``examples.py``, which
runs the code of the pages. ``conf.py`` and ``hooks.py`` are Sphinx's, and ``check.py`` looks through what Sphinx wrote.
"""
