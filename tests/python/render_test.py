"""Scenes and pictures: what is seen, the same pictures as the program's, what is refused."""

import json
import os
import subprocess

import delray
import numpy as np
import pytest

SIZE = (64, 48)
SQUARE = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], float)
TRIANGLES = [[0, 1, 2], [0, 2, 3]]
FRONT = delray.Camera(eye=(0, 0, 4), at=(0, 0, 0))


def square(origin=(0, 0, 0), **mesh):
    scene = delray.Scene(origin)
    plain = scene.add_material((0, 1, 0), unlit=True)
    scene.add_mesh(SQUARE + np.asarray(origin), TRIANGLES, material=plain, **mesh)
    return scene


@pytest.mark.parametrize("engine", ["raster", "raytrace"])
def test_a_square_is_seen_where_it_is(engine):
    picture = delray.render(square(), FRONT, size=SIZE, engine=engine, background="#ff0000")
    assert picture.shape == (48, 64, 4) and picture.dtype == np.uint8
    assert tuple(picture[24, 32]) == (0, 255, 0, 255)
    assert tuple(picture[0, 0]) == (255, 0, 0, 255)
    assert picture.depth.shape == (48, 64) and np.isinf(picture.depth[0, 0])
    assert picture.depth[24, 32] == pytest.approx(4, rel=1e-5)
    assert picture.statistics["schema"] == "delray.render/1"
    assert picture.statistics["image"]["hash"] == picture.hash
    assert picture.statistics["scene"]["triangles"] == 2


def test_pictures_are_the_programs(tmp_path):
    file = tmp_path / "stats.json"
    subprocess.run(
        [os.environ["DELRAY_PROGRAM"], "render", "gen:spheres:500", "-o", tmp_path / "p.png",
         "--size", "64x48", "--engine", "raytrace", "--spp", "2", "--stats", file, "-q"], check=True,
    )  # fmt: skip
    expected = json.loads(file.read_text())["image"]["hash"]
    assert delray.render("gen:spheres:500", size=SIZE, engine="raytrace", spp=2).hash == expected
    loaded = delray.Scene.load("gen:spheres:500")
    assert delray.render(loaded, size="64x48", engine="raytrace", spp=2, ranks=2).hash == expected
    ppm = delray.render("gen:spheres:500", size=SIZE, engine="raytrace", spp=2, ranks=3, threads=1,
                        schedule="stealing")
    assert ppm.hash == expected


def test_ranks_and_strategies_give_the_same():
    renderer = delray.Renderer("gen:city:2000", size=SIZE)
    expected = renderer.render().hash
    for options in (dict(ranks=2, strategy="sort-first"), dict(ranks=3, compose="radix-k:3"),
                    dict(threads=1), dict(ranks=2, strategy="sort-middle", partition="mahd")):
        assert delray.render("gen:city:2000", size=SIZE, **options).hash == expected


def test_a_renderer_takes_pictures_from_other_places():
    renderer = delray.Renderer(square(), FRONT, size=SIZE, background="transparent")
    first = renderer.render()
    second = renderer.render(delray.Camera((0, 0, 8), (0, 0, 0)))
    assert (first[..., 3] > 0).sum() > 3 * (second[..., 3] > 0).sum() > 0
    assert renderer.render(((0, 0, 4), (0, 0, 0), (0, 1, 0), 40)).hash == first.hash


def test_floats_are_linear_light():
    picture = delray.render(square(), FRONT, size=SIZE, dtype=np.float32, background="#808080")
    assert picture.dtype == np.float32
    assert picture[0, 0, 0] == pytest.approx(0.2158605, rel=1e-4)
    channels = delray.render(square(), FRONT, size=SIZE, dtype=np.float32, engine="raytrace",
                             aovs=True).channels
    assert channels and all(c.shape == (48, 64) for c in channels.values())


def test_pictures_show_themselves(tmp_path):
    picture = delray.render(square(), FRONT, size=SIZE, background="transparent")
    assert picture._repr_png_().startswith(b"\x89PNG\r\n")
    picture.save(tmp_path / "square.png")
    import matplotlib.image

    read = matplotlib.image.imread(tmp_path / "square.png")
    assert read.shape == (48, 64, 4) and tuple(read[24, 32]) == (0, 1, 0, 1) and read[0, 0, 3] == 0
    floats = delray.render(square(), FRONT, size=SIZE, background="transparent", dtype=np.float32)
    assert floats._repr_png_() == picture._repr_png_()
    assert square()._repr_png_().startswith(b"\x89PNG") and delray.Scene()._repr_png_() is None
    assert type(picture / 2) is np.ndarray and picture[..., 0]._repr_png_() is None
    assert type(picture.mean()) is np.float64


def test_colours_textures_instances_and_points():
    scene = delray.Scene()
    colors = np.full((4, 3), [0, 0, 255], np.uint8)
    blue = scene.add_mesh(SQUARE, TRIANGLES, colors=colors, place=False,
                          material=scene.add_material((1, 1, 1), unlit=True))
    scene.add_instance(blue, [[0.5, 0, 0, 1], [0, 0.5, 0, 0], [0, 0, 1, 0]])
    texture = np.zeros((2, 2, 3), np.uint8)
    texture[0, 0] = 255, 0, 0
    uvs = [[0.25, 0.25]] * 4  # the middle of the first texel
    scene.add_mesh(SQUARE - [1, 0, 1], TRIANGLES, uvs=uvs,
                   material=scene.add_material((1, 1, 1), unlit=True, texture=texture))
    scene.add_points([[0, 1.2, 0]], shape="sphere", radius=0.2, colors=[[1.0, 1, 1]],
                     material=scene.add_material((1, 1, 1), unlit=True))
    assert scene.triangles == 4 and scene.points == 1
    assert scene.bounds[0] == (-2, -1, -1)
    picture = delray.render(scene, FRONT, size=SIZE, background="#000000")
    assert tuple(picture[24, 46]) == (0, 0, 255, 255)
    assert tuple(picture[24, 20]) == (255, 0, 0, 255)
    assert (picture[..., :3] == 255).all(axis=-1).any()


