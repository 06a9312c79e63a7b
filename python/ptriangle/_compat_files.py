"""Reads Triangle's text files into dictionaries, like the package `triangle`."""
from __future__ import annotations

import os
from typing import Any, Dict, List, Optional, Tuple

import numpy as np

Arrays = Dict[str, Any]
ENDINGS = ("node", "ele", "poly", "area", "edge", "neigh")


class _Numbers:
    """The records of a file: lines of numbers, without comments and empty lines."""

    def __init__(self, text: str) -> None:
        lines = (line.split("#", 1)[0].split() for line in text.splitlines())
        self.records = [words for words in lines if words]
        self.at = 0

    def next(self) -> List[str]:
        self.at += 1
        return self.records[self.at - 1]

    def header(self, n: int) -> List[int]:
        """The next record as n integers, 0 for those that are missing."""
        words = self.next() if self.at < len(self.records) else []
        return [int(word) for word in words[:n]] + [0] * (n - len(words))

    def table(self, n: int, width: int) -> Tuple[int, Any]:
        """Reads n records: the number of the first, and `width` values each, 0 for missing ones."""
        rows = [self.next() for _ in range(n)]
        values = np.zeros((n, width))
        for row, words in zip(values, rows):
            found = [float(word) for word in words[1:width + 1]]
            row[:len(found)] = found
        return int(rows[0][0]) if rows else 0, values

    def regions(self, n: int) -> Any:
        """Reads n regions: x, y, attribute, largest area. A single value after the place is the area."""
        single = [len(words) == 4 for words in self.records[self.at:self.at + n]]
        values = self.table(n, 4)[1]
        values[single, 2:] = values[single, 2:][:, ::-1]
        return values


def _vertices(numbers: _Numbers, data: Arrays) -> Optional[int]:
    """The vertices at the head of .node and .poly files; the number of the first, or None without vertices."""
    n, _, attributes, markers = numbers.header(4)
    if n == 0:
        return None
    first, rows = numbers.table(n, 2 + attributes + markers)
    data["vertices"] = rows[:, :2].copy()
    if attributes:
        data["vertex_attributes"] = rows[:, 2:2 + attributes].copy()
    if markers:
        data["vertex_markers"] = rows[:, 2 + attributes:].astype(np.int32)
    return first


def _node(numbers: _Numbers, data: Arrays, first: int) -> int:
    found = _vertices(numbers, data)
    return first if found is None else found


def _poly(numbers: _Numbers, data: Arrays, first: int) -> int:
    found = _vertices(numbers, data)
    first = first if found is None else found
    n, markers = numbers.header(2)
    if n:
        _, rows = numbers.table(n, 2 + markers)
        data["segments"] = rows[:, :2].astype(np.int32) - np.int32(first)
        if markers:
            data["segment_markers"] = rows[:, 2:].astype(np.int32)
    n, = numbers.header(1)
    if n:
        data["holes"] = numbers.table(n, 2)[1]
    n, = numbers.header(1)
    if n:
        data["regions"] = numbers.regions(n)
    return first


def _ele(numbers: _Numbers, data: Arrays, first: int) -> int:
    n, nodes, attributes = numbers.header(3)
    if n:
        _, rows = numbers.table(n, nodes + attributes)
        data["triangles"] = rows[:, :nodes].astype(np.int32) - np.int32(first)
        if attributes:
            data["triangle_attributes"] = rows[:, nodes:].copy()
    return first


def _area(numbers: _Numbers, data: Arrays, first: int) -> int:
    n, = numbers.header(1)
    if n:
        data["triangle_max_area"] = numbers.table(n, 1)[1]
    return first


def _edge(numbers: _Numbers, data: Arrays, first: int) -> int:
    n, markers = numbers.header(2)
    if n:
        _, rows = numbers.table(n, 2 + markers)
        data["edges"] = rows[:, :2].astype(np.int32) - np.int32(first)
        if markers:
            data["edge_markers"] = rows[:, 2:].astype(np.int32)
    return first


def _neigh(numbers: _Numbers, data: Arrays, first: int) -> int:
    n, _ = numbers.header(2)
    if n:
        found, rows = numbers.table(n, 3)
        rows = rows.astype(np.int32)
        data["neighbors"] = np.where(rows < 0, np.int32(-1), rows - np.int32(found))
    return first


_READERS = {"node": _node, "poly": _poly, "ele": _ele, "area": _area, "edge": _edge, "neigh": _neigh}


def loads(node: Optional[str] = None, ele: Optional[str] = None, poly: Optional[str] = None,
          area: Optional[str] = None, edge: Optional[str] = None, neigh: Optional[str] = None) -> Arrays:
    """Returns the arrays of files given as texts. Indices count from 0, regardless of the files."""
    texts = {"node": node, "poly": poly, "ele": ele, "area": area, "edge": edge, "neigh": neigh}
    data: Arrays = {}
    first = 1
    for ending, text in texts.items():
        if text is not None:
            first = _READERS[ending](_Numbers(text), data, first)
    return data


def load(directory: str, name: str) -> Arrays:
    """Returns the arrays of the existing files among name.node, name.poly, name.ele and so on in a directory."""
    texts = {}
    for ending in ENDINGS:
        path = os.path.join(directory, name + "." + ending)
        if os.path.isfile(path):
            with open(path, encoding="utf-8") as file:
                texts[ending] = file.read()
    return loads(**texts)
