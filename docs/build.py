"""Build the site of the documentation: ``python docs/build.py FOLDER`` (``-h`` lists the options)."""

import sys

try:
    from builder.command import main
except ModuleNotFoundError as missing:
    sys.exit(f'{missing.name} is not installed; do: {sys.executable} -m pip install -e ".[docs]"')

if __name__ == "__main__":
    sys.exit(main())
