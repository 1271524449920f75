"""`python -m hapticlab` is the command line."""

import sys

# Python put the working folder first on its import path, unless it was started with -P. What lies there, such as a file
# random.py that a student handed in, is not to be imported, except where hapticlab itself is there, in a checkout.
if not sys.flags.safe_path and sys.path[0] != __file__.rpartition("hapticlab")[0][:-1]:
    del sys.path[0]

from .cli.main import main

sys.exit(main())
