"""A site of the labs that needs nothing but a browser: JupyterLite, Pyodide, the labs, and pages beside them.

In: an installed hapticlab and its packages, perhaps a distribution of Pyodide. Out: a folder for any web server.
Read ``build`` first, then ``needs`` and ``wheels``, ``pyodide_archive``, ``lite``, ``pages`` and ``front_page``, and
``licences``.
"""
