"""Exact geometry of small meshes. All decisions use the signs of orientation and incircle, as in the tested programs.

Every double is a rational number. A filter with a generous error bound decides most signs in floating point, and
fractions decide the rest, so ties are exact.
"""
from fractions import Fraction


def sign(value):
    return (value > 0) - (value < 0)


def _orient(a, b, c):
    return (a[0] - c[0]) * (b[1] - c[1]) - (a[1] - c[1]) * (b[0] - c[0])


def orient(a, b, c):
    """1: a, b, c turn left; -1: right; 0: exactly on one line."""
    left, right = (a[0] - c[0]) * (b[1] - c[1]), (a[1] - c[1]) * (b[0] - c[0])
    if abs(left - right) > 1e-14 * (abs(left) + abs(right)) + 1e-290:
        return sign(left - right)
    return sign(_orient(*[(Fraction(p[0]), Fraction(p[1])) for p in (a, b, c)]))


def _incircle(a, b, c, d):
    rows = [(p[0] - d[0], p[1] - d[1]) for p in (a, b, c)]
    (ax, ay), (bx, by), (cx, cy) = rows
    terms = ((ax * ax + ay * ay) * (bx * cy - by * cx), (bx * bx + by * by) * (cx * ay - cy * ax),
             (cx * cx + cy * cy) * (ax * by - ay * bx))
    size = ((ax * ax + ay * ay) * (abs(bx * cy) + abs(by * cx)) + (bx * bx + by * by) * (abs(cx * ay) + abs(cy * ax))
            + (cx * cx + cy * cy) * (abs(ax * by) + abs(ay * bx)))
    return sum(terms), size


def incircle(a, b, c, d):
    """1: d is inside the circle through a, b, c, which turn left; -1: outside; 0: exactly on it."""
    value, size = _incircle(a, b, c, d)
    if abs(value) > 1e-13 * size + 1e-280:
        return sign(value)
    return sign(_incircle(*[(Fraction(p[0]), Fraction(p[1])) for p in (a, b, c, d)])[0])


def area(a, b, c):
    return _orient(a, b, c) / 2


def circumcentre(a, b, c):
    """The crossing, rounded once at the end."""
    (ax, ay), (bx, by), (cx, cy) = [(Fraction(p[0]), Fraction(p[1])) for p in (a, b, c)]
    bx, by, cx, cy = bx - ax, by - ay, cx - ax, cy - ay
    d = 2 * (bx * cy - by * cx)
    b2, c2 = bx * bx + by * by, cx * cx + cy * cy
    return float(ax + (cy * b2 - by * c2) / d), float(ay + (bx * c2 - cx * b2) / d)


def on_segment(p, a, b):
    """Is the point exactly on the closed segment ab?"""
    if orient(a, b, p) != 0:
        return False
    return all(min(a[k], b[k]) <= p[k] <= max(a[k], b[k]) for k in (0, 1))


def near_segment(p, a, b, tolerance):
    dx, dy = b[0] - a[0], b[1] - a[1]
    length2 = dx * dx + dy * dy
    t = ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / length2 if length2 else 0
    t = min(max(t, 0), 1)
    x, y = a[0] + t * dx - p[0], a[1] + t * dy - p[1]
    return x * x + y * y <= tolerance * tolerance


def meet(a, b, c, d):
    """Do the closed segments ab and cd have a common point?"""
    s = orient(a, b, c), orient(a, b, d), orient(c, d, a), orient(c, d, b)
    if s[0] * s[1] < 0 and s[2] * s[3] < 0:
        return True
    return on_segment(c, a, b) or on_segment(d, a, b) or on_segment(a, c, d) or on_segment(b, c, d)


def extent(points):
    """The longer side of the bounding box, or 1 for a single position."""
    return max(max(p[k] for p in points) - min(p[k] for p in points) for k in (0, 1)) or 1
