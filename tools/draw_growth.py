#!/usr/bin/env python3
"""Draws how time and memory grow with the number of triangles: reads the table "How it grows" of docs/scaling.md, and
writes docs/pictures/growth.svg.

Usage: tools/draw_growth.py    (in the root of the repository)"""
import math
import re

SOURCE, TARGET = "docs/scaling.md", "docs/pictures/growth.svg"
WIDTH, HEIGHT, LEFT, TOP, RIGHT, BOTTOM = 640, 360, 60, 20, 60, 40
LOW, HIGH = 7, 9.5  # powers of ten of triangles
SCALES = {"processor seconds": (0, 3.5, "#b2182b"), "megabytes": (2, 4, "#2166ac")}  # powers of ten of each quantity


def points():
    """(triangles, processor seconds, megabytes) of each row."""
    with open(SOURCE) as file:
        text = file.read().split("### How it grows")[1].split("\n#")[0]
    for row in re.findall(r"^\| ([\d.,]+) million \|.*$", text, re.M):
        line = next(l for l in text.splitlines() if l.startswith(f"| {row} million |"))
        cells = [c.strip() for c in line.strip("|").split("|")]
        numbers = [float(re.sub(r"[^\d.]", "", c)) for c in cells[:3]]
        yield 1e6 * numbers[0], numbers[1], numbers[2]


def x_of(triangles):
    return LEFT + (math.log10(triangles) - LOW) / (HIGH - LOW) * (WIDTH - LEFT - RIGHT)


def y_of(value, scale):
    low, high, _ = SCALES[scale]
    return HEIGHT - BOTTOM - (math.log10(value) - low) / (high - low) * (HEIGHT - TOP - BOTTOM)


def text(x, y, words, anchor="middle", colour="#333"):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}">{words}</text>'


def axes():
    yield f'<rect x="{LEFT}" y="{TOP}" width="{WIDTH - LEFT - RIGHT}" height="{HEIGHT - TOP - BOTTOM}" fill="none" ' \
          'stroke="#999"/>'
    for power in range(LOW, math.ceil(HIGH)):
        yield text(x_of(10 ** power), HEIGHT - BOTTOM + 16, f"10<tspan dy='-5' font-size='9'>{power}</tspan>")
    yield text(WIDTH / 2, HEIGHT - 6, "triangles")
    for scale, x, anchor in (("processor seconds", LEFT - 6, "end"), ("megabytes", WIDTH - RIGHT + 6, "start")):
        low, high, colour = SCALES[scale]
        for power in range(low, math.floor(high) + 1):
            yield text(x, y_of(10 ** power, scale) + 4, f"{10 ** power:,}", anchor, colour)
        yield text(x, TOP - 8, scale, "start" if anchor == "end" else "end", colour)


def curve(data, scale, column):
    colour = SCALES[scale][2]
    places = [(x_of(d[0]), y_of(d[column], scale)) for d in data]
    yield f'<polyline fill="none" stroke="{colour}" points="{" ".join(f"{x:.1f},{y:.1f}" for x, y in places)}"/>'
    for x, y in places:
        yield f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>'


def main():
    data = sorted(points())
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" font-family="sans-serif" '
             'font-size="12">', '<rect width="100%" height="100%" fill="white"/>', *axes(),
             *curve(data, "processor seconds", 1), *curve(data, "megabytes", 2), "</svg>"]
    with open(TARGET, "w") as file:
        file.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
