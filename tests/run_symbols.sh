#!/bin/sh
# The names that the libraries add to a client: only names of their own, no function that prints or ends the program,
# and two forms of triangulate() of which the linker selects one as a whole.
# Usage: run_symbols.sh NM libtriangle.a libptriangle.a libptriangle-files.a libptriangle-check.a
set -u
nm=$1
failed=0

# list FLAGS LIBRARY: one line per symbol. Lines with a member name, which contain the path of the library, are omitted.
list() { "$nm" -P "$@" 2>/dev/null | grep -v ':$'; }

# names FLAG LIBRARY: symbols, sorted.
names() { list "$1" "$2" | awk '{ print $1 }' | sort -u; }

# own LIBRARY PATTERN: all its definitions match, except code that compilers add for position independence (i386).
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
        grep -xE "$refused") # except for the one line of triangulate()
    [ -z "$bad" ] || { echo "symbols: $library uses" $bad; failed=1; }
done

# The checker uses nothing of the mesher except predicates, the order of a sweep line, files without a name and, in the
# public interface, the checks of arrays.
foreign=$(names -u "$5" | grep '^tri' | grep -vE '^tri_(check.*|fail|order_[a-z]+|scratch_file|file_close|read_back|write_at|(orient2d|dot|incircle|in_circle)_near|api_(figure|struct)_[a-z]+)$')
[ -z "$foreign" ] || { echo "symbols: the checker uses" $foreign; failed=1; }

# The members that define triangulate define the same names, so that no member of the other library is needed as well.
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

[ "$failed" -eq 0 ] && echo "symbols: passed"
exit "$failed"
