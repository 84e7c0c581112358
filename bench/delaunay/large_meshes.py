#!/usr/bin/env python3
"""Triangulations larger than memory, file to file: a folder of pieces and a raster of heights beside the run in memory.

  large_meshes.py DELRAY [--points N] [--memory SIZE] [--threads N] [--turns N] [--scratch DIR] [--only mesh,raster]

`mesh`: uniform points in the plane. In memory they become one .ply; within --memory a folder of VTU pieces, and, to
tell what writing takes, statistics alone. `raster`: the same with heights, which become a folder and a GeoTIFF with a
cell for every four points. All runs take turns; printed are medians of seconds, from the start of the program to its
end, the largest resident set, and ratios beside their bars. Hashes have to be equal, and a resident set above --memory
ends the benchmark. Files lie in DIR: 10^8 points take 12 GB.
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

UNITS = {"K": 10, "M": 20, "G": 30}


def bytes_of(text):
    """The bytes of "1GiB"."""
    return int(float(text[:-3]) * (1 << UNITS[text[-3]]))


class Runs:
    """Ways to triangulate one file, which take turns."""

    def __init__(self, asked, points):
        self.asked, self.points, self.rows = asked, points, {}

    def run(self, name, *words, limited):
        stats = pathlib.Path(self.asked.scratch) / "stats.json"
        command = [self.asked.delray, "triangulate", str(self.points), "--threads", str(self.asked.threads), "-q",
                   "--stats", str(stats), *words]
        if limited:
            command += ["--memory", self.asked.memory]
        begin = time.monotonic()
        subprocess.run(command, check=True)
        seconds = time.monotonic() - begin
        told = json.loads(stats.read_text())
        rss = told["memory"]["peak_rss"]
        if limited and rss > bytes_of(self.asked.memory):
            sys.exit(f"{name}: {rss} bytes were resident, which is more than {self.asked.memory}")
        self.rows.setdefault(name, []).append((seconds, rss, told["result"]["hash"]))

    def report(self):
        if len({row[2] for rows in self.rows.values() for row in rows}) != 1:
            sys.exit("hashes differ")
        for name, rows in self.rows.items():
            print(f"{name:28} {statistics.median(row[0] for row in rows):9.2f} s {max(row[1] for row in rows) / 1e6:9.0f} MB")

    def ratio(self, name, base, bar=0):
        ratio = statistics.median(a[0] / b[0] for a, b in zip(self.rows[name], self.rows[base]))
        print(f"  {name} over {base}: {ratio:.2f}" + (f" (bar {bar})" if bar else ""), flush=True)
        if "DELRAY_RATIOS" in os.environ:  # for scripts/bench, as bench/ratio.h does
            row = {"name": f"{name} over {base}, {self.asked.points} points", "ratio": ratio, "better": "lower"}
            with open(os.environ["DELRAY_RATIOS"], "a") as file:
                print(json.dumps(row | ({"bar": bar} if bar else {})), file=file)


def generate(asked, dim):
    points = pathlib.Path(asked.scratch) / "points.ply"
    subprocess.run([asked.delray, "generate", "points", "uniform", "-n", str(asked.points), "--dim", str(dim), "-o",
                    str(points)], check=True)
    return points


def mesh(asked):
    runs = Runs(asked, generate(asked, 2))
    for _ in range(asked.turns):
        runs.run("one file, in memory", "-o", f"{asked.scratch}/mesh.ply", limited=False)
        runs.run("statistics", "--scratch", asked.scratch, limited=True)
        runs.run("folder", "-o", f"{asked.scratch}/mesh/", "--scratch", asked.scratch, limited=True)
    runs.report()
    runs.ratio("folder", "one file, in memory", 1.6)
    runs.ratio("folder", "statistics")


def raster(asked):
    runs = Runs(asked, generate(asked, 3))
    cell = (4 / asked.points) ** 0.5
    for _ in range(asked.turns):
        runs.run("folder", "-o", f"{asked.scratch}/mesh/", "--scratch", asked.scratch, limited=True)
        runs.run("raster", "-o", f"{asked.scratch}/heights.tif", "--cell-size", repr(cell), "--scratch", asked.scratch,
                 limited=True)
    runs.report()
    runs.ratio("raster", "folder", 1.3)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("delray")
    parser.add_argument("--points", type=lambda text: int(float(text)), default=100_000_000)
    parser.add_argument("--memory", default="1GiB")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--turns", type=int, default=3)
    parser.add_argument("--scratch", default=None)
    parser.add_argument("--only", default="mesh,raster")
    asked = parser.parse_args()
    for kind in asked.only.split(","):
        with tempfile.TemporaryDirectory(dir=asked.scratch) as folder:
            {"mesh": mesh, "raster": raster}[kind](argparse.Namespace(**vars(asked) | {"scratch": folder}))


main()
