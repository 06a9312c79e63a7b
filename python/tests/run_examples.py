"""Runs the examples of a document as they are written, one after the other, in a folder of their own, where `data` is
that of the repository.

Usage: run_examples.py DOCUMENT FOLDER     an example whose module cannot be imported is skipped, with a line
"""
import os
import re
import sys
from pathlib import Path


def examples(text):
    """Returns (number of the first line, code) of each block marked as Python."""
    for block in re.finditer(r"^```python\n(.*?)^```$", text, re.M | re.S):
        yield text.count("\n", 0, block.start(1)) + 1, block.group(1)


def run(document):
    names, n_run, skipped = {"__name__": "__main__"}, 0, []
    for line, code in examples(Path(document).read_text(encoding="utf-8")):
        try:
            exec(compile("\n" * (line - 1) + code, str(document), "exec"), names)
            n_run += 1
        except ModuleNotFoundError as fault:
            skipped.append("line %d: %s" % (line, fault))
    return n_run, skipped


if __name__ == "__main__":
    document = Path(sys.argv[1]).resolve()
    os.makedirs(sys.argv[2], exist_ok=True)
    os.chdir(sys.argv[2])
    if not os.path.exists("data"):
        os.symlink(document.parent.parent / "data", "data")
    n_run, skipped = run(document)
    print("%s: %d examples run as they are written, %d skipped" % (document.name, n_run, len(skipped)))
    for text in skipped:
        print("    " + text)
    sys.exit(n_run == 0)
