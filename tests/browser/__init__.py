"""A package, so that one Chromium lasts as long as the tests of this folder: conftest.py."""
