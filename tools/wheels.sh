#!/bin/sh
# Python wheels. One wheel per system serves all versions of Python from 3.9 on. For Linux and macOS the compiler is zig
# from PyPI, which includes their C libraries; for Windows it is mingw-w64 (tools/setup.sh windows).
# Usage: tools/wheels.sh [FOLDER] [SYSTEM...]     default: build/wheels and all systems
#   Systems: manylinux_x86_64 manylinux_aarch64 musllinux_x86_64 musllinux_aarch64 macos_x86_64 macos_arm64 win_amd64
# The wheels are written to FOLDER/dist. The first build for a system compiles its C and C++ libraries, which takes some
# minutes on one core. Later builds take one minute each.
set -eu
cd "$(dirname "$0")/.."
root=$PWD
work=$root/build/wheels
case ${1:-} in
'' | manylinux* | musllinux* | macos* | win*) ;;
*) work=$1; shift ;;
esac
mkdir -p "$work"
work=$(cd "$work" && pwd)
systems="manylinux_x86_64 manylinux_aarch64 musllinux_x86_64 musllinux_aarch64 macos_x86_64 macos_arm64 win_amd64"
# shellcheck disable=SC2086 # words
[ $# -gt 0 ] || set -- $systems

triple() { # zig's name of the system, with the oldest C library that the wheel supports
    case $1 in
    manylinux_*) echo "${1#manylinux_}-linux-gnu.2.17" ;;
    musllinux_*) echo "${1#musllinux_}-linux-musl" ;;
    macos_arm64) echo aarch64-macos.11.0 ;;
    macos_x86_64) echo x86_64-macos.11.0 ;;
    win_amd64) ;;
    *) echo "wheels: no system $1" >&2; return 2 ;;
    esac
}

tag() { # the wheel's platform tag (PEP 600 and 656)
    case $1 in
    manylinux_*) echo "manylinux_2_17_${1#manylinux_}" ;;
    musllinux_*) echo "musllinux_1_1_${1#musllinux_}" ;;
    macos_*) echo "macosx_11_0_${1#macos_}" ;;
    win_*) echo "$1" ;;
    esac
}

toolchain() { # toolchain SYSTEM FOLDER: writes CMake's description of the compiler
    [ "$1" != win_amd64 ] || { mkdir -p "$2" && cp cmake/windows/mingw64.cmake "$2/toolchain.cmake" && return; }
    mkdir -p "$2"
    for driver in cc c++ ar ranlib; do
        target=
        case $driver in c*) target="-target $(triple "$1")" ;; esac
        printf '#!/bin/sh\nexec "%s" -m ziglang %s %s "$@"\n' "$python" "$driver" "$target" >"$2/$driver"
        chmod +x "$2/$driver"
    done
    kernel=Linux
    case $1 in macos_*) kernel=Darwin ;; esac
    cat >"$2/toolchain.cmake" <<END
set(CMAKE_SYSTEM_NAME $kernel)
set(CMAKE_SYSTEM_PROCESSOR ${1#*_})
set(CMAKE_C_COMPILER "$2/cc")
set(CMAKE_CXX_COMPILER "$2/c++")
set(CMAKE_AR "$2/ar")
set(CMAKE_RANLIB "$2/ranlib")
set(CMAKE_FIND_ROOT_PATH "$2") # use no libraries of this machine
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_EXE_LINKER_FLAGS_INIT -s)
set(CMAKE_SHARED_LINKER_FLAGS_INIT -s)
END
    # No installed file needs changed paths.
    [ $kernel = Linux ] || echo "set(CMAKE_INSTALL_NAME_TOOL true)" >>"$2/toolchain.cmake"
}

python=$work/venv/bin/python
[ -x "$python" ] || python3 -m venv "$work/venv"
"$python" -m pip --disable-pip-version-check -q install ziglang scikit-build-core wheel ||
    { echo "wheels: PyPI cannot be reached"; exit 1; }
for system; do
    triple "$system" >/dev/null
    folder=$work/$system
    rm -rf "$folder/wheel"
    toolchain "$system" "$folder/zig"
    "$python" -m pip --disable-pip-version-check wheel --no-build-isolation --no-deps --wheel-dir "$folder/wheel" \
        -C cmake.args="-DCMAKE_TOOLCHAIN_FILE=$folder/zig/toolchain.cmake" -C build-dir="$folder/build" \
        -C install.strip=false "$root" >"$folder/log" 2>&1 || { tail -n 30 "$folder/log"; exit 1; }
    "$python" -m wheel tags --platform-tag "$(tag "$system")" --remove "$folder"/wheel/*.whl >"$folder/log" 2>&1 ||
        { cat "$folder/log"; exit 1; }
    mkdir -p "$work/dist"
    mv "$folder"/wheel/*.whl "$work/dist/"
    ls -l "$work/dist/"*"$(tag "$system")".whl
done
