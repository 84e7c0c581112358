"""Compiles each program in C of a page, as C99 without a warning, and runs it.

Usage: examples.py PAGE COMPILER FOLDER-OF-HEADER FOLDER-OF-LIBRARY WORK-FOLDER
"""

import os
import re
import subprocess
import sys
from pathlib import Path

page, compiler, header, library, work = sys.argv[1:]
os.makedirs(work, exist_ok=True)
programs = re.findall(r"```c\n(.*?)```", Path(page).read_text(), re.DOTALL)
assert len(programs) >= 2
for number, text in enumerate(programs):
    source, program = Path(work, f"example{number}.c"), Path(work, f"example{number}")
    source.write_text(text)
    subprocess.run(
        [compiler, "-std=c99", "-pedantic-errors", "-Wall", "-Wextra", "-Werror", f"-I{header}", source,
         "-o", program, f"-L{library}", "-ldelray", f"-Wl,-rpath,{library}"], check=True,
    )  # fmt: skip
    told = subprocess.run([program], check=True, cwd=work, capture_output=True, text=True).stdout
    print(told, end="")
    if number == 0:
        assert told == "162 triangles, verified: 1\n"
picture = Path(work, "triangle.ppm").read_bytes()
assert picture.startswith(b"P6\n320 200\n255\n")
pixels = picture[15:]
assert pixels[:3] == pixels[-3:] and len(set(pixels[3 * 320 * 100 :])) > 50
