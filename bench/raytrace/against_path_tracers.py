#!/usr/bin/env python3
"""Path tracing against whole programs: rays per second beside Embree's own path tracer.

  against_path_tracers.py DELRAY MODEL... [--threads 1,2] [--turns 5] [--bounces 4]

Both render the same model (OBJ or PLY) through the same camera, 1920 x 1080, one sample a pixel, lit
by one directional light and the sky. The programs take turns; printed are medians of millions of rays
per second, of all kinds, and their ratio (larger is better for us). Embree's is `pathtracer` of
Debian's embree-tools (its benchmark counts the rays); where it is missing nothing is measured. Where
`blender` is installed, Cycles renders the same model, in seconds a sample.
"""
import argparse
import json
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import tempfile

SIZE = (1920, 1080)
CYCLES = """
import bpy, mathutils, sys, time
model, threads, bounces, samples = sys.argv[-4:]
eye, at, up, fov = {camera}
bpy.ops.wm.read_factory_settings(use_empty=True)
(bpy.ops.wm.obj_import if model.endswith("obj") else bpy.ops.import_mesh.ply)(filepath=model)
for thing in bpy.data.objects:
    thing.matrix_world = mathutils.Matrix()  # as in the file, not turned
scene = bpy.context.scene
camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
camera.data.sensor_fit, camera.data.angle = "VERTICAL", fov * 3.14159265 / 180
camera.data.clip_start, camera.data.clip_end = 1e-4, 1e6
back = (mathutils.Vector(eye) - mathutils.Vector(at)).normalized()
right = mathutils.Vector(up).cross(back).normalized()
rotation = mathutils.Matrix((right, back.cross(right), back)).transposed().to_4x4()
camera.matrix_world = mathutils.Matrix.Translation(eye) @ rotation
scene.collection.objects.link(camera)
scene.camera = camera
scene.world = bpy.data.worlds.new("sky")
scene.render.engine = "CYCLES"
scene.render.resolution_x, scene.render.resolution_y = {size}
scene.render.threads_mode, scene.render.threads = "FIXED", int(threads)
scene.cycles.max_bounces, scene.cycles.use_adaptive_sampling = int(bounces), False
scene.cycles.use_denoising = False
seconds = []
for n in (1, 1 + int(samples), 1):  # what comes before and after sampling cancels out
    scene.cycles.samples = n
    start = time.time()
    bpy.ops.render.render()
    seconds.append(time.time() - start)
print("SECONDS", (seconds[1] - seconds[2]) / int(samples))
"""


def camera_of(delray, model):
    with tempfile.TemporaryDirectory() as folder:
        out = subprocess.run(
            [delray, "render", model, "-o", f"{folder}/a.png", "--size", "%dx%d" % SIZE, "--stats",
             "-", "-q"], check=True, capture_output=True, text=True).stdout
    camera = json.loads(out)["camera"]
    return camera["eye"], camera["at"], camera["up"], camera["fov"]


def ours(delray, model, camera, threads, bounces):
    eye, at, up, fov = camera
    numbers = ",".join(repr(x) for x in [*eye, *at, *up, fov])
    with tempfile.TemporaryDirectory() as folder:
        out = subprocess.run(
            [delray, "render", model, "-o", f"{folder}/a.png", "--size", "%dx%d" % SIZE,
             "--engine", "raytrace", "--integrator", "path", "--depth", str(bounces),
             "--diffuse-depth", str(bounces),
             f"--camera={numbers}", "--threads", str(threads), "--frames", "5", "--stats", "-", "-q"],
            check=True, capture_output=True, text=True).stdout
    told = json.loads(out)
    return sum(told["rays"].values()) / told["seconds"]["frame"] / 1e6


def embree(program, model, camera, threads, bounces):
    eye, at, up, fov = camera
    out = subprocess.run(
        [program, "-i", model, "--righthanded", "--size", *map(str, SIZE), "--threads",
         str(threads), "--spp", "1", "--max-path-length", str(bounces), "--vp", *map(str, eye),
         "--vi", *map(str, at), "--vu", *map(str, up), "--fov", str(fov), "--ambientlight", "1",
         "1", "1", "--directionallight", "-1", "-2", "-1", "1", "1", "1", "--benchmark", "1", "3"],
        check=True, capture_output=True, text=True).stdout
    return float(re.search(r"MRAYPS_AVG\s+([0-9.]+)", out).group(1))


def cycles(program, model, camera, threads, bounces):
    with tempfile.NamedTemporaryFile("w", suffix=".py") as script:
        script.write(CYCLES.format(camera=repr(camera), size=SIZE))
        script.flush()
        out = subprocess.run([program, "-b", "-P", script.name, "--", model, str(threads),
                              str(bounces), "4"], check=True, capture_output=True, text=True).stdout
    return float(re.search(r"SECONDS (\S+)", out).group(1))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("delray")
    parser.add_argument("models", nargs="+")
    parser.add_argument("--threads", default="1,2")
    parser.add_argument("--turns", type=int, default=5)
    parser.add_argument("--bounces", type=int, default=4)
    asked = parser.parse_args()
    peer, blender = shutil.which("pathtracer"), shutil.which("blender")
    if not peer:
        raise SystemExit("pathtracer (Debian: embree-tools) is not installed")
    print("model threads delray_mrays embree_mrays ratio" + (" cycles_s" if blender else ""))
    for model in asked.models:
        camera = camera_of(asked.delray, model)
        for threads in map(int, asked.threads.split(",")):
            pairs = [(ours(asked.delray, model, camera, threads, asked.bounces),
                      embree(peer, model, camera, threads, asked.bounces))
                     for _ in range(asked.turns)]
            a, b = (statistics.median(side) for side in zip(*pairs))
            ratio = statistics.median(x / y for x, y in pairs)
            line = f"{pathlib.Path(model).name} {threads} {a:.2f} {b:.2f} {ratio:.2f}"
            if blender:
                line += f" {cycles(blender, model, camera, threads, asked.bounces):.3f}"
            print(line, flush=True)
            if "DELRAY_RATIOS" in os.environ:  # for scripts/bench, as bench/ratio.h does
                name = f"{pathlib.Path(model).name}, {threads} thread" + "s" * (threads > 1)
                with open(os.environ["DELRAY_RATIOS"], "a") as file:
                    print(json.dumps({"name": name, "ratio": ratio, "better": "higher"}), file=file)


main()
