"""The domains that are measured. Each is written as a new plain file (numbered from 0, no attributes, markers and
comments), so that all programs read the same file and the simplest reader can read it."""
import cmath
import math
import os
import random
from array import array
from dataclasses import dataclass, replace
from decimal import Decimal

import meshfiles

LETTER_A_AREA, LETTER_AREA = 0.084127, 71.865746  # areas of the paper's letter A and of data/letter.poly


@dataclass(frozen=True)
class Domain:
    name: str
    path: str        # plain .poly or .node file
    angle: float     # bounds in degrees and in units of area; 0: none
    area: float

    @property
    def switches(self):
        """The bounds in Triangle's form, whose numbers have no exponent."""
        text = "p" if self.path.endswith(".poly") else ""
        text += f"q{self.angle:g}" if self.angle else ""
        return text + ("a" + format(Decimal(repr(self.area)), "f").removesuffix(".0") if self.area else "")

    @property
    def plain_switches(self):
        """The triangulation without refinement."""
        return "p" if self.path.endswith(".poly") else ""

    def without_bounds(self):
        return replace(self, angle=0, area=0)


def _plain(settings, name, source):
    path = os.path.join(settings.work, "inputs", name + ".poly")
    if not os.path.exists(path) or os.path.getmtime(path) < os.path.getmtime(source):
        meshfiles.write(path, meshfiles.read(source))
    return path


def _data(settings, *name):
    return os.path.join(settings.root, "data", *name)


def letter(settings, area):
    """The paper's letter A if it is available, otherwise a letter R with as many triangles, by scaled bounds."""
    source = os.path.join(settings.shared, "classic_A.poly")
    if os.path.exists(source):
        return Domain("letter A", _plain(settings, "letter_a", source), 20, settings.bound(area))
    source = _data(settings, "letter.poly")
    return Domain("letter R", _plain(settings, "letter_r", source), 20,
                  round(settings.bound(area) * LETTER_AREA / LETTER_A_AREA, 15))


def square(settings, area):
    source = _data(settings, "square_random1000.poly")
    return Domain("unit square, 1,000 points", _plain(settings, "square", source), 20, settings.bound(area))


def plate(settings, area):
    return Domain("plate with 400 holes", _plain(settings, "plate", _data(settings, "perforated.poly")), 20,
                  settings.bound(area))


def norway(settings, angle, area):
    source = _data(settings, "coast", "norway_sea.poly")
    return Domain("sea off Norway", _plain(settings, "norway", source), angle, settings.bound(area))


def shared_coasts(settings, angle, area):
    """Coasts of the world's oceans, if the folder of further inputs exists."""
    found, files = [], [("oceans, 59,000 segments", "coast_ne50m_sea")]
    if not settings.small:  # the angle bound alone gives a million triangles
        files.append(("oceans, 78,000 segments", "coast_gshhg_l_clean"))
    for name, file in files:
        source = os.path.join(settings.shared, file + ".poly")
        if os.path.exists(source):
            found.append(Domain(name, _plain(settings, file, source), angle, settings.bound(area)))
    return found


def wavy_circle(settings, n):
    """A polygon of n points: a circle whose radius has seven waves."""
    path = os.path.join(settings.work, "inputs", f"wavy{n}.poly")
    if not os.path.exists(path):
        pslg = meshfiles.Pslg()
        places = (cmath.rect(1 + 0.2 * math.sin(14 * math.pi * k / n), 2 * math.pi * k / n) for k in range(n))
        pslg.points = array("d", (x for z in places for x in (z.real, z.imag)))
        pslg.segments = array("i", (end for k in range(n) for end in (k, (k + 1) % n)))
        meshfiles.write(path, pslg)
    return Domain(f"polygon of {n:,} points", path, 30, 0)


def random_points(settings, angle, n=1_000_000):
    n = n // 100 if settings.small else n
    path = os.path.join(settings.work, "inputs", f"random{n}.node")
    if not os.path.exists(path):
        source, pslg = random.Random(1), meshfiles.Pslg()
        pslg.points = array("d", (source.random() for _ in range(2 * n)))
        meshfiles.write(path, pslg)
    return Domain(f"{n:,} random points", path, angle, 0)