def test_large_coordinates_stay_exact_about_an_origin():
    near, far = square(), square(origin=(4.5e5, 5.5e6, 0))
    camera = delray.Camera(eye=(4.5e5, 5.5e6, 4), at=(4.5e5, 5.5e6, 0))
    a, b = delray.render(near, FRONT, size=SIZE), delray.render(far, camera, size=SIZE)
    assert (a == b).all()


def test_triangulations_are_surfaces(random):
    points = random.random((50, 3))
    mesh = delray.Delaunay(points, dim=2)
    scene = delray.Scene.from_triangulation(mesh, colors=random.random((50, 3)))
    assert scene.triangles == mesh.nsimplex
    assert delray.render(mesh, size=SIZE).depth.min() < np.inf
    solid = delray.Delaunay(points)
    assert delray.Scene.from_triangulation(solid).triangles == len(solid.convex_hull)


def test_files_are_read_with_their_options(tmp_path, random):
    path = tmp_path / "points.xyz"
    np.savetxt(path, random.random((200, 3)))
    scene = delray.Scene.load(path, color_by="z", show_as="relief", exaggeration=2)
    assert scene.triangles > 300
    assert delray.render(path, size=SIZE, color_by="z", legend=True).shape == (48, 64, 4)


def test_pictures_grow():
    seen = []
    with delray.Progressive("gen:cornell:100", size=(32, 32), integrator="path", spp=16) as growing:
        for picture in growing:
            seen.append(picture)
    assert seen and seen[-1].statistics["image"]["hash"] == seen[-1].hash
    assert growing.picture is seen[-1]
    whole = delray.render("gen:cornell:100", size=(32, 32), engine="raytrace", integrator="path",
                          spp=16)
    assert seen[-1].hash == whole.hash
    endless = delray.Progressive("gen:cornell:100", size=(32, 32), integrator="path", spp=65536)
    assert next(endless).shape == (32, 32, 4)
    endless.stop()
    list(endless)
    assert endless._repr_png_().startswith(b"\x89PNG")
    with pytest.raises(ValueError, match="do not grow"):
        delray.Progressive("gen:cornell:100", engine="raster")


@pytest.mark.parametrize(
    "options, text",
    [
        (dict(sice=(3, 3)), "--sice"),
        (dict(size="large"), "--size: 'large'"),
        (dict(spp=4), "--spp has no effect with --engine raster"),
        (dict(engine="raytrace", spp=0), "--spp"),
        (dict(engine="opengl"), "opengl"),
        (dict(camera="kitchen"), "--camera: 'kitchen' is no camera of the scene"),
        (dict(turntable=3), "--turntable: an option of the program"),
        (dict(output="x.png"), "--output: an option of the program"),
        (dict(color_by="z"), "--color-by.*: an option of scenes that are read"),
        (dict(dtype=np.float64), "float64 is neither"),
    ],
)
def test_wrong_options_raise_value_errors(options, text):
    with pytest.raises(ValueError, match=text):
        delray.render(square(), **options)


@pytest.mark.parametrize(
    "mesh, text",
    [
        (dict(positions=SQUARE, triangles=[[0, 1, 4]]), "triangles: 4 is no row of positions"),
        (dict(positions=SQUARE, triangles=[[0, 1, -1]]), "triangles: -1 is no row of positions"),
        (dict(positions=SQUARE[:, :2], triangles=TRIANGLES), "positions: the shape is"),
        (dict(positions=SQUARE * np.nan, triangles=TRIANGLES), "positions: row 0 is not finite"),
        (dict(positions=SQUARE, triangles=TRIANGLES, normals=SQUARE[:3]), "normals: 3 rows for 4"),
        (dict(positions=SQUARE, triangles=TRIANGLES, normals=SQUARE * 0), "no length"),
        (dict(positions=SQUARE, triangles=TRIANGLES, material=7), "material: 7 does not exist"),
        (dict(positions=SQUARE, triangles=TRIANGLES, colors=-SQUARE), "colors: row 1 is below 0"),
        (dict(positions=SQUARE, triangles=TRIANGLES, transform=np.eye(3)), "transform: the shape"),
    ],
)
def test_wrong_meshes_raise_value_errors(mesh, text):
    scene = delray.Scene()
    with pytest.raises(ValueError, match=text):
        scene.add_mesh(**mesh)
    assert scene.triangles == 0


def test_files_that_are_not_there_are_os_errors(tmp_path):
    with pytest.raises(FileNotFoundError):
        delray.Scene.load(tmp_path / "nothing.glb")
    (tmp_path / "broken.glb").write_bytes(b"glTF....")
    with pytest.raises(ValueError, match="broken.glb"):
        delray.Scene.load(tmp_path / "broken.glb")


def test_options_are_described():
    options = delray.render_options()
    assert "spp" in options and "strategy" in options and "output" not in options
    assert all(options.values())


def test_comparisons_are_tables():
    found = delray.compare("compose", "gen:spheres:500", ranks=[2, 4], size=SIZE, quick=True)
    assert found["schema"] == "delray.compare.compose/1"
    table = found["rows"]
    assert set(table["scheme"]) >= {"binary-swap", "radix-k"} and set(table["ranks"]) == {2, 4}
    assert (table["bytes_total"] > 0).any() and len(table["seconds.compose"]) == len(table["scheme"])
    with pytest.raises(ValueError, match="compare"):
        delray.compare("everything", "gen:spheres:500")
