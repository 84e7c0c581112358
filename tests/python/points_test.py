"""Functions of points: against SciPy's where there are such, and against what they promise."""

import threading

import delray
import numpy as np
import pytest
import scipy.interpolate
import scipy.spatial
from conftest import as_set


@pytest.mark.parametrize("dim", [2, 3])
def test_linear_interpolation_is_griddata(random, dim):
    points, values = random.random((150, dim)), random.random(150)
    xi = random.random((20, 30, dim)) * 1.2 - 0.1
    ours = delray.interpolate(points, values, xi)
    theirs = scipy.interpolate.griddata(points, values, xi)
    assert ours.shape == theirs.shape
    assert (np.isnan(ours) == np.isnan(theirs)).all()
    assert np.allclose(ours, theirs, equal_nan=True, atol=1e-9)


def test_values_may_have_axes(random):
    points, values = random.random((50, 2)), random.random((50, 2, 3))
    mesh = delray.Delaunay(points)
    xi = random.random((7, 2)) * 0.2 + 0.4
    ours = delray.interpolate(mesh, values, xi, fill_value=-1)
    assert ours.shape == (7, 2, 3)
    assert np.allclose(ours[:, 1, 2], delray.interpolate(mesh, values[:, 1, 2], xi))
    assert delray.interpolate(mesh, values[:, 0, 0], [9, 9], fill_value=-1) == -1


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("method", ["linear", "natural"])
def test_linear_functions_are_reproduced(random, dim, method):
    points = random.random((60, dim))
    direction = random.random(dim)
    xi = random.random((80, dim)) * 0.4 + 0.3
    ours = delray.interpolate(points, points @ direction + 2, xi, method)
    assert np.allclose(ours, xi @ direction + 2, atol=1e-8)
    at_points = delray.interpolate(points, np.arange(60.0), points, method)
    assert np.allclose(at_points, np.arange(60.0))


def test_interpolation_refuses(random):
    points = random.random((10, 2))
    with pytest.raises(ValueError, match="method"):
        delray.interpolate(points, np.zeros(10), points, "cubic")
    with pytest.raises(ValueError, match=r"values: the shape is \(9,\), not \(10,\)"):
        delray.interpolate(points, np.zeros(9), points)


@pytest.mark.parametrize("dim", [2, 3])
def test_voronoi_has_scipys_vertices(random, dim):
    points = random.random((40, dim))
    ours, theirs = delray.voronoi(points), scipy.spatial.Voronoi(points)
    order = lambda v: v[np.lexsort(np.round(v, 7).T)]
    assert np.allclose(order(ours.vertices), order(theirs.vertices))
    assert len(ours.ray_starts) == len(delray.Delaunay(points).convex_hull)
    assert np.allclose(np.linalg.norm(ours.ray_directions, axis=1), 1)
    for row, region in enumerate(theirs.point_region):
        theirs_finite = [v for v in theirs.regions[region] if v >= 0]
        a, b = ours.vertices[ours.cell(row)], theirs.vertices[theirs_finite]
        assert np.allclose(order(a), order(b))


def test_hull_is_scipys(random):
    points = random.random((200, 2))
    rows = delray.hull(points)
    theirs = scipy.spatial.ConvexHull(points).vertices  # counterclockwise as well
    assert (np.roll(theirs, -np.argmin(theirs)) == rows).all()
    cube = np.stack(np.meshgrid(*[np.arange(4.0)] * 3), axis=-1).reshape(-1, 3)
    on_faces = ((cube == 0) | (cube == 3)).any(axis=1)
    assert (delray.hull(cube) == np.flatnonzero(on_faces)).all()


def test_quality_of_equal_triangles():
    points = np.array([[0, 0], [2, 0], [1, np.sqrt(3)], [3, np.sqrt(3)]])
    q = delray.quality(points)
    assert q["simplices"] == 2 and q["angles"].sum() == 6
    assert np.allclose([q["min_angle"], q["max_angle"], q["min_radius_ratio"]], [60, 60, 1])


