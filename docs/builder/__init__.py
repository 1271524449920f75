"""The builder of the site: Markdown of ``docs/`` and everything that the package says of itself come in, HTML goes out.

Read ``whole.py`` first, which takes every step; then ``generators.py``, the list of what in ``pages/`` writes pages, and
``running/examples.py``, which runs the code of the pages. ``conf.py``, ``hooks.py`` and ``sphinx_names.py`` are Sphinx's, and
``check.py`` looks through what Sphinx wrote.
"""
