#!/bin/sh
# Tests the recipes of packaging/ as far as this machine can, on an archive of the last commit. Conan and rattler-build
# come from PyPI. Homebrew and vcpkg are not available from a package registry. Stubs for their functions run the same
# CMake commands, and the tests of the formula.
# Usage: tools/recipes.sh [conan|conda|homebrew|vcpkg ...]     default: all; in build/recipes
set -eu
cd "$(dirname "$0")/.."
root=$PWD
work=$root/build/recipes
version=$(sed -n 's/^project(ptriangle VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
archive=$work/ptriangle-$version.tar.gz
[ $# -gt 0 ] || set -- conan conda homebrew vcpkg
mkdir -p "$work"
git archive --prefix="ptriangle-$version/" -o "$archive" HEAD
sum=$(sha256sum <"$archive" | cut -d ' ' -f 1)

python() { # python PACKAGE...: makes a virtual environment with these packages
    [ -x "$work/venv/bin/python" ] || python3 -m venv "$work/venv"
    "$work/venv/bin/python" -m pip --disable-pip-version-check -q install "$@" || { echo "recipes: no PyPI"; exit 1; }
}

with_archive() { # with_archive FILE: replaces the address of the release by the archive
    sed -i -e "s|https://ptriangle.invalid/releases/ptriangle-[^\"]*\.tar\.gz|file://$archive|" \
        -e "s|0\{64\}|$sum|" "$1"
}

for recipe; do
    echo "== $recipe"
    rm -rf "${work:?}/$recipe"
    mkdir "$work/$recipe"
    case $recipe in
    conan)
        python conan
        cp -R packaging/conan/all "$work/conan/"
        with_archive "$work/conan/all/conandata.yml"
        export CONAN_HOME="$work/conan/home"
        "$work/venv/bin/conan" profile detect >"$work/conan/log" 2>&1
        printf '[platform_tool_requires]\ncmake/%s\n' "$(cmake --version | sed -n 's/^cmake version //p')" \
            >>"$CONAN_HOME/profiles/default"
        for shared in False True; do
            "$work/venv/bin/conan" create "$work/conan/all" --version "$version" -o "&:shared=$shared" --no-remote \
                >"$work/conan/log" 2>&1 || { tail -n 30 "$work/conan/log"; exit 1; }
            grep "ptriangle $version: .* triangles" "$work/conan/log"
        done
        ;;
    conda) # rendered and checked by rattler-build; a build would need the channel conda-forge
        python py-rattler-build
        "$work/venv/bin/python" - packaging/conda-forge/recipe.yaml <<'END'
import sys
from rattler_build import Stage0Recipe, VariantConfig
for variant in Stage0Recipe.from_file(sys.argv[1]).render(VariantConfig({"python": ["3.13"], "c_stdlib": ["sysroot"]})):
    recipe = variant.recipe.to_dict()
    print(recipe["package"], recipe["requirements"]["run"])
END
        ;;
    homebrew)
        tar -xzf "$archive" -C "$work/homebrew"
        ruby -c packaging/homebrew/ptriangle.rb
        (cd "$work/homebrew/ptriangle-$version" && ruby "$root/tests/recipes/homebrew.rb" \
            "$root/packaging/homebrew/ptriangle.rb" "$work/homebrew" >"$work/homebrew/log" 2>&1) ||
            { tail -n 30 "$work/homebrew/log"; exit 1; }
        ls "$work/homebrew/prefix/bin"
        ;;
    vcpkg)
        cmake -DARCHIVE="$archive" -DWORK="$work/vcpkg" -DVERSION="$version" -DPORT="$root/packaging/vcpkg" \
            -P tests/recipes/vcpkg.cmake >"$work/vcpkg/log" 2>&1 || { tail -n 30 "$work/vcpkg/log"; exit 1; }
        (cd "$work/vcpkg/packages" && find . -type f | sort)
        ;;
    *) echo "recipes: no test for $recipe" >&2; exit 2 ;;
    esac
done
echo "recipes: passed"
