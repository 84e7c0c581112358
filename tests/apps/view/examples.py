#!/usr/bin/env python3
"""Runs the command lines of docs/view.md as they stand there: examples.py DELRAY PAGE.

Each is a server whose page is fetched, and which Ctrl-C ends. Says which lines it skips, and why.
"""
import os
import pathlib
import re
import shlex
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import urllib.request

PATIENCE = 90
delray, page = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])


def write_las(path, n):
    """LAS 1.2 with point records of format 0 (ASPRS), on a slope, without compression."""
    header = struct.pack("<4sHH16sBB32s32sHHHIIBHI5I12d", b"LASF", 0, 0, bytes(16), 1, 2, b"tests", b"tests", 1, 2026,
                         227, 227, 0, 0, 20, n, n, 0, 0, 0, 0, 0.01, 0.01, 0.01, 0, 0, 0,
                         0.01 * n, 0, 0.01 * (n * n // 7 % n + n), 0, 0.01 * n, 0)
    assert len(header) == 227
    points = [struct.pack("<iiiHBBbBH", i, i * i // 7 % n, i, 100 * (i % 9), 0b001001, 2 + i % 4, 0, 0, 0)
              for i in range(n)]
    path.write_bytes(header + b"".join(points))


def make_inputs(folder):
    """The files that the page names; what they are follows from what is in them."""
    def make(*arguments):
        subprocess.run([delray, *arguments, "-q"], check=True, cwd=folder)

    make("generate", "scene", "spheres", "-n", "300", "-o", "model.glb")
    write_las(folder / "survey.laz", 300)
    make("pack", "gen:terrain:2000", "-o", "terrain.pack")


def stand_in(folder, name, script):
    program = folder / name
    program.write_text("#!/bin/sh\n" + script)
    program.chmod(0o755)


def run(words, folder, environment):
    server = subprocess.Popen(words, stdout=subprocess.PIPE, text=True, cwd=folder, env=environment)
    try:
        url = server.stdout.readline().strip()
        assert re.fullmatch(r"http://127\.0\.0\.1:\d+/\?token=\w+", url), url
        with urllib.request.urlopen(url, timeout=PATIENCE) as answer:
            assert answer.status == 200 and b"<canvas" in answer.read()
        server.send_signal(signal.SIGINT)
        code = server.wait(PATIENCE)
        assert code == (130 if words[0] == "delray" else code) and code != 0, code
    finally:
        if server.poll() is None:
            server.kill()


def main():
    blocks = re.findall(r"```sh\n(.*?)```", page.read_text(), re.DOTALL)
    lines = [line for block in blocks for line in block.splitlines() if line.strip()]
    assert len(lines) >= 4, lines
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        programs = folder / "bin"
        programs.mkdir()
        stand_in(programs, "delray", f'exec {shlex.quote(str(delray))} "$@"\n')
        stand_in(programs, "xdg-open", f'echo "$1" > {shlex.quote(str(folder / "opened"))}\n')
        environment = {**os.environ, "PATH": f"{programs}:{os.environ['PATH']}", "OMPI_ALLOW_RUN_AS_ROOT": "1",
                       "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1"}
        environment.pop("DELRAY_VIEW_TOKEN", None)
        make_inputs(folder)
        ran = 0
        for line in lines:
            words = shlex.split(line, comments=True)
            if not shutil.which(words[0], path=environment["PATH"]):
                print(f"skipped, without {words[0]}: {line}")
                continue
            run(words, folder, environment)
            ran += 1
            print("ran:", line, flush=True)
        assert ran >= 3
        assert (folder / "opened").exists(), "--open opened nothing"


main()
