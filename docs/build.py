"""Build the site of the documentation: ``python docs/build.py FOLDER`` (``-h`` lists the options)."""

import sys

from builder.command import main

if __name__ == "__main__":
    sys.exit(main())
