"""delray.Delaunay against scipy.spatial.Delaunay and Matplotlib's, and where Qhull fails."""

import gc
import itertools
import os
import signal
import threading
import time

import delray
import numpy as np
import pytest
import scipy.spatial
from conftest import as_set
from matplotlib.tri import Triangulation

CLOUDS = [(2, 3), (2, 50), (2, 2000), (3, 4), (3, 60), (3, 700)]


@pytest.mark.parametrize("dim, n", CLOUDS)
def test_simplices_are_scipys_in_general_position(random, dim, n):
    points = random.random((n, dim))
    ours, scipys = delray.Delaunay(points), scipy.spatial.Delaunay(points)
    assert (as_set(ours.simplices) == as_set(scipys.simplices)).all()
    assert ours.simplices.dtype == scipys.simplices.dtype
    assert (as_set(ours.convex_hull) == as_set(scipys.convex_hull)).all()


def test_simplices_are_matplotlibs(random):
    points = random.random((500, 2))
    theirs = Triangulation(points[:, 0], points[:, 1])
    assert (as_set(delray.Delaunay(points).simplices) == as_set(theirs.triangles)).all()
    # And Matplotlib takes ours.
    ours = Triangulation(points[:, 0], points[:, 1], delray.Delaunay(points).simplices)
    assert ours.neighbors.shape == theirs.neighbors.shape


@pytest.mark.parametrize("dim, n", CLOUDS)
def test_attributes_agree_with_scipys(random, dim, n):
    points = random.random((n, dim)) * 7 - 2
    ours, scipys = delray.Delaunay(points), scipy.spatial.Delaunay(points)
    for name in ("ndim", "npoints", "nsimplex", "min_bound", "max_bound", "furthest_site"):
        assert np.all(getattr(ours, name) == getattr(scipys, name)), name
    for name in ("simplices", "neighbors", "convex_hull", "coplanar", "vertex_to_simplex"):
        assert getattr(ours, name).dtype == np.int32, name
        assert getattr(ours, name).shape == getattr(scipys, name).shape, name
    for name in ("transform", "equations"):
        assert getattr(ours, name).shape == getattr(scipys, name).shape, name
    # Neighbour k is opposite to corner k.
    s, neighbors = ours.simplices, ours.neighbors
    for i, k in itertools.product(range(min(len(s), 100)), range(dim + 1)):
        shared = set(np.delete(s[i], k))
        if neighbors[i, k] >= 0:
            assert shared < set(s[neighbors[i, k]]) and s[i, k] not in s[neighbors[i, k]]
        else:
            assert any(shared == set(f) for f in ours.convex_hull)
    # Each point is a corner of the simplex that the table says.
    assert (ours.simplices[ours.vertex_to_simplex] == np.arange(n)[:, None]).any(axis=1).all()
    # Rows of neighbours, in whatever order.
    (begin, rows), (begin2, rows2) = ours.vertex_neighbor_vertices, scipys.vertex_neighbor_vertices
    for i in range(n):
        theirs = rows2[begin2[i] : begin2[i + 1]]
        assert sorted(rows[begin[i] : begin[i + 1]]) == sorted(theirs)


@pytest.mark.parametrize("dim", [2, 3])
def test_simplices_are_positively_oriented(random, dim):
    mesh = delray.Delaunay(random.random((100, dim)))
    corners = mesh.points[mesh.simplices]
    assert (np.linalg.det(corners[:, 1:] - corners[:, :1]) > 0).all()


@pytest.mark.parametrize("dim", [2, 3])
def test_transform_gives_barycentric_coordinates(random, dim):
    mesh = delray.Delaunay(random.random((80, dim)))
    xi = random.random((300, dim))
    at = mesh.find_simplex(xi)
    inside = at >= 0
    t = mesh.transform[at[inside]]
    c = np.einsum("ijk,ik->ij", t[:, :dim], xi[inside] - t[:, dim])
    c = np.column_stack((c, 1 - c.sum(axis=1)))
    assert (c > -1e-9).all()
    back = (c[:, :, None] * mesh.points[mesh.simplices[at[inside]]]).sum(axis=1)
    assert np.allclose(back, xi[inside], atol=1e-9)


@pytest.mark.parametrize("dim", [2, 3])
def test_find_simplex_is_scipys(random, dim):
    points = random.random((200, dim))
    ours, scipys = delray.Delaunay(points), scipy.spatial.Delaunay(points)
    xi = random.random((40, 50, dim)) * 1.2 - 0.1
    a, b = ours.find_simplex(xi), scipys.find_simplex(xi)
    assert a.shape == b.shape and a.dtype == b.dtype
    assert ((a < 0) == (b < 0)).all()
    inside = a >= 0
    assert (np.sort(ours.simplices[a[inside]]) == np.sort(scipys.simplices[b[inside]])).all()
    assert ours.find_simplex(points[0]).shape == ()
    assert (ours.find_simplex(points) >= 0).all()  # boundaries belong