def test_verify_tells_what_is_wrong():
    points = np.array([[0, 0], [4, 0], [0, 1], [4, 1.5]])
    good = delray.Delaunay(points).simplices
    assert delray.verify(points, good)
    flipped = np.array([[0, 1, 3], [0, 3, 2]])
    if (as_set(flipped) == as_set(good)).all():
        flipped = np.array([[0, 1, 2], [1, 3, 2]])
    verdict = delray.verify(points, flipped)
    assert not verdict and verdict.valid and not verdict.delaunay
    assert verdict.simplex in (0, 1) and verdict.reason
    assert not delray.verify(points, good[:1]).valid
    assert not delray.verify(points, good[:, ::-1]).valid
    for wrong, text in ((good[:, :2], "shape"), (good - 1, "-1"), (None, "missing")):
        with pytest.raises(ValueError, match=text):
            delray.verify(points, wrong)


def test_simplified_terrains_keep_their_bound(random):
    xy = random.random((2000, 2))
    points = np.column_stack((xy, np.sin(5 * xy[:, 0]) * xy[:, 1]))
    for bound in (0.3, 0.02):
        made = delray.simplify_terrain(points, bound)
        kept = points[made.kept]
        height = delray.interpolate(kept[:, :2], kept[:, 2], xy)
        assert np.abs(height - points[:, 2]).max() <= bound * (1 + 1e-9)
        assert made.largest_error <= bound
        rows = np.searchsorted(made.kept, made.simplices)
        assert delray.verify(kept[:, :2], rows)
    assert 4 < len(made.kept) < 1000
    with pytest.raises(ValueError):
        delray.simplify_terrain(points, -1)
    with pytest.raises(ValueError, match=r"points: the shape is \(2000, 2\), not \(n, 3\)"):
        delray.simplify_terrain(xy, 1)


@pytest.mark.parametrize("dim", [2, 3])
def test_dynamic_follows(random, dim):
    points = random.random((80, dim)).round(1)  # many equal and cospherical ones
    dynamic = delray.Dynamic(dim)
    assert (dynamic.insert(points[:50]) == np.arange(50)).all()
    assert dynamic.insert(points[50]) == [50]
    assert dynamic.remove([3, 4, 3, -1, 900]) == 2
    dynamic.insert(points[51:])
    assert len(dynamic) == 78 and not dynamic.is_live(3) and dynamic.is_live(5)
    live = np.delete(np.arange(80), [3, 4])
    expected = live[delray.Delaunay(points[live]).simplices]
    assert (as_set(dynamic.simplices) == as_set(expected)).all()
    with pytest.raises(ValueError):
        dynamic.insert([np.nan] * dim)
    with pytest.raises(ValueError):
        delray.Dynamic(4)


def test_threads_share_a_dynamic_triangulation(random):
    dynamic = delray.Dynamic()
    points = random.random((400, 2))

    def work(part):
        for row in dynamic.insert(part[:100]):
            assert dynamic.is_live(row)
        dynamic.insert(part[100:])

    threads = [threading.Thread(target=work, args=(part,)) for part in (points[:200], points[200:])]
    [t.start() for t in threads]
    [t.join() for t in threads]
    assert len(dynamic) == 400 and len(dynamic.simplices) == delray.Delaunay(points).nsimplex


def test_files(tmp_path, random):
    points = random.random((30, 3))
    mesh = delray.Delaunay(points, dim=2)
    path = tmp_path / "mesh.ply"
    delray.write_mesh(path, mesh)
    read = delray.read_mesh(path)
    assert (read.points == points).all() and (read.simplices == mesh.simplices).all()
    assert (delray.read_points(path).points == points).all()
    flat = tmp_path / "points.xyz"
    flat.write_text("0 0\n1 0\n0 1\n")
    assert delray.read_points(flat).points.shape == (3, 2)
    with pytest.raises(FileNotFoundError, match="nowhere.ply"):
        delray.read_points(tmp_path / "nowhere.ply")
    flat.write_text("0 0\n1 x\n")
    with pytest.raises(ValueError, match="line 2"):
        delray.read_points(flat)
    with pytest.raises(OSError):
        delray.write_mesh(tmp_path / "no" / "folder.ply", mesh)
    with pytest.raises(ValueError, match="suffix|.ply"):
        delray.write_mesh(tmp_path / "mesh.doc", mesh)


def test_generated_points_are_the_programs():
    points = delray.generate_points("uniform", 10, 3, seed=5)
    assert points.shape == (10, 3) and (points == delray.generate_points("uniform", 10, 3, 5)).all()
    with pytest.raises(ValueError):
        delray.generate_points("blob", 10)
