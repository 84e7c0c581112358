#!/usr/bin/env python3
"""Triangulates the same points by delray.Delaunay, by the program (whose time is that of the C++ call
alone), and by scipy.spatial.Delaunay, in turns, and prints medians and their ratios.

Usage: PYTHONPATH=build/release/python bench/python/against_scipy.py [--points N] [--dim D] [--threads T]
       [--turns K] [--program build/release/delray] [--without-scipy]
"""

import argparse
import json
import subprocess
import tempfile
import time
from pathlib import Path
from statistics import median

import delray


def seconds(call):
    begin = time.perf_counter()
    result = call()
    return time.perf_counter() - begin, result


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--points", type=int, default=1_000_000)
    parser.add_argument("--dim", type=int, default=2)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--turns", type=int, default=5)
    parser.add_argument("--program", type=Path, default=Path("build/release/delray"))
    parser.add_argument("--without-scipy", action="store_true")
    arguments = parser.parse_args()
    points = delray.generate_points("uniform", arguments.points, arguments.dim)
    times = {"module": [], "call": [], "scipy": []}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "points.ply"
        options = [arguments.program, "generate", "points", "uniform", "-n", str(arguments.points)]
        subprocess.run([*options, "--dim", str(arguments.dim), "-o", file, "-q"], check=True)
        for _ in range(arguments.turns):
            taken, mesh = seconds(lambda: delray.Delaunay(points, threads=arguments.threads))
            times["module"].append(taken)
            told = subprocess.run(
                [arguments.program, "triangulate", file, "--dim", str(arguments.dim), "--threads",
                 str(arguments.threads), "--stats", "-", "-q"], check=True, capture_output=True,
            )  # fmt: skip
            told = json.loads(told.stdout)
            times["call"].append(told["seconds"]["triangulate"])
            assert told["result"]["hash"] == mesh.hash
            if not arguments.without_scipy:
                import scipy.spatial

                taken, theirs = seconds(lambda: scipy.spatial.Delaunay(points))
                times["scipy"].append(taken)
                assert len(theirs.simplices) == mesh.nsimplex
    what = f"{arguments.points} points, {arguments.dim}D, {arguments.threads} threads"
    print(f"{what}, medians of {arguments.turns} turns")
    for name, taken in times.items():
        if taken:
            print(f"{name:8} {median(taken):8.3f} s  ({min(taken):.3f} .. {max(taken):.3f})")
    if times["scipy"]:
        print(f"scipy / module  {median(times['scipy']) / median(times['module']):.2f}")
    print(f"module / call   {median(times['module']) / median(times['call']):.3f}")


if __name__ == "__main__":
    main()
