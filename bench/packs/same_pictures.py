#!/usr/bin/env python3
"""Whether packs have the pictures of the scenes that were packed, to the byte:

    bench/packs/same_pictures.py PROGRAM SCENE|FOLDER... [--size 640x360] [--ranks 1,3]

Of a folder all files of scenes, meshes and points in it are taken, broken ones excepted. Each is rendered and packed, and its
pack is rendered with both engines and by so many ranks: the rasterizer with sort-last and sort-first, the ray tracer with
--data object. Points are packed as points and, in memory, as a relief. Prints a line for each, and ends with 1 where a
hash is another.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

SUFFIXES = {".glb", ".gltf", ".obj", ".ply", ".stl", ".off", ".las", ".laz", ".txt", ".json", ".png"}
POINTS = {".las", ".laz", ".txt", ".json"}


def run(command):
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}: exit code {done.returncode}\n{done.stderr}")
    return done.stdout


def scenes_of(names):
    for name in names:
        path = pathlib.Path(name)
        if not path.is_dir():
            yield name
            continue
        for file in sorted(path.rglob("*")):
            if "broken" not in file.parts and file.is_file() and file.suffix in SUFFIXES:
                yield str(file)


def ways_of(scene):
    """Options of packing and rendering that change what is shown."""
    suffix = pathlib.Path(scene).suffix
    if scene.startswith("gen:") or suffix not in POINTS | {".png"}:
        return [[]]
    if suffix == ".png":
        return [["--terrain-rgb"]] if "terrain-rgb" in scene else []
    return [["--show-as", "relief"], ["--show-as", "discs"], ["--show-as", "spheres"]]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--size", default="640x360")
    parser.add_argument("--ranks", default="1,3")
    options = parser.parse_args()
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        pack, picture = f"{folder}/a.pack", f"{folder}/a.png"

        def rendered(scene, *more):
            command = [options.program, "render", scene, "-o", picture, "-q", "--stats", "-", "--size", options.size]
            return json.loads(run([*command, *more]))["image"]["hash"]

        for scene in scenes_of(options.scenes):
            for way in ways_of(scene):
                run([options.program, "pack", scene, "-o", pack, "-q", *way])
                for engine in ["raster", "raytrace"]:
                    expected = rendered(scene, *way, "--engine", engine)
                    hows = [["--data", "object"]] if engine == "raytrace" else [
                        ["--strategy", "sort-last"], ["--strategy", "sort-first"]]
                    for how in hows:
                        for ranks in options.ranks.split(","):
                            found = rendered(pack, "--engine", engine, "--ranks", ranks, *how)
                            same = found == expected
                            wrong += 0 if same else 1
                            print(f"{'same' if same else 'OTHER':5} {expected} {found} {scene} {' '.join(way)} "
                                  f"{engine} {' '.join(how)} --ranks {ranks}", flush=True)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
