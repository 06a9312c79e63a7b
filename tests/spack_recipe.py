"""Checks that the Spack recipe is valid Python and uses only options that CMake defines. Spack itself is not needed:
its functions are replaced by stubs.

Usage: spack_recipe.py SOURCE_ROOT
"""

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


def main():
    root = pathlib.Path(sys.argv[1])
    package = types.ModuleType("spack.package")
    vars(package).update(CMakePackage=CMakePackage, variant=variant, license=directive, version=directive,
                         depends_on=directive, conflicts=directive)
    sys.modules.update({"spack": types.ModuleType("spack"), "spack.package": package})
    scope = {}
    exec(compile((root / "tools/spack/package.py").read_text(), "package.py", "exec"), scope)
    options = "".join(file.read_text() for file in [root / "CMakeLists.txt", *(root / "cmake").glob("*.cmake")])
    for on in (False, True):
        for name, _ in scope["Ptriangle"](on).cmake_args():
            assert re.search(rf"(option|set)\({name}\b", options), f"CMake has no option {name}"
    print("spack recipe: passed")


main()
