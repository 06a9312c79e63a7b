#!/bin/sh
# Help, manual page and completion of a program list the same options, and these are the options that it accepts.
# Usage: run_documents.sh SOURCE_ROOT BUILD_DIR WORK_DIR
set -u
root=$1
build=$2
work=$3
faults=0

fault() {
    echo "documents: $*"
    faults=$((faults + 1))
}

mkdir -p "$work"
cd "$work" || exit 2
for program in triangle ptriangle trianglecheck meshplot; do
    [ -x "$build/bin/$program" ] || continue
    page=$build/documents/$program.1
    "$build/bin/$program" --help >help.txt || fault "$program --help: exit code $?"
    "$build/bin/$program" --version | grep -qx "$program [0-9.]*" || fault "$program --version"
    # Options that the sources accept: tables of {"name", ...}.
    case $program in
    ptriangle) source="$root/drivers/mesh/long_options.c $root/drivers/mesh/size_options.c" ;;
    triangle) source=$root/drivers/mesh/size_options.c ;;
    trianglecheck) source="$root/drivers/judge/trianglecheck.c $root/drivers/mesh/size_options.c" ;;
    *) source=$(echo "$root"/drivers/*/"$program.c") ;;
    esac
    # shellcheck disable=SC2086 # one word a file
    taken=$(grep -ohE '\{"[a-z-]+", *([A-Z]|(required|no)_argument)' $source | sed 's/{"\([a-z-]*\)".*/--\1/')
    [ $program = triangle ] || [ "$(echo "$taken" | wc -l)" -gt 10 ] || fault "$program: no options found in $source"
    [ $program != trianglecheck ] || taken=$(echo "$taken" | grep -vxe --placement -e --optimise)
    told=$(grep -E '^ {2,8}-' help.txt | grep -oE -e '--[a-z-]+')
    for option in $taken; do
        echo "$told" | grep -qxe "$option" || fault "$program: $option is not documented"
    done
    for option in $(grep -oE -e '(^|[ (])--[a-z-]+' help.txt | tr -d ' (' | grep -vxe --name | sort -u); do
        echo "$told" | grep -qxe "$option" || fault "$program: --help mentions $option, which is not an option"
    done
    # shellcheck disable=SC2016 # for the other shell
    completed=$(bash -c '. "$1"; COMP_WORDS=("$2" -); COMP_CWORD=1; "_$2_words"; printf "%s\n" "${COMPREPLY[@]}"' \
        bash "$build/documents/$program" "$program") || fault "$program: completion"
    for option in $told; do
        [ $program = triangle ] || echo "$taken" | grep -qxe "$option" || fault "$program: $option is documented, but not accepted"
        echo "$completed" | grep -qxe "$option" || fault "$program: $option is not completed"
        sed 's/\\-/-/g' "$page" | grep -qE -e "^\.B .*$option( |,|\$)" || fault "$program: $option is not in $page"
    done
    for section in NAME SYNOPSIS DESCRIPTION OPTIONS 'EXIT STATUS' 'SEE ALSO'; do
        grep -q "^\.SH $section" "$page" || fault "$page has no section $section"
    done
    if command -v groff >/dev/null; then
        said=$(groff -man -ww -Tutf8 -z "$page" 2>&1) && [ -z "$said" ] || fault "$page: $said"
    fi
done
# shellcheck disable=SC2016
values=$(bash -c '. "$1"; COMP_WORDS=(ptriangle --numbering b); COMP_CWORD=2; _ptriangle_words; echo "${COMPREPLY[@]}"' \
    bash "$build/documents/ptriangle")
[ ! -x "$build/bin/ptriangle" ] || [ "$values" = blocks ] || fault "ptriangle --numbering b is completed to '$values'"
echo "documents: $faults faults"
[ "$faults" -eq 0 ]
