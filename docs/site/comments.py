#!/usr/bin/env python3
"""Doxygen's input filter: writes a public header with its plain comments as comments for Doxygen.

The first comment describes the file, a comment after code describes the member before it, and any other comment describes
what follows. Comments `--- ...` part sections and are left out. Usage: comments.py HEADER"""
import re
import sys

MARKUP = {"\\": "\\\\", "@": "\\@", "<": "\\<", ">": "\\>", "&": "\\&", "#": "\\#", "%": "\\%", '"': '\\"'}


def plain(text):
    """The words of a comment, with all of Doxygen's commands escaped. Indented lines are code."""
    out, code = [], False
    for k, line in enumerate(text.split("\n")):
        line = re.sub(r"^\s*\* ?", "", line).rstrip() if k else line.rstrip()
        is_code = k > 0 and line.startswith("    ") and text.count("\n *") > 0
        if is_code != code:
            out.append("\\verbatim" if is_code else "\\endverbatim")
            code = is_code
        out.append(line if code else re.sub(r"`([^`]+)`", r"<tt>\1</tt>", "".join(MARKUP.get(c, c) for c in line)))
    return "\n".join(out + ["\\endverbatim"] * code).strip()


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        text = file.read()
    text = re.sub(r"^typedef char .*\n", "", text, flags=re.M)  # checks at compile time
    first = True

    def comment(match):
        nonlocal first
        words = plain(match.group(2))
        if words.startswith("---"):
            return ""
        if first:
            first = False
            return "/** \\file\n%s */" % words
        after_code = match.group(1).strip() != ""
        return match.group(1) + ("/**< %s */" if after_code else "/** %s */") % words

    print(re.sub(r"^([^\n]*?)/\*(.*?)\*/", comment, text, flags=re.M | re.S))


main()
