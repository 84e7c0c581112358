"""Builds the module of the Python package by CMake. DELRAY_BUILD names a folder where Delray is
already configured with -DDELRAY_PYTHON=ON, which then is what gets built and installed; otherwise it
is built in setuptools' own folder. CMake, Ninja and the packages of scripts/setup must be there."""

import os
import re
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent


class BuildByCMake(build_ext):
    def build_extension(self, extension):
        package = Path(self.get_ext_fullpath(extension.name)).resolve().parent
        build = Path(os.environ.get("DELRAY_BUILD") or Path(self.build_temp) / "delray").resolve()
        if "DELRAY_BUILD" not in os.environ:
            self.call("cmake", "-S", ROOT, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                     "-DDELRAY_TESTS=OFF", "-DDELRAY_PYTHON=ON",
                     f"-DPython_EXECUTABLE={sys.executable}")
        self.call("cmake", "--build", build, "--target", "delray_python")
        self.call("cmake", "--install", build, "--component", "python", "--strip",
                 "--prefix", package.parent)

    @staticmethod
    def call(*command):
        subprocess.run([str(part) for part in command], check=True)


version = re.search(r"project\(delray VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())
setup(
    version=version[1],
    ext_modules=[Extension("delray._delray", [])],
    cmdclass={"build_ext": BuildByCMake},
)
