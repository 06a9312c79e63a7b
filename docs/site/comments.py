#!/usr/bin/env python3
"""Doxygen's input filter: writes a public header with its plain comments as comments for Doxygen.

The first comment describes the file, a comment after code describes the member before it, and any other comment describes
what follows. Comments `--- ...` part sections and are left out. Usage: comments.py HEADER"""
import re
import sys

MARKUP = {"\\": "\\\\", "@": "\\@", "<": "\\<", ">": "\\>", "&": "\\&", "#": "\\#", "%": "\\%", '"': '\\"'}


def escaped(line):
    return re.sub(r"`([^`]+)`", r"<tt>\1</tt>", "".join(MARKUP.get(c, c) for c in line))


def plain(text):
    """The words of a comment, with Doxygen's commands escaped. Lines indented by four blanks are code. Lines indented by
    two are the entries of a list, `name  meaning`, which go on in lines that are indented further."""
    out, code, in_list = [], False, False
    for k, line in enumerate(text.split("\n")):
        starred = k > 0 and re.match(r"\s*\*", line) is not None
        line = re.sub(r"^\s*\* ?", "", line).rstrip() if k else line.rstrip()
        entry = re.match(r"  (\S.*?\S|\S)  +(\S.*)|  (\S+) (\[.*)", line) if starred else None
        in_list = entry is not None or (in_list and line.startswith("   "))
        is_code = starred and not in_list and line.startswith("    ")
        if is_code != code:
            out.append("\\verbatim" if is_code else "\\endverbatim")
            code = is_code
        if entry:
            name, meaning = (group for group in entry.groups() if group is not None)
            out.append("- <tt>%s</tt>: %s" % (escaped(name), escaped(meaning)))
        elif in_list:
            out.append("  " + escaped(line.strip()))
        else:
            if out and out[-1].startswith(("- ", "  ")) and line and not code:
                out.append("")
            out.append(line if code else escaped(line))
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
