#!/usr/bin/env python3
"""Draws the speed of refinement compared with Triangle: reads the first table of "Beside Triangle" in
docs/performance.md, and writes docs/pictures/speed.svg.

Usage: tools/draw_speed.py    (in the root of the repository)"""
import re

SOURCE, TARGET = "docs/performance.md", "docs/pictures/speed.svg"
LABELS = {"letter": "letter A", "unit": "square", "sea": "sea off Norway", "oceans": "all oceans", "1": "1 M points"}
BARS = [("Triangle 1.6", "#b8b8b8"), ("triangle (ours), 1 core", "#7fb5d5"), ("ptriangle, 2 cores", "#2166ac")]
WIDTH, LEFT, RIGHT, TOP, BAR, GAP = 720, 130, 70, 62, 13, 14


def seconds(cell):
    """The first number of a cell: `0.48 + 0.21` is refinement and numbering, `1.20 (0.95)` median and minimum."""
    return float(re.match(r"[\d.]+", cell).group())


def rows():
    """(label, triangles in millions, seconds of each program, Triangle's time divided by each of them) of each row."""
    with open(SOURCE, encoding="utf-8") as file:
        table = re.search(r"\n## Beside Triangle\n.*?\n\|[-|]+\|\n((?:\|[^\n]*\n)+)", file.read(), re.S)
    for line in table.group(1).splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        million = float(cells[1].split()[0])
        times = [seconds(cells[k]) for k in (2, 3, 5)]
        ratios = re.findall(r"[\d.]+", cells[6])
        yield LABELS[cells[0].split()[0].strip(",")], million, times, ["", ratios[0], ratios[2]]


def text(x, y, words, anchor="start", colour="#222", size=13):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}" font-size="{size}">{words}</text>'


def main():
    data = list(rows())
    rates = [[million / t for t in times] for _, million, times, _ in data]
    scale = (WIDTH - LEFT - RIGHT) / max(map(max, rates))
    height = TOP + len(data) * (3 * BAR + GAP) + 6
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" '
             f'height="{height}" font-family="sans-serif">',
             f'<rect width="{WIDTH}" height="{height}" fill="white"/>',
             text(10, 20, "Refinement: million triangles a second", size=14)]
    x = LEFT
    for name, colour in BARS:
        parts.append(f'<rect x="{x}" y="31" width="12" height="12" fill="{colour}"/>' + text(x + 17, 42, name, size=12))
        x += 40 + 7 * len(name)
    for k, ((label, _, _, ratios), rate) in enumerate(zip(data, rates)):
        y = TOP + k * (3 * BAR + GAP)
        parts.append(text(LEFT - 10, y + 1.5 * BAR + 5, label, "end"))
        for i, value in enumerate(rate):
            times = "" if i == 0 else f" ({ratios[i]} times)"
            parts.append(f'<rect x="{LEFT}" y="{y + i * BAR}" width="{value * scale:.1f}" height="{BAR - 1}" '
                         f'fill="{BARS[i][1]}"/>')
            inside = value * scale > WIDTH - LEFT - RIGHT - 60
            x = LEFT + value * scale + (-6 if inside else 5)
            parts.append(text(x, y + i * BAR + BAR - 3, f"{value:.1f}{times}",
                              "end" if inside else "start", "white" if inside else "#222", 11))
    with open(TARGET, "w", encoding="utf-8") as file:
        file.write("\n".join(parts + ["</svg>"]) + "\n")


main()
