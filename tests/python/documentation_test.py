"""The examples of the documentation run, and what is public is documented and typed."""

import ast
import inspect
import re
from pathlib import Path

import delray
import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]


def blocks(page, language):
    return re.findall(rf"```{language}\n(.*?)```", (ROOT / page).read_text(), re.DOTALL)


@pytest.mark.parametrize("page", ["docs/python.md"])
def test_examples_run(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    np.savetxt("scan.xyz", np.random.default_rng(1).random((300, 3)))
    names = {}
    found = blocks(page, "python")
    assert len(found) >= 4
    for block in found:
        exec(compile(block, page, "exec"), names)


def test_everything_public_is_documented():
    assert set(delray.__all__) <= set(dir(delray))
    for name in delray.__all__:
        thing = getattr(delray, name)
        if not callable(thing):
            continue
        assert inspect.getdoc(thing), name
        if inspect.isclass(thing):
            for member, value in vars(thing).items():
                if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                    assert inspect.getdoc(value), f"{name}.{member}"


@pytest.mark.parametrize("module", ["_delray", "_render"])
def test_stubs_name_what_is_there(module):
    compiled = getattr(__import__(f"delray.{module}"), module)
    stub = ast.parse((ROOT / f"python/delray/{module}.pyi").read_text())
    named = {}
    for node in stub.body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            members = getattr(node, "body", []) if isinstance(node, ast.ClassDef) else []
            named[node.name] = {m.name for m in members if isinstance(m, ast.FunctionDef)}
    there = {name for name in vars(compiled) if not name.startswith("__")}
    assert set(named) == there
    for name, members in named.items():
        if inspect.isclass(getattr(compiled, name)) and members:
            mine = {m for m in vars(getattr(compiled, name)) if not m.startswith("_")}
            assert {m for m in members if not m.startswith("_")} == mine, name
