#!/usr/bin/env python3
"""Processes of MPI, and ranks within one process, against threads on the same points, in turns:

    bench/delaunay/ranks_against_threads.py PROGRAM [-n 1e7] [--dim 2] [--ranks 2] [--turns 5]

`threads` is one process with as many threads as there are ranks; `ranks` has these within one
process, a thread each; `mpirun` as processes; `start` is an mpirun of the same program with ten
points, what MPI takes to begin and to end. Prints medians of the whole commands' seconds and of
processor seconds, and ratios to `threads`, that of `mpirun` without `start` as well. Nothing is
written but statistics; the hashes must be equal.
"""
import argparse
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time


def run(command, environment):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    begin = time.monotonic()
    done = subprocess.run(command, env=environment, stderr=subprocess.PIPE, text=True, check=False)
    seconds = time.monotonic() - begin
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}: exit code {done.returncode}\n{done.stderr}")
    return seconds, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("program")
    parser.add_argument("-n", default="1e7", help="points")
    parser.add_argument("--kind", default="uniform")
    parser.add_argument("--dim", default="2", choices=["2", "3"])
    parser.add_argument("--ranks", type=int, default=2)
    parser.add_argument("--turns", type=int, default=5)
    choice = parser.parse_args()
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    with tempfile.TemporaryDirectory() as folder:
        points, few = os.path.join(folder, "points.ply"), os.path.join(folder, "few.ply")
        for path, count in ((points, choice.n), (few, "10")):
            subprocess.run([choice.program, "generate", "points", choice.kind, "-n", count, "--dim",
                            choice.dim, "-o", path, "-q"], check=True)

        def command(name, path):
            return [choice.program, "triangulate", path, "--dim", choice.dim, "-q", "--stats",
                    os.path.join(folder, name + ".json")]

        ranks = str(choice.ranks)
        mpirun = ["mpirun", "--oversubscribe", "-n", ranks]
        ways = {
            "threads": command("threads", points) + ["--threads", ranks],
            "ranks": command("ranks", points) + ["--ranks", ranks, "--threads", "1"],
            "mpirun": mpirun + command("mpirun", points) + ["--threads", "1"],
            "start": mpirun + command("start", few) + ["--threads", "1"],
        }
        times = {name: [] for name in ways}
        for _ in range(choice.turns):
            for name, each in ways.items():
                times[name].append(run(each, environment))
        hashes = set()
        for name in ("threads", "ranks", "mpirun"):
            with open(os.path.join(folder, name + ".json"), encoding="utf-8") as file:
                hashes.add(json.load(file)["result"]["hash"])
        if len(hashes) != 1:
            sys.exit(f"hashes differ: {hashes}")
    median = {name: statistics.median(each[0] for each in times[name]) for name in ways}
    work = {name: statistics.median(each[1] for each in times[name]) for name in ways}
    for name in ways:
        print(f"{name:8} {median[name]:7.3f} s, processor {work[name]:7.3f} s, "
              f"ratio {median[name] / median['threads']:5.2f}, "
              f"processor {work[name] / work['threads']:5.2f}")
    print(f"mpirun without start: {(median['mpirun'] - median['start']) / median['threads']:5.2f}")


if __name__ == "__main__":
    main()
