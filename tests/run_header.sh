#!/bin/sh
# Compiles triangle/dropin/triangle.h in every way in which known clients include Triangle's header: alone, twice,
# within a namespace, within extern "C", with and without their macros, in old and new dialects of C and C++. Then the
# other public headers in C++.
# Usage: run_header.sh SOURCE_ROOT WORK_DIR C_COMPILER CXX_COMPILER
set -u
root=$1
work=$2
cc=$3
cxx=$4
mkdir -p "$work/only"
cp "$root/triangle/dropin/triangle.h" "$work/only/" # no other header can be included from here
cd "$work" || exit 2
failed=0
count=0

# Typical code of a client. REAL_TYPE is the type that the fields must have.
body='
static void use(struct PREFIXtriangulateio *in, struct PREFIXtriangulateio *out, REAL_TYPE *xy, int *list)
{
    in->pointlist = xy;
    in->trianglelist = list;
    in->numberofpoints = 3;
    PREFIXtriangulate("zQ", in, out, (struct PREFIXtriangulateio *)0);
    PREFIXtrifree(list);
    PREFIXtrifree(out->pointlist);
}
int main(void)
{
    struct PREFIXtriangulate_options options = {0};
    (void)options;
    (void)use;
    return 0;
}'

# try yes|no SOURCE COMPILER...: does it compile?
try() {
    wanted=$1
    name=$2
    shift 2
    count=$((count + 1))
    got=no
    "$@" -Ionly -Wall -Wextra -Werror -pedantic-errors -Wwrite-strings -c "$name" -o object.o >log 2>&1 && got=yes
    if [ "$got" != "$wanted" ]; then
        failed=$((failed + 1))
        echo "header: $*: compiles: $got, wanted: $wanted:"
        sed 's/^/    /' "$name" | head -n 30
        cat log
    fi
}

# client PREFIX REAL_TYPE PRELUDE: writes client.c and client.cpp. In client.cpp the struct is named without the
# keyword.
client() {
    printf '%s\n%s\n' "$3" "$body" | sed "s/PREFIX/$1/g; s/REAL_TYPE/$2/g" >client.c
    sed 's/struct \([a-z:]*triangulateio\)/\1/g; s/= {0}/= {}/' client.c >client.cpp
}
in_c() {
    for std in c89 c99 c11 c2x; do
        try "$1" client.c "$cc" -std=$std -Wstrict-prototypes
    done
}
in_cxx() {
    for std in c++98 c++11 c++20; do
        try "$1" client.cpp "$cxx" -std=$std
    done
}

client '' double '#include "triangle.h"'
in_c yes
in_cxx yes
client '' TRI_REAL '#include <triangle.h>'
in_c yes
in_cxx yes
client '' double 'double REAL(double x);
#include "triangle.h"
double REAL(double x) { return x; }'
in_c yes
in_cxx yes
client '' double '#define TRI_REAL double
#define REAL TRI_REAL
#include "triangle.h"'
in_c yes
in_cxx yes
client '' double '#include "triangle.h"
#include "triangle.h"'
in_c yes
in_cxx yes
client '' double '#define REAL double
#define VOID void
#define ANSI_DECLARATORS
#include "triangle.h"
#undef REAL
#undef VOID
#undef ANSI_DECLARATORS
#include "triangle.h"'
in_c yes
in_cxx yes
client '' double '#define REAL double
#define VOID int
#include "triangle.h"'
in_c yes
in_cxx yes
client '' double 'typedef double REAL;
#include "triangle.h"'
in_c yes
client '' double '#define ANSI_DECLARATORS
#define TRILIBRARY
#define REDUCED
#define CDT_ONLY
#define EXTERNAL_TEST
#define NO_TIMER
#define LINUX
#define CPU86
#define SELF_CHECK
#include "triangle.h"
#undef ANSI_DECLARATORS
int triunsuitable(double *origin, double *destination, double *apex, double area)
{
    return origin[0] + destination[0] + apex[0] > area;
}'
in_c yes
in_cxx yes
client '' double 'extern "C" {
#define REAL double
#define VOID void
#include "triangle.h"
}'
in_cxx yes
client 'inner::' double 'namespace inner { typedef double Real; typedef Real REAL;
extern "C" {
#include "triangle.h"
} }'
in_cxx yes
client 'inner::' double 'namespace inner {
#include "triangle.h"
}'
in_cxx yes
for real in '' '#define REAL float'; do
    client '' float "#define SINGLE
$real
#include \"triangle.h\""
    in_c yes
    in_cxx yes
done

# A coordinate type that the library was not built with.
client '' float '#define REAL float
#include "triangle.h"'
in_c no
in_cxx no
client '' double '#define SINGLE
#define REAL double
#include "triangle.h"'
in_c no
in_cxx no

# The library's own headers, in clients compiled without warnings. All declarations have C linkage.
headers=$(sed -n 's/^ *include\/\(ptriangle\/[a-z_]*\.h\).*/\1/p' "$root/cmake/sources.cmake")
[ "$(echo "$headers" | wc -l)" -eq 5 ] || { echo "header: there are not five public headers"; failed=1; }
cp -r "$root/include/ptriangle" only/
for header in $headers; do
    printf '#include "%s"\n' "$header"
done >client.cpp
cat >>client.cpp <<'END'
int main()
{
    struct tri_figure figure = tri_no_figure();
    struct tri_settings settings = tri_no_settings();
    struct tri_demands demands = tri_no_demands();
    struct tri_verdict verdict;
    struct tri_mesh *mesh = NULL;
    const double xy[] = {0, 0, 1, 0, 0, 1};
    figure.points = tri_reals_of(xy, 3, 2);
    settings.threads = 1;
    if (par_mesh_new(&mesh, &figure, &settings, NULL) == TRI_OK)
        tri_mesh_figure(mesh, &figure);
    tri_mesh_delete(mesh);
    tri_file_free(&figure);
    return (int)tri_check_figure(&figure, NULL, &demands, &verdict, NULL);
}
END
sed 's/int main()/int main(void)/' client.cpp >client.c
for std in c11 c17 c2x; do
    try yes client.c "$cc" -std=$std -Wconversion -Wstrict-prototypes -Wmissing-prototypes
done
for std in c++11 c++14 c++17 c++20; do
    try yes client.cpp "$cxx" -std=$std -Wconversion
done
nm object.o >names.txt
for name in par_mesh_new tri_mesh_figure tri_file_free tri_check_figure; do
    grep -q " U _*$name\$" names.txt || { echo "header: $name has C++ linkage"; failed=$((failed + 1)); }
done

echo "header: $count compilations, $failed wrong"
[ "$failed" -eq 0 ]
