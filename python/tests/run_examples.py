"""Runs the examples of a document as they are written, one after the other, in a folder that holds the figures of the
repository's `data` and a link to it. Blocks ```python run in this process. Blocks whose first line names a file
(```text plate.poly) are written to that file. If a block ```text follows a block ```python, the example must print all
of its lines in this order; lines `...` are skipped.

Usage: run_examples.py DOCUMENT FOLDER     an example whose module cannot be imported is skipped, with a line
"""
import contextlib
import io
import os
import re
import shutil
import sys
from pathlib import Path


def blocks(text):
    """(number of the first line, words of the fence, content) of each fenced block."""
    for block in re.finditer(r"^```(\S[^\n]*)\n(.*?)^```$", text, re.M | re.S):
        yield text.count("\n", 0, block.start(2)) + 1, block.group(1).split(), block.group(2)


def first_missing(printed, expected):
    """The first line of `expected` that `printed` lacks, or has too early."""
    lines = iter(printed.splitlines())
    for line in expected.splitlines():
        if line.strip() not in ("", "...") and line not in lines:
            return line
    return None


def run(document):
    names, n_run, skipped, printed = {"__name__": "__main__"}, 0, [], None
    for line, fence, content in blocks(Path(document).read_text(encoding="utf-8")):
        if len(fence) > 1:
            Path(fence[1]).write_text(content, encoding="utf-8")
        if fence == ["text"] and printed is not None:
            missing = first_missing(printed, content)
            if missing is not None:
                sys.exit("%s: line %d: the example before does not print: %s" % (document, line, missing))
        printed = None
        if fence != ["python"]:
            continue
        output = io.StringIO()
        try:
            with contextlib.redirect_stdout(output):
                exec(compile("\n" * (line - 1) + content, str(document), "exec"), names)
            n_run += 1
            printed = output.getvalue()
        except ModuleNotFoundError as fault:
            skipped.append("line %d: %s" % (line, fault))
            printed = None
    return n_run, skipped


if __name__ == "__main__":
    document = Path(sys.argv[1]).resolve()
    os.makedirs(sys.argv[2], exist_ok=True)
    os.chdir(sys.argv[2])
    root = document.parent if (document.parent / "data").exists() else document.parent.parent
    if not os.path.exists("data"):
        os.symlink(root / "data", "data")
    for figure in (root / "data").glob("*.poly"):
        if not os.path.exists(figure.name):
            shutil.copy(figure, ".")
    n_run, skipped = run(document)
    print("%s: %d examples run as they are written, %d skipped" % (document.name, n_run, len(skipped)))
    for text in skipped:
        print("    " + text)
    sys.exit(n_run == 0)
