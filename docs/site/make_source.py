#!/usr/bin/env python3
"""Fills a folder with what Sphinx reads: the pages of docs/, CHANGELOG.md and CONTRIBUTING.md, the list of contents of
docs/index.md, the help text of each program, and pages for the headers and for the Python package.

Links to other files of the repository lead to copies in files/, and links that lead nowhere become text.
Usage: docs/site/make_source.py FOLDER PROGRAMS     in the root of the repository; PROGRAMS: the folder of the programs"""
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path.cwd()
OUTSIDE = {"../CHANGELOG.md": "CHANGELOG.md", "../CONTRIBUTING.md": "CONTRIBUTING.md", "../README.md": "index.md"}
HEADERS = [("tri.h", "Meshes on one core, and everything that the other headers share"), ("par.h", "All cores"),
           ("tiles.h", "Meshes in parts"), ("mpi.h", "The ranks of an MPI"), ("check.h", "Verifying a mesh"),
           ("files.h", "Reading and writing files")]
PYTHON = """\
# Python: names

```{{eval-rst}}
.. automodule:: ptriangle

.. autofunction:: ptriangle.mesh
.. autofunction:: ptriangle.read
.. autoclass:: ptriangle.Mesh
   :members:
.. autoclass:: ptriangle.Verdict
   :members:

Errors and warnings
-------------------

{errors}

ptriangle.gis
-------------

.. automodule:: ptriangle.gis
   :members:

ptriangle.compat
----------------

.. automodule:: ptriangle.compat
   :members:
```
"""
ERRORS = ["Error", "InputError", "TooLargeError", "FileError", "StoppedError", "InputWarning", "EmptyMeshWarning",
          "IgnoredWarning"]


def link(target, folder, page_folder):
    """Where a link of a page leads on the site; None: nowhere. page_folder: that of the page in the repository."""
    path, _, anchor = target.partition("#")
    if not path or "://" in path or target.startswith("mailto:"):
        return target
    place = (page_folder / path).resolve()
    if place.is_dir():
        place = place / "README.md"
    anchor = "#" + anchor if anchor else ""
    if place.suffix == ".md" and place.parent == ROOT / "docs":
        return place.name + anchor
    if place.parent == ROOT and "../" + place.name in OUTSIDE:
        return OUTSIDE["../" + place.name] + anchor
    if not place.is_file():
        return None
    if place.parent.name == "pictures":
        return "pictures/" + place.name
    new = "files/%s%s" % (place.relative_to(ROOT), ".txt" if place.suffix == ".md" else "")
    (folder / new).parent.mkdir(parents=True, exist_ok=True)
    shutil.copy(place, folder / new)
    return new


def page(source, folder):
    text = source.read_text(encoding="utf-8")

    def linked(match):
        new = link(match.group(2), folder, source.parent)
        return match.group(1) if new is None else "[%s](%s)" % (match.group(1), new)

    text = re.sub(r"\[([^]]*)\]\(([^)\s]+)\)", linked, text)
    text = re.sub(r"^```(\S+) \S+$", r"```\1", text, flags=re.M)  # a block that names its file
    return re.sub(r"^```(bat|powershell)$", "```text", text, flags=re.M)


def contents(index):
    """index.md, with a table of contents for the side bar after each of its lists."""
    parts = re.split(r"^## (.*)\n", index, flags=re.M)
    out = [parts[0]]
    for title, body in zip(parts[1::2], parts[2::2]):
        pages = re.findall(r"\]\(([\w-]+)\.md\)", body)
        if title == "Reference":
            pages = pages[:1] + ["python-names", "c", "programs"] + pages[1:]
            body = body.replace("\n- [File", "\n- [Python: names](python-names.md)\n- [C headers](c.md)\n"
                                "- [Programs](programs.md)\n- [File", 1)
        out.append("## %s\n%s\n```{toctree}\n:hidden:\n:caption: %s\n\n%s\n```\n\n" % (title, body, title, "\n".join(pages)))
    return "".join(out)


def programs(folder):
    """programs.md: the help text of each program."""
    text = ["# Programs\n\nEach program prints this text for `--help`.\n"]
    for name in ("triangle", "ptriangle", "trianglecheck", "meshplot"):
        program = folder / name
        if program.exists():
            shown = subprocess.run([program, "--help"], capture_output=True, text=True, check=True).stdout
            text.append("## %s\n\n```text\n%s```\n" % (name, shown))
    return "\n".join(text)


def main():
    folder, bin_folder = Path(sys.argv[1]), Path(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    shutil.copytree(ROOT / "docs" / "pictures", folder / "pictures")
    shutil.copy(ROOT / "docs" / "site" / "conf.py", folder)
    for source in [*sorted((ROOT / "docs").glob("*.md")), ROOT / "CHANGELOG.md", ROOT / "CONTRIBUTING.md"]:
        text = page(source, folder)
        (folder / source.name).write_text(contents(text) if source.name == "index.md" else text, encoding="utf-8")
    (folder / "programs.md").write_text(programs(bin_folder), encoding="utf-8")
    headers = ["# C headers\n"] + ["## %s\n\n%s.\n\n```{doxygenfile} %s\n```\n" % (name, what, name) for name, what in HEADERS]
    headers.append("## triangle.h\n\n```{doxygenfile} triangle.h\n```\n")
    (folder / "c.md").write_text("\n".join(headers), encoding="utf-8")
    errors = "\n".join(".. autoexception:: ptriangle.%s\n   :no-index:" % name for name in ERRORS)
    (folder / "python-names.md").write_text(PYTHON.format(errors=errors), encoding="utf-8")


main()