@pytest.mark.parametrize("dim", [2, 3])
def test_equations_are_of_planes_below_the_other_points(random, dim):
    mesh = delray.Delaunay(random.random((60, dim)))
    distance = mesh.plane_distance(mesh.points)
    assert distance.shape == (60, mesh.nsimplex)
    assert distance.max() < 1e-9
    for i, corners in enumerate(mesh.simplices):
        assert np.abs(distance[corners, i]).max() < 1e-9
    assert np.allclose((mesh.equations[:, :-1] ** 2).sum(axis=1), 1)


def lattice(dim, side):
    return np.stack(np.meshgrid(*[np.arange(side)] * dim), axis=-1).reshape(-1, dim).astype(float)


def circle(n):
    angles = np.arange(n) * (2 * np.pi / n)
    return np.column_stack((np.cos(angles), np.sin(angles)))


HARD = {
    "lattice": lattice(2, 20),
    "lattice in space": lattice(3, 7),
    "sheared lattice": lattice(2, 12) @ [[1, 0.1], [0, 1]],
    "duplicates": np.repeat(lattice(2, 6), 5, axis=0),
    "duplicates in space": np.tile(lattice(3, 4), (3, 1)),
    "circle": circle(100),
    "far away": lattice(2, 10) + 1e9,
    "an ulp apart": np.nextafter(lattice(2, 8), lattice(2, 8)[::-1]),
    "tiny": lattice(3, 4) * 1e-30,
}


@pytest.mark.parametrize("name", HARD)
def test_degenerate_points_are_triangulated_exactly(name):
    points = HARD[name]
    mesh = delray.Delaunay(points)
    verdict = delray.verify(mesh)
    assert verdict and verdict.valid and verdict.canonical, verdict.reason
    assert verdict.distinct == len(np.unique(points, axis=0))
    # Those that are no corner are duplicates of the row beside them, and nothing else.
    rows, simplices, same = mesh.coplanar.T
    assert (points[rows] == points[same]).all()
    assert (mesh.simplices[simplices] == same[:, None]).any(axis=1).all()
    assert len(rows) == len(points) - verdict.distinct
    assert (mesh.simplices[mesh.vertex_to_simplex[rows]] == same[:, None]).any(axis=1).all()


def test_qhull_gives_flat_or_missing_simplices_where_we_do_not():
    points = lattice(3, 7)
    theirs = scipy.spatial.Delaunay(points)
    corners = points[theirs.simplices]
    volumes = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / 6
    assert not delray.verify(points, theirs.simplices) or (volumes == 0).any()
    corners = points[delray.Delaunay(points).simplices]
    volumes = np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6
    assert (volumes > 0).all() and np.isclose(volumes.sum(), 6**3)


@pytest.mark.parametrize("dim", [2, 3])
def test_points_without_simplices_are_a_result(dim):
    for points in (np.zeros((0, dim)), np.zeros((5, dim)), np.arange(4.0)[:, None] * np.ones(dim)):
        mesh = delray.Delaunay(points)
        assert mesh.simplices.shape == (0, dim + 1) and mesh.neighbors.shape == (0, dim + 1)
        assert mesh.convex_hull.shape == (0, dim) and mesh.coplanar.shape == (0, 3)
        assert mesh.transform.shape == (0, dim + 1, dim)
        assert mesh.equations.shape == (0, dim + 2)
        assert (mesh.vertex_to_simplex == -1).all()
        assert (mesh.find_simplex(np.zeros((3, dim))) == -1).all()
        begin, rows = mesh.vertex_neighbor_vertices
        assert len(begin) == len(points) + 1 and len(rows) == 0


def test_arrays_of_any_layout_give_the_same(random):
    points = random.random((300, 2))
    wide = np.zeros((300, 5))
    wide[:, 1:3] = points
    spread = np.zeros((600, 2))
    spread[::2] = points
    expected = delray.Delaunay(points).simplices
    for same in (wide[:, 1:3], spread[::2], np.asfortranarray(points), points[::-1][::-1],
                 points.tolist(), points.astype(">f8")):
        assert (delray.Delaunay(same).simplices == expected).all()
    single = points.astype(np.float32)
    for same in (single, single.astype(float), np.asfortranarray(single)):
        assert (delray.Delaunay(same).simplices == delray.Delaunay(single).simplices).all()
    whole = np.round(points * 1000).astype(np.int16)
    assert (delray.Delaunay(whole).simplices == delray.Delaunay(whole.astype(float)).simplices).all()


def test_arrays_that_fit_are_not_copied(random):
    points = random.random((100, 2))
    wide = random.random((100, 7))
    assert np.shares_memory(delray.Delaunay(points).points, points)
    assert np.shares_memory(delray.Delaunay(wide[::3, 2:5]).points, wide)
    mesh = delray.Delaunay(points)
    assert mesh.simplices is mesh.simplices and not mesh.simplices.flags.writeable
    assert points.flags.writeable and not mesh.points.flags.writeable


