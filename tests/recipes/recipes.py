"""All recipes of packaging/, and all other files that contain the version, agree with CMakeLists.txt. Their options are
options of CMake. The Spack recipe runs as Python, with stubs for the functions of Spack. tools/recipes.sh tests the
recipes themselves.

Usage: recipes.py SOURCE_ROOT
"""

import json
import pathlib
import re
import sys
import types


class CMakePackage:
    """Stub for a function of Spack. Records the definitions."""

    def __init__(self, on):
        self.spec = types.SimpleNamespace(satisfies=lambda text: on == (text[0] == "+"))
        self.on = on

    def define_from_variant(self, name, variant):
        assert variant in VARIANTS, variant
        return name, self.on

    def define(self, name, value):
        return name, value


VARIANTS = []


def directive(*words, **further):
    assert words and all(isinstance(word, str) for word in words), (words, further)


def variant(name, **further):
    directive(name)
    assert further["description"] and isinstance(further["default"], bool)
    VARIANTS.append(name)


def check_spack(root, options):
    package = types.ModuleType("spack.package")
    vars(package).update(CMakePackage=CMakePackage, variant=variant, license=directive, version=directive,
                         depends_on=directive, conflicts=directive)
    sys.modules.update({"spack": types.ModuleType("spack"), "spack.package": package})
    scope = {}
    exec(compile((root / "packaging/spack/package.py").read_text(), "package.py", "exec"), scope)
    for on in (False, True):
        for name, _ in scope["Ptriangle"](on).cmake_args():
            assert name in options, name


def stated_versions(root):
    """(file, version) for each file that contains the version of this tree."""
    places = {
        "debian/changelog": r"\Aptriangle \(([^)]+)\)",
        "CITATION.cff": r"^version: (.*)$",
        "include/ptriangle/tri.h": r'such as "([0-9.]+)"',
        "tests/client/CMakeLists.txt": r"find_package\(ptriangle ([0-9.]+)",
        "tests/client/cxx/CMakeLists.txt": r"find_package\(ptriangle ([0-9.]+)",
    }
    for name, pattern in places.items():
        found = re.findall(pattern, (root / name).read_text(), re.MULTILINE)
        assert found, f"{name} states no version"
        yield from ((name, version) for version in found)
    for file in [*root.glob("*.md"), *(root / "docs").glob("*.md")]:
        found = re.findall(r"ptriangle[-_@](\d+\.\d+\.\d+)", file.read_text())
        yield from ((file.name, version) for version in found)
    for file in (root / "packaging").rglob("*.*"):
        found = re.findall(r"(?:[vV]ersion\W+|ptriangle-)(\d+\.\d+\.\d+)\b(?!\.\d)", file.read_text())
        yield from ((file.name, version) for version in found if version != "1.10.0")  # of winget's manifests
    yield "packaging/vcpkg/vcpkg.json", json.loads((root / "packaging/vcpkg/vcpkg.json").read_text())["version"]


def main():
    root = pathlib.Path(sys.argv[1])
    cmake = "".join(file.read_text() for file in [root / "CMakeLists.txt", *(root / "cmake").glob("*.cmake")])
    options = set(re.findall(r"(?:option|set|find_path|find_library)\((\w+)", cmake)) | {"PTRIANGLE_HDF5"}
    version = re.search(r"^project\(ptriangle VERSION ([0-9.]+)", cmake, re.MULTILINE)[1]
    for name, stated in stated_versions(root):
        assert version in (stated, stated + ".0"), f"{name} has version {stated}, CMakeLists.txt {version}"
    for file in (root / "packaging").rglob("*.*"):
        for name in re.findall(r"(?:-D|\b)(PTRIANGLE_[A-Z0-9_]+)", file.read_text()):
            assert name in options, f"{file.name}: CMake has no option {name}"
    check_spack(root, options)
    print("recipes: passed")


main()
