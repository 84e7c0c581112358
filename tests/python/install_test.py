"""The package installs into a virtual environment without network, and works there."""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def test_package_installs(tmp_path):
    subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", tmp_path / "venv"],
                   check=True)
    python = tmp_path / "venv" / "bin" / "python"
    # Of what is built already.
    subprocess.run(
        [python, "-m", "pip", "install", "--quiet", "--no-index", "--no-build-isolation", "--no-deps",
         "--disable-pip-version-check", ROOT], check=True,
    )  # fmt: skip
    environment = {k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "DELRAY"))}
    code = (
        "import delray, os;"
        "assert delray.Delaunay([[0, 0], [1, 0], [0, 1]]).nsimplex == 1;"
        "assert delray.render('gen:cornell:100', size=(8, 8)).shape == (8, 8, 4);"
        "files = os.listdir(os.path.dirname(delray.__file__));"
        "assert 'py.typed' in files and '_delray.pyi' in files;"
        "print(delray.__file__, delray.__version__)"
    )
    told = subprocess.run([python, "-c", code], check=True, env=environment, cwd=tmp_path,
                          capture_output=True, text=True).stdout
    assert told.startswith(str(tmp_path))
    version = told.split()[-1]
    listed = subprocess.run([python, "-m", "pip", "list", "--disable-pip-version-check"], check=True,
                            capture_output=True, text=True).stdout
    assert any(line.split()[:2] == ["delray", version] for line in listed.splitlines())
