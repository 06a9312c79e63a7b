#!/bin/sh
# What the libraries bring into the program of a client: names of their own alone, no way to print or to end it, and two
# forms of triangulate() of which the linker takes one whole.
# Usage: run_symbols.sh NM libtriangle.a libptriangle.a libptriangle-files.a libptriangle-check.a
set -u
nm=$1
failed=0

# list FLAGS LIBRARY: a line a symbol; those that name a member, with the path of the library, are left out.
list() { "$nm" -P "$@" 2>/dev/null | grep -v ':$'; }

# names FLAG LIBRARY: symbols, sorted.
names() { list "$1" "$2" | awk '{ print $1 }' | sort -u; }

# own LIBRARY PATTERN: all that it defines matches, but for what compilers put into position-independent code (i386).
own() {
    all=$(list -g "$1" | awk '$2 !~ /^[Uwv]$/ { print $1 }' | sort -u)
    [ -n "$all" ] || { echo "symbols: $1 defines nothing"; failed=1; }
    strange=$(echo "$all" | grep -v '^__x86\.get_pc_thunk\.' | grep -vE "$2")
    [ -z "$strange" ] || { echo "symbols: $1 defines" $strange; failed=1; }
}
own "$2" '^(triangulate|triangulate_with|trifree|tri_[a-z0-9_]+)$'
own "$3" '^(triangulate|triangulate_with|par_[a-z0-9_]+)$'
own "$4" '^(tri_[a-z0-9_]+|_Z.*|DW\.ref\..*)$'
own "$5" '^tri_check[a-z0-9_]*$'

refused='[vf]?printf|__v?f?printf_chk|puts|putchar|fputs|fwrite|perror|std(out|err)|_?exit|abort|longjmp|setlocale'
for library in "$2" "$3" "$5"; do
    bad=$(list -A -u "$library" | grep -v '\[aloud\.' | sed 's/^.*\]: //' | awk '{ print $1 }' | sort -u |
        grep -xE "$refused") # but for the one line of triangulate()
    [ -z "$bad" ] || { echo "symbols: $library uses" $bad; failed=1; }
done

# The judge takes nothing from the judged but its predicates, the order of a sweep line, files without a name and, at
# the public door, how arrays are taken.
foreign=$(names -u "$5" | grep '^tri' | grep -vE '^tri_(check.*|fail|order_[a-z]+|scratch_file|file_close|read_again|write_at|(orient2d|dot|incircle|in_circle)_near|api_(figure|struct)_[a-z]+)$')
[ -z "$foreign" ] || { echo "symbols: the judge uses" $foreign; failed=1; }

# Members that define triangulate define the same, so that none of the other library's is needed beside.
entries() {
    list -A -g "$1" | sed 's/^.*\[\(.*\)\]: /\1 /' |
        awk '$3 ~ /^[A-TV-Z]$/ { member[$2] = $1; all[$1] = all[$1] " " $2 } END { print all[member["triangulate"]] }'
}
a=$(entries "$2")
b=$(entries "$3")
if [ -z "$a" ] || [ "$a" != "$b" ]; then
    echo "symbols: triangulate lies with '$a' in the one, with '$b' in the other"
    failed=1
fi
list "$2" | grep -q '^triunsuitable w' || { echo "symbols: triunsuitable is not weak"; failed=1; }

[ "$failed" -eq 0 ] && echo "symbols: as they should be"
exit "$failed"
