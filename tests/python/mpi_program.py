"""Under mpirun: compositing and rendering over a communicator of mpi4py that is a split one."""

import os
import sys

sys.path.insert(0, os.environ["DELRAY_PYTHON_PATH"])

import delray
import numpy as np
from mpi4py import MPI

world = MPI.COMM_WORLD
half = world.Split(world.rank % 2, -world.rank)
ranks = delray.Communicator(half)
assert (ranks.rank, ranks.size) == (half.rank, half.size)

random = np.random.default_rng(1)
depths = random.random((half.size, 20, 30)).astype(np.float32)
depths[random.random(depths.shape) < 0.3] = np.inf
images = random.integers(0, 256, (half.size, 20, 30, 4), np.uint8)
images[..., 3] = 255
images[np.isinf(depths)] = 0
nearest = np.argmin(depths, axis=0)
expected = np.take_along_axis(images, nearest[None, ..., None], 0)[0]
root = half.size - 1
for scheme in delray.schemes():
    made = delray.compose(images[half.rank], depths[half.rank], comm=ranks, scheme=scheme, root=root)
    assert (made is not None) == (half.rank == root)
    if made is not None:
        rgba, depth = made
        assert (rgba == expected).all() and (depth == depths.min(axis=0)).all(), scheme

# Layers over each other, of floats; and a communicator as mpi4py has it.
layers = np.zeros((half.size, 4, 4, 4), np.float32)
layers[..., :] = [0.25, 0, 0, 0.5]
made = delray.compose(layers[half.rank], comm=half)
if half.rank == 0:
    assert np.allclose(made[0][..., 3], 1 - 0.5**half.size) and made[1] is None

for wrong in (dict(scheme="fastest"), dict(root=99), dict(codec="zip")):
    try:
        delray.compose(images[half.rank], depths[half.rank], comm=ranks, **wrong)
    except ValueError as error:
        assert str(list(wrong.values())[0]) in str(error)
    else:
        raise AssertionError(wrong)

picture = delray.render("gen:spheres:500", size=(64, 48), comm=ranks, threads=1)
assert (picture is not None) == (half.rank == 0)
if picture is not None:
    assert picture.hash == delray.render("gen:spheres:500", size=(64, 48), threads=1).hash