def test_arrays_outlive_the_triangulation(random):
    points = random.random((1000, 2))
    simplices, neighbors = (lambda m: (m.simplices, m.neighbors))(delray.Delaunay(points.copy()))
    copies = simplices.copy(), neighbors.copy()
    gc.collect()
    [delray.Delaunay(points + i) for i in range(3)]
    assert (simplices == copies[0]).all() and (neighbors == copies[1]).all()


def test_three_columns_may_be_a_terrain(random):
    points = random.random((100, 3))
    flat = delray.Delaunay(points, dim=2)
    assert (flat.simplices == delray.Delaunay(points[:, :2]).simplices).all()
    assert flat.points.shape == (100, 3) and flat.find_simplex([0.5, 0.5]) >= 0
    assert delray.verify(flat) and flat.transform.shape == (flat.nsimplex, 3, 2)


@pytest.mark.parametrize("method", delray.methods())
def test_methods_give_the_same(method):
    dim = 3 if method == "cavity" else 2
    points = np.vstack((lattice(dim, 5), lattice(dim, 3) * 0.7))
    mesh = delray.triangulate(points, method=method, threads=2, statistics=True)
    assert mesh.hash == delray.Delaunay(points).hash
    assert set(mesh.statistics) == {"seconds", "sync"}


@pytest.mark.parametrize(
    "arguments, text",
    [
        (dict(points=np.zeros(3)), r"points: the shape is \(3,\), not \(n, 2 or 3\)"),
        (dict(points=np.zeros((3, 4))), r"points: the shape is \(3, 4\), not \(n, 2 or 3\)"),
        (dict(points=[[0, 0], [1, np.nan], [1, 1]]), "1"),
        (dict(points=[[0, 0], [np.inf, 1]]), "1"),
        (dict(points=[["a", "b"]]), "not of real numbers"),
        (dict(points=[[1j, 0]]), "not of real numbers"),
        (dict(points=[[0, 0]], dim=3), "three columns"),
        (dict(points=[[0, 0]], dim=4), "dim"),
        (dict(points=[[0, 0]], threads=0), "threads: 0 is not from 1 to"),
        (dict(points=[[0, 0]], method="best"), "best"),
        (dict(points=[[0, 0]], furthest_site=True), "furthest_site"),
    ],
)
def test_wrong_arguments_raise_value_errors(arguments, text):
    with pytest.raises(ValueError, match=text):
        delray.Delaunay(**arguments)


def test_wrong_places_raise_value_errors(random):
    mesh = delray.Delaunay(random.random((10, 2)))
    with pytest.raises(ValueError, match=r"xi: the shape is \(3,\), not \(\.\.\., 2\)"):
        mesh.find_simplex([1, 2, 3])
    with pytest.raises(ValueError, match="finite"):
        mesh.find_simplex([1, np.nan])
    with pytest.raises(TypeError):
        delray.Delaunay(random.random((10, 2)), colour="red")


def test_what_has_no_effect_is_warned_of(random):
    points = random.random((10, 2))
    with pytest.warns(UserWarning, match="qhull_options"):
        mesh = delray.Delaunay(points, qhull_options="QJ")
    with pytest.warns(UserWarning, match="tol"):
        mesh.find_simplex(points, tol=1e-9)


def test_points_are_added(random):
    points = random.random((60, 2))
    mesh = delray.Delaunay(points[:20], incremental=True)
    assert mesh.transform.shape[0] == mesh.nsimplex
    mesh.add_points(points[20:50])
    mesh.add_points(points[50:], restart=True)
    assert (mesh.simplices == delray.Delaunay(points).simplices).all()
    assert mesh.transform.shape[0] == mesh.neighbors.shape[0] == mesh.nsimplex
    mesh.close()
    with pytest.raises(RuntimeError):
        mesh.add_points(points)


def test_other_threads_run_meanwhile():
    points = np.random.default_rng(1).random((200000, 2))
    ticks, done = [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.001)

    ticker = threading.Thread(target=tick)
    ticker.start()
    begin = time.perf_counter()
    delray.Delaunay(points, threads=1)
    end = time.perf_counter()
    done.set()
    ticker.join()
    assert sum(begin < t < end for t in ticks) >= 3


def test_interrupt_ends_a_triangulation():
    points = np.random.default_rng(1).random((500000, 3))
    # As Ctrl-C: to the main thread, while it triangulates.
    sender = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
    sender.start()
    with pytest.raises(KeyboardInterrupt):
        for _ in range(1000):
            delray.Delaunay(points, threads=1)
    sender.join()
    assert delray.Delaunay(points[:100]).nsimplex > 0
