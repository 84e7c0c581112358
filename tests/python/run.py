"""Runs pytest on the files that are given; ends with 77 where what the tests need is not installed."""

import importlib.util
import sys

missing = [m for m in ("pytest", "scipy", "matplotlib") if importlib.util.find_spec(m) is None]
if missing:
    print("skipped: no", ", ".join(missing))
    sys.exit(77)

import pytest

sys.exit(pytest.main(["-q", "-p", "no:cacheprovider", *sys.argv[1:]]))
