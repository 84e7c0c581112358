"""Comparisons of algorithms on an input of the caller's."""

from __future__ import annotations

import json
import os
from typing import Any, Dict, List, Union

import numpy as np

from . import _render
from .rendering import _arguments

Table = Dict[str, np.ndarray]


def _columns(rows: List[Dict[str, Any]]) -> Table:
    """Rows as one array for each of their keys; keys of keys are joined by dots. Rows without one
    have nan there, or None where it is no number."""
    flat = [_flat(row) for row in rows]
    table = {}
    for name in dict.fromkeys(name for row in flat for name in row):
        values = [row.get(name) for row in flat]
        if all(value is None or isinstance(value, (int, float)) for value in values):
            values = [np.nan if value is None else value for value in values]
            table[name] = np.array(values)
            continue
        table[name] = np.empty(len(values), object)
        table[name][:] = values
        if all(isinstance(value, str) for value in values):
            table[name] = np.array(values)
    return table


def _flat(row: Dict[str, Any], before: str = "") -> Dict[str, Any]:
    result = {}
    for name, value in row.items():
        if isinstance(value, dict):
            result.update(_flat(value, before + name + "."))
        else:
            result[before + name] = value
    return result


def compare(what: str, path: Union[str, os.PathLike], **options: Any) -> Dict[str, Any]:
    """Compares the variants of something on a scene or points: counted, measured, predicted.

    what : "compose", "partition", "schedule" or "triangulate".
    path : a file, or for the first three a generated scene such as "gen:city:100000".
    options : those of `delray compare`, such as ranks=[2, 4, 8], size=(640, 480), quick=True.

    The result has what `delray compare --stats` writes. Lists of rows are tables: a dict with one
    array for each column, such as result["rows"]["bytes_total"].
    """
    found = json.loads(_render.compare([what, *_arguments(options), "--", os.fspath(path)]))
    return {
        name: _columns(value)
        if isinstance(value, list) and value and all(isinstance(row, dict) for row in value)
        else value
        for name, value in found.items()
    }
