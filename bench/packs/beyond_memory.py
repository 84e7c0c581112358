#!/usr/bin/env python3
"""Scenes and clouds larger than memory beside small ones that memory holds, file to file:

    bench/packs/beyond_memory.py PROGRAM [--points N] [--memory 1GiB] [--frames 60] [--turns 3] [--scratch DIR]
                                 [--only terrain,exact,points,exact-points] [--error-on-screen bench/packs_error_on_screen]

terrain       N points of a fractal terrain are triangulated into a folder and packed, both within --memory; then a turntable
              with --error 1 in that memory, beside one of gen:terrain with a hundredth of N triangles that memory holds
exact         its exact picture, beside 20 of gen:terrain with N/10 triangles and reading the bytes of the file
points        N points, packed as points: a picture with --error 1 beside one of N/100 points that memory holds
exact-points  all of them, beside ten pictures of N/10 points and reading the bytes

1920 x 1080, two threads; N is 10^8 where nothing is said, which takes some 40 GB in DIR, and is brought down for a try. Runs take
turns; printed are medians, the largest resident set, which ends the benchmark where it is above --memory, and ratios beside
their bars. Files that are in DIR already are taken as they are.
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import time

UNITS = {"K": 10, "M": 20, "G": 30}


def resident_of(told):
    """The largest resident set of a process, in bytes."""
    return told["memory"]["peak_rss"] if "memory" in told else max(rank["peak_rss"] for rank in told["ranks"])


def bytes_of(text):
    return int(float(text[:-3]) * (1 << UNITS[text[-3]]))


class Bench:
    def __init__(self, asked):
        self.asked = asked
        self.scratch = pathlib.Path(asked.scratch)

    def run(self, *words, limited=False):
        """The statistics of a command, and the seconds from its start to its end."""
        stats = self.scratch / "stats.json"
        command = [self.asked.program, *map(str, words), "-q", "--stats", str(stats)]
        if limited:
            command += ["--memory", self.asked.memory]
        begin = time.monotonic()
        subprocess.run(command, check=True)
        seconds = time.monotonic() - begin
        told = json.loads(stats.read_text())
        resident = resident_of(told)
        if limited and resident > bytes_of(self.asked.memory):
            sys.exit(f"{' '.join(command)}: {resident} bytes were resident, more than {self.asked.memory}")
        return told, seconds

    def make(self, what, file, *words, limited=True):
        if file.exists():
            print(f"{what}: {file} is there", flush=True)
            return
        told, seconds = self.run(*words, "-o", f"{file}/" if file.suffix == "" else file, limited=limited)
        size = sum(f.stat().st_size for f in file.rglob("*")) if file.is_dir() else file.stat().st_size
        print(f"{what}: {seconds:.1f} s, {size / 1e9:.2f} GB, {resident_of(told) / 1e6:.0f} MB resident", flush=True)

    def points(self, count):
        file = self.scratch / f"terrain-{count}.ply"
        if not file.exists():
            subprocess.run([self.asked.program, "generate", "points", "terrain", "-n", str(count), "--dim", "3", "-q", "-o", str(file)],
                           check=True)
        return file

    def render(self, scene, *words, limited):
        picture = self.scratch / "frame.png"
        told, _ = self.run("render", scene, "--size", "1920x1080", "--threads", 2, *words, "-o", picture, limited=limited)
        return told

    def terrain(self):
        n = self.asked.points
        pack = self.scratch / f"terrain-{n}.pack"
        if not pack.exists():
            folder = self.scratch / f"mesh-{n}"
            self.make("triangulated", folder, "triangulate", self.points(n), "--scratch", self.scratch, "--threads", 2)
            self.make("packed", pack, "pack", folder, "--threads", 2)
        return pack

    def cloud(self):
        pack = self.scratch / f"points-{self.asked.points}.pack"
        self.make("points packed", pack, "pack", self.points(self.asked.points), "--show-as", "points", "--threads", 2)
        return pack

    def ratio(self, name, ratios, bar):
        ratio = statistics.median(ratios)
        print(f"{name}: {ratio:.2f} (bar {bar}; {' '.join(f'{r:.2f}' for r in ratios)})", flush=True)
        if "DELRAY_RATIOS" in os.environ:  # for scripts/bench, as bench/ratio.h does
            with open(os.environ["DELRAY_RATIOS"], "a") as file:
                print(json.dumps({"name": f"{name}, {self.asked.points} points", "ratio": ratio, "bar": bar, "better": "lower"}), file=file)

    def read(self, file):
        """Seconds to read all bytes of a file that the system may have in its cache."""
        begin = time.monotonic()
        with open(file, "rb", buffering=0) as bytes_of_file:
            while bytes_of_file.read(1 << 24):
                pass
        return time.monotonic() - begin

    def coarse_terrain(self):
        pack, medians, slowest = self.terrain(), [], []
        for _ in range(self.asked.turns):
            turn = ("--turntable", self.asked.frames)
            base = self.render(f"gen:terrain:{self.asked.points // 100}", *turn, limited=False)["seconds"]["frame"]
            told = self.render(pack, *turn, "--error", 1, limited=True)
            frames = [frame["seconds"] for frame in told["animation"]["each"]]
            print(f"  in memory {base * 1e3:.1f} ms; pack {statistics.median(frames) * 1e3:.1f} ms, first {frames[0] * 1e3:.1f}, slowest after it "
                  f"{max(frames[1:]) * 1e3:.1f}, {resident_of(told) / 1e6:.0f} MB", flush=True)
            medians.append(statistics.median(frames) / base)
            slowest.append(max(frames) / base)
        self.ratio("median frame of a turntable, --error 1", medians, 1.5)
        self.ratio("slowest frame", slowest, 6)
        if self.asked.error_on_screen:
            subprocess.run([self.asked.error_on_screen, str(pack), "--error", "1", "--cache", "512"], check=True)

    def whole(self, name, pack, small, options, times):
        ratios = []
        for _ in range(self.asked.turns):
            base = self.render(small, *options, "--frames", 3, limited=False)["seconds"]["frame"]
            reading = self.read(pack)
            told = self.render(pack, *options[2:], limited=True)
            frame = told["seconds"]["frame"]
            print(f"  in memory {base * 1e3:.1f} ms, reading {reading:.2f} s; pack {frame:.2f} s, {resident_of(told) / 1e6:.0f} MB", flush=True)
            ratios.append(frame / (times * base + reading))
        self.ratio(name, ratios, 1.3)

    def coarse_points(self):
        pack, ratios = self.cloud(), []
        for _ in range(self.asked.turns):
            base = self.render(self.points(self.asked.points // 100), "--show-as", "points", "--frames", 5, limited=False)["seconds"]["frame"]
            told = self.render(pack, "--error", 1, "--frames", 5, limited=True)
            print(f"  in memory {base * 1e3:.1f} ms; pack {told['seconds']['frame'] * 1e3:.1f} ms", flush=True)
            ratios.append(told["seconds"]["frame"] / base)
        self.ratio("points, --error 1", ratios, 1.5)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--points", type=lambda text: int(float(text)), default=10**8)
    parser.add_argument("--memory", default="1GiB")
    parser.add_argument("--frames", type=int, default=60)
    parser.add_argument("--turns", type=int, default=3)
    parser.add_argument("--scratch", default=".")
    parser.add_argument("--only", default="terrain,exact,points,exact-points")
    parser.add_argument("--error-on-screen", help="the benchmark that counts pixels which are displaced")
    asked = parser.parse_args()
    bench = Bench(asked)
    bench.scratch.mkdir(parents=True, exist_ok=True)
    parts = {"terrain": bench.coarse_terrain,
             "exact": lambda: bench.whole("exact frame", bench.terrain(), f"gen:terrain:{asked.points // 10}", (), 20),
             "points": bench.coarse_points,
             "exact-points": lambda: bench.whole("all points", bench.cloud(), bench.points(asked.points // 10), ("--show-as", "points"), 10)}
    for part in asked.only.split(","):
        print(f"== {part}", flush=True)
        parts[part]()


if __name__ == "__main__":
    main()
