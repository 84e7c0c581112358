"""Tests of the Python package, which DELRAY_PYTHON_PATH holds as it was built."""

import os
import sys

import numpy as np
import pytest

if "DELRAY_PYTHON_PATH" in os.environ:
    sys.path.insert(0, os.environ["DELRAY_PYTHON_PATH"])

SEED = 20261127


@pytest.fixture
def random():
    print("seed", SEED)
    return np.random.default_rng(SEED)


def as_set(simplices):
    """Simplices without order, of themselves and of their corners."""
    rows = np.sort(np.asarray(simplices), axis=1)
    return rows[np.lexsort(rows.T[::-1])]
