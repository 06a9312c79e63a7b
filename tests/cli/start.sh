# Starting: loading MPI and HDF5 takes longer than making a small mesh, so they are loaded only when needed, from a
# module beside the program, wherever both are installed.

# PTRIANGLE_MODULE_DIR: folder of the modules relative to that of the program; empty: programs contain all code.
far=${PTRIANGLE_MODULE_DIR:-}
if [ -z "$far" ]; then
    echo "cli start: programs without modules"
    exit 0
fi
modules=$bin/$far
names=$(for module in "$modules"/*.so; do basename "$module" .so; done)

fresh letter.poly
for each in $names; do
    if command -v nm >/dev/null; then
        check "$each.so exports only program_main" sh -c \
            '[ "$(nm -D --defined-only "$1" | awk "{ print \$3 }" | grep -v "^program_")" = "" ]' sh "$modules/$each.so"
    fi
    if command -v readelf >/dev/null; then
        check "$each needs MPI or HDF5" sh -c '! readelf -d "$1" | grep -E "NEEDED.*lib(mpi|hdf5)"' sh "$bin/$each"
    fi
    mkdir -p alone/bin alone/links
    cp "$bin/$each" alone/bin/
    ln -s "../bin/$each" alone/links/
done

# Without the module all other functions work, and one line names the missing module.
from() { # from FOLDER CODE PROGRAM WORDS...
    folder=$1
    code=$2
    program=$3
    shift 3
    what="$folder/$program $*"
    checks=$((checks + 1))
    "$folder/$program" "$@" >.out 2>.err
    found=$?
    [ "$found" -eq "$code" ] || fault "exit code $found instead of $code: $(head -n 1 .err)"
}
amiss() {
    complains "^$1: the module for MPI and HDF5 cannot be loaded: .*/ptriangle/*: No such file"
    check "one line" test "$(wc -l <.err)" -eq 1
    check "and nothing else" test ! -s .out
}
from alone/bin 0 ptriangle -Qpq30 letter.poly
from alone/bin 0 trianglecheck letter.1 --poly letter.poly -q 30
from alone/bin 1 ptriangle -Qpq30 letter.poly --output letter.h5
amiss ptriangle
OMPI_COMM_WORLD_SIZE=2 OMPI_COMM_WORLD_RANK=0
export OMPI_COMM_WORLD_SIZE OMPI_COMM_WORLD_RANK
from alone/bin 1 ptriangle -Qpq30 letter.poly
unset OMPI_COMM_WORLD_SIZE OMPI_COMM_WORLD_RANK
amiss ptriangle
from alone/bin 2 trianglecheck letter.h5
amiss trianglecheck

# With the module: moved together, and found through a link.
mkdir -p "alone/bin/$far"
cp "$modules"/*.so "alone/bin/$far/"
if "$bin/ptriangle" -Qpq30 letter.poly --output whole.h5 2>/dev/null; then
    for folder in alone/bin alone/links; do
        rm -f letter.h5
        from "$folder" 0 ptriangle -Qpq30 letter.poly --output=letter.h5
        check "the same bytes" cmp whole.h5 letter.h5
        from "$folder" 0 trianglecheck --quiet letter.h5 --poly letter.poly -q 30
    done
    from alone/bin 0 ptriangle -Qpq30 letter.poly --output LETTER.H5
    check "in capitals, too" cmp whole.h5 LETTER.H5
    from alone/bin 0 trianglecheck --quiet LETTER.H5 --poly letter.poly -q 30
    (PATH=$PWD/alone/links:$PATH && rm letter.h5 && ptriangle -Qpq30 letter.poly --output letter.h5)
    check "found by PATH" cmp whole.h5 letter.h5
fi

# A link in a folder of another user, with a module beside it: not loaded, if the folder or the module belongs to that
# user.
if [ "$(id -u)" -eq 0 ] && chown 65534 "alone/bin/$far/ptriangle.so" 2>/dev/null; then
    chown 0 alone/bin/ptriangle
    for theirs in "alone/bin/$far/ptriangle.so" "alone/bin/$far" alone/bin; do
        chown 0 "alone/bin/$far/ptriangle.so"
        chown 65534 "$theirs"
        from alone/bin 1 ptriangle -Qpq30 letter.poly --output theirs.h5
        complains '^ptriangle: the module for MPI and HDF5 cannot be loaded: .*/alone/bin/.*: belongs neither to root nor to'
        check "one line" test "$(wc -l <.err)" -eq 1
        check "no file" test ! -e theirs.h5
        chown 0 "$theirs"
    done
    chown -R 65534 alone # program and folders have the same owner
    from alone/bin 0 ptriangle -Qpq30 letter.poly --output theirs.h5
    chown -R 0 alone
fi

# A module of another version is refused.
version=$("$bin/ptriangle" --version | sed -n '1s/.* //p')
other=$(echo "$version" | tr 0-9 1-90)
for module in "$modules"/*.so; do
    LC_ALL=C sed "s/$(echo "$version" | sed 's/\./\\./g')/$other/g" "$module" >"alone/bin/$far/$(basename "$module")"
done
from alone/bin 1 ptriangle -Qpq30 letter.poly --output other.h5
complains "^ptriangle $version: .*/ptriangle/ptriangle\.so is that of version $other: "
check "one line" test "$(wc -l <.err)" -eq 1
check "no file" test ! -e other.h5
from alone/bin 2 trianglecheck letter.h5
complains "^trianglecheck $version: .*version $other: "
rm -rf alone
