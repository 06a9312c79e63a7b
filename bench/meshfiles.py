"""Triangle's text files, as far as the benchmark needs them. Written files are plain: numbered from 0, no attributes,
no markers, no comments, so that the simplest reader can read them."""
import contextlib
import os
from array import array


@contextlib.contextmanager
def whole_file(path):
    """Writes a text file completely or not at all, even if the run is stopped."""
    new = f"{path}.{os.getpid()}.new"
    try:
        with open(new, "w", newline="") as file:
            yield file
        os.replace(new, path)
    finally:
        with contextlib.suppress(FileNotFoundError):
            os.remove(new)


def rows(path):
    """Lines as lists of words, without comments and empty lines."""
    with open(path) as file:
        for line in file:
            words = line.split("#", 1)[0].split()
            if words:
                yield words


class Pslg:
    """points: x and y alternating; segments, triangles: point numbers from 0; holes: x and y alternating; regions: x,
    y, attribute, area bound, one region after the other; first: the number of the first point in the files."""

    def __init__(self):
        self.first = 0
        self.points, self.segments, self.holes, self.triangles = array("d"), array("i"), array("d"), array("i")
        self.regions = array("d")


def _read_points(source, header):
    points, first = array("d"), 0
    for i in range(int(header[0])):
        words = next(source)
        if i == 0:
            first = int(words[0])
        points.append(float(words[1]))
        points.append(float(words[2]))
    return points, first


def read(path):
    """A .poly or .node file; the points of a .poly file may be in the .node file beside it."""
    pslg, source = Pslg(), rows(path)
    header = next(source)
    if int(header[0]):
        pslg.points, first = _read_points(source, header)
    else:
        nodes = rows(path[:-len(".poly")] + ".node")
        pslg.points, first = _read_points(nodes, next(nodes))
    pslg.first = first
    if path.endswith(".poly"):
        for _ in range(int(next(source)[0])):
            pslg.segments.extend(int(w) - first for w in next(source)[1:3])
        for _ in range(int(next(source)[0])):
            pslg.holes.extend(float(w) for w in next(source)[1:3])
    return pslg


def read_mesh(path):
    """A mesh: a .poly or .node file with .ele file beside it."""
    pslg, source = read(path), rows(os.path.splitext(path)[0] + ".ele")
    for _ in range(int(next(source)[0])):
        pslg.triangles.extend(int(w) - pslg.first for w in next(source)[1:4])
    return pslg


def _table(file, header, values, width):
    file.write(header + "\n")
    for i in range(len(values) // width):
        file.write(" ".join(map(repr, (i, *values[width * i:width * (i + 1)]))) + "\n")


def write(path, pslg):
    """Writes a .poly file, or a .node file with only the points."""
    with whole_file(path) as file:
        _table(file, f"{len(pslg.points) // 2} 2 0 0", pslg.points, 2)
        if path.endswith(".poly"):
            _table(file, f"{len(pslg.segments) // 2} 0", pslg.segments, 2)
            _table(file, f"{len(pslg.holes) // 2}", pslg.holes, 2)
            _table(file, f"{len(pslg.regions) // 4}", pslg.regions, 4)


def write_mesh(base, points, triangles, segments):
    """Writes base.node, base.ele and, if there are segments, base.poly from flat sequences."""
    with open(base + ".node", "w") as file:
        _table(file, f"{len(points) // 2} 2 0 0", points, 2)
    with open(base + ".ele", "w") as file:
        _table(file, f"{len(triangles) // 3} 3 0", triangles, 3)
    if len(segments):
        with open(base + ".poly", "w") as file:
            file.write("0 2 0 0\n")
            _table(file, f"{len(segments) // 2} 0", segments, 2)
            file.write("0\n")
