"""Sphinx: the site of ptriangle. tools/docs.sh calls it, in a folder that docs/site/make_source.py fills."""
import os
import re

project = "ptriangle"
copyright = "the authors of ptriangle, MIT licence"
version = release = os.environ["PTRIANGLE_VERSION"]

extensions = ["myst_parser", "breathe", "sphinx.ext.autodoc"]
myst_heading_anchors = 4
myst_enable_extensions = ["html_image", "strikethrough"]
exclude_patterns = ["files"]

html_theme = "furo"
html_title = "ptriangle " + version
html_static_path = []
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {"navigation_with_keys": True}

breathe_projects = {"ptriangle": os.environ["PTRIANGLE_DOXYGEN"]}
breathe_default_project = "ptriangle"
breathe_domain_by_extension = {"h": "c"}

autodoc_member_order = "bysource"
autodoc_typehints = "none"
nitpicky = False


ITEM = re.compile(r"[a-z_]\w*(, [a-z_]\w*)*( \[[^]]*\])?[:;,]")  # `holes [h, 2]: places`


def as_lists(app, what, name, thing, options, lines):
    """Docstrings are plain text: `name: meaning` at the margin, with further lines indented. They become lists."""
    out, in_list, code = [], False, False
    for k, line in enumerate(lines):
        if k == 0 or not lines[k - 1].strip():  # a paragraph begins
            in_list = k > 0 and ITEM.match(line) is not None
            if line.startswith("    ") != code and line.strip():
                code = not code
                out += ["::", ""] if code else []
        if code:
            out.append(line)
            continue
        line = re.sub(r"[\\*|]|_(?=\W|$)", lambda m: "\\" + m.group(), line)
        line = re.sub(r"`([^`]+)`", r"``\1``", line)
        if in_list and line.strip() and not line.startswith(" "):
            name, colon, meaning = line.partition(":")
            line = "- **%s**:%s" % (name, meaning) if colon and len(name) < 60 else "- " + line
        elif in_list and line.strip():
            line = "  " + line.strip()
        out.append(line)
    lines[:] = out


def setup(app):
    app.connect("autodoc-process-docstring", as_lists)
