/* The command line, word by word, and the rules of file names. */
#include "drivers/mesh/arguments.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/system.h"
#include "triangle/text/names.h"

char *next_iteration(const char *name)
{
    const char *dot = strrchr(name + tri_path_folder_length(name), '.'), *digits = dot ? dot + 1 : name;
    size_t n = dot ? strspn(digits, "0123456789") : 0;
    if (n == 0 || digits[n] != 0)
        return tri_joined(name, ".1");
    for (; n > 1 && *digits == '0'; n--)
        digits++;
    size_t kept = n; /* but for nines at the end, which become zeros */
    while (kept > 0 && digits[kept - 1] == '9')
        kept--;
    char *next = malloc(strlen(name) + 2), *at = next;
    if (!next)
        return NULL;
    at = (char *)memcpy(at, name, (size_t)(dot + 1 - name)) + (dot + 1 - name);
    memcpy(at, kept > 0 ? digits : "0", kept > 0 ? kept : 1);
    at += kept > 0 ? kept : 1;
    at[-1]++;
    memset(at, '0', n - kept);
    at[n - kept] = 0;
    return next;
}

struct arguments arguments_begin(int argc, char **argv)
{
    return (struct arguments){.argc = argc, .argv = argv, .switches = tri_switches_none()};
}

void arguments_word(struct arguments *arguments, const char *word)
{
    if (word[0] == '-')
        tri_switches_add(&arguments->switches, word);
    else if (arguments->file)
        arguments->further = word;
    else
        arguments->file = word;
}

static bool cut_suffix(char *name, const char *suffix)
{
    size_t n = strlen(name), m = strlen(suffix);
    if (n < m || strcmp(name + n - m, suffix) != 0)
        return false;
    name[n - m] = 0;
    return true;
}

/* A suffix says what the input is; mesh.14, if there is no such file, is a base. */
static void apply_suffix(struct arguments *arguments)
{
    char *name = arguments->input;
    struct tri_switches *switches = &arguments->switches;
    const struct tri_format *format = tri_format_of(name);
    if (format && (tri_path_allows(name, TRI_THERE) || !tri_name_ends(name, ".14"))) {
        arguments->format = format;
        name[strlen(name) - strlen(format->suffix)] = 0;
        switches->mesh = switches->segments = true;
    }
    if (cut_suffix(name, ".node"))
        return;
    if (cut_suffix(name, ".poly"))
        switches->segments = true;
    else if (cut_suffix(name, ".ele"))
        switches->mesh = true;
    else if (cut_suffix(name, ".area"))
        switches->mesh = switches->area_lists = true;
}

enum tri_status arguments_end(struct arguments *arguments, struct tri_error *error)
{
    if (!arguments->file)
        return TRI_OK;
    if (arguments->further)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "one input file at a time, not both %.80s and %.80s; a number "
                        "follows its switch in one word: -q30", arguments->file, arguments->further);
    arguments->input = tri_joined(arguments->file, "");
    if (arguments->input) {
        apply_suffix(arguments);
        arguments->output = arguments->switches.no_iteration ? tri_joined(arguments->input, "")
                                                             : next_iteration(arguments->input);
    }
    return arguments->output ? TRI_OK : tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for file names");
}

void arguments_free(struct arguments *arguments)
{
    free(arguments->input);
    free(arguments->output);
    size_options_free(&arguments->sizes);
    arguments->input = arguments->output = NULL;
}

/* --- Texts of help, in the form that cmake/help.awk makes manual pages of. Kept in paragraphs, since a compiler need
 * not take strings of any length. */

static const char *const paragraphs[] = {
    "Switches may be joined (-pq30a0.5e) and may stand before or behind the file.\n",

    "Input\n"
    "  file.node  points\n"
    "  file.poly  points, segments, holes, regions (sets -p)\n"
    "  file.ele   triangles (sets -r)\n"
    "  file.area  area bound of each triangle (sets -r and -a)\n"
    "  file.msh   a mesh and its segments, as ptriangle writes them (sets -r and -p); also .vtu, .2dm, .14, .grd\n"
    "Output goes to file.1.node, file.1.ele and so on; the next run of file.1 writes file.2.\n",

    "What to make\n"
    "  -p      the input is a planar straight line graph (.poly): keep its segments, empty its holes\n"
    "  -r      the input is a mesh (.node, .ele): refine it; with -p, keep the segments of its .poly\n"
    "  -c      keep everything inside the convex hull; its edges become segments\n"
    "  -D      conforming: every triangle is Delaunay, not only constrained Delaunay\n"
    "  -O      ignore the holes\n"
    "  -A      give triangles the attribute of the region they lie in\n"
    "  -s      accepted; segments are recovered without further vertices in any case\n",

    "Bounds\n"
    "  -q      no angle below 20 degrees; -q30: below 30. Up to 28 is always reached except next to\n"
    "          small angles of the input and to what is finer than 512 units in the last place of its\n"
    "          largest coordinate. Of 133 real inputs 101 (76%) keep 36, 31 (23%) keep 38.\n"
    "          A bound above 38 is treated as 38, with -D above 36 as 36\n"
    "  -a0.5   no triangle larger than 0.5. The number has no exponent: -a1e-3 means -a1 -e\n"
    "  -a      areas are bounded by the regions of the .poly file or, with -r, by the .area file\n"
    "  --placement lattice|front|classic\n"
    "          lattice (the default): if an area bound alone sets the size and the angle bound is at most 30\n"
    "          degrees, new vertices lie in a hexagonal lattice, which takes a third fewer triangles. Above 30\n"
    "          degrees, and with -r, as classic; with lengths (below) that vary, as front: new vertices grow over\n"
    "          a front from the segments inwards, near-equilateral, at most for 30 degrees. classic leaves both out\n"
    "  -u      a test of the caller's own; without effect on the command line\n"
    "  -Y      do not put vertices on the boundary; -YY: nor on any segment\n"
    "  -S100   at most 100 new vertices (segments that cross get theirs beyond that)\n",

    "Sizes (both forms: --size 500 and --size=500; up to 8 times --size and --size-near: the least length counts)\n"
    "  --size H | FILE\n"
    "          edges shall have about the length H, or at each place that of a field: a raster (.asc; .npy as\n"
    "          FILE.npy@XMIN,YMIN,XMAX,YMAX, the places of its first and its last value) or a mesh with a length\n"
    "          at each point (.node and .ele; .msh of Gmsh and of JIGSAW; .pos; .vtu, .2dm, .14, .grd). Beyond the\n"
    "          field the nearest length counts. Without -q the angle bound is 20 degrees, as for -q\n"
    "  --size-near MARKER:H[,GROWTH]\n"
    "          edges of length H at segments with this marker, growing by GROWTH for a distance of 1 (default:\n"
    "          that of --gradation)\n"
    "  --elements-across N\n"
    "          room for N lengths between boundaries, or borders of regions, that face each other: channels\n"
    "  --per-circle N\n"
    "          where segments follow a curve, N lengths go around a circle of its curvature\n"
    "  --gradation G\n"
    "          lengths of all sources grow by no more than G for a distance of 1 (0.2; inf: no limit).\n"
    "          The default does not limit a GROWTH\n"
    "  --min-size H, --max-size H\n"
    "          no length that is asked for is below, or above H. --max-size alone holds everywhere\n"
    "  --optimise N\n"
    "          N passes of smoothing, which move new vertices inside regions to where triangles are best\n"
    "          (default: 1 with lengths, else 0). Not beside -a, -D or -S\n",

    "Output\n"
    "  -e      also edges (.edge)\n"
    "  -n      also neighbours of triangles (.neigh)\n"
    "  -v      also the Voronoi diagram (.v.node, .v.edge)\n"
    "  -g      also an Object File Format file (.off)\n"
    "  -o2     six nodes a triangle: the corners and the middles of the edges\n"
    "  -z      count from 0 where the input file does not say\n"
    "  -j      leave out vertices that no triangle uses\n"
    "  -B      no boundary markers\n"
    "  -P -N -E  no .poly, .node, .ele file\n"
    "  -I      no iteration number: results are called like the input, which is never overwritten\n",

    "Other\n"
    "  -Q      print nothing but errors\n"
    "  -V      print more; -VV: the same\n"
    "  -C      check the mesh, and say what came of it\n"
    "  -h, --help  this help\n"
    "  --version   name and version\n"
    "  -i -F -l -X -w -W   accepted; the result does not depend on them\n",
};

static const char exit_codes[] =
    "Exit code: 0; 1 after an error; 128 + n after signal n (one that would end a program: it ends within a\n"
    "second and says how far it got). Files appear together, when all are complete and nothing can fail any\n"
    "more: with any other code than 0 no file has been touched, but devices and pipes.\n";

/* Where there are long options. */
static const char further_exit_codes[] =
    "Exit code: 0; 1 after an error; 124 when --time-limit is over; 128 + n after signal n (one that would end\n"
    "a program: it ends within a second, with --checkpoint within five, and says how far it got, and what is\n"
    "kept). Files appear together, when all are complete and nothing can fail any more: with any other code\n"
    "than 0 no file has been touched, but partial meshes and checkpoints where they are asked for, and devices\n"
    "and pipes.\n";

static void print_usage(const char *program)
{
    printf("usage: %s [-prq__a__uAcDjevngBPNEIOXzo_YS__iFlsCQVh] input_file\n", program);
}

void help_usage(const char *program)
{
    print_usage(program);
    puts("  -p  a .poly file: segments and holes   -q  bound on angles      -a  bound on areas\n"
         "  -c  keep the convex hull               -D  conforming Delaunay  -A  region attributes\n"
         "  -e  edges   -n  neighbours             -v  Voronoi diagram      -o2 six-node triangles\n"
         "  -Q  quiet   -V  verbose                -h  all switches");
}

void help_full(const char *program, const char *where, const char *further)
{
    print_usage(program);
    printf("\nMakes triangle meshes of plane figures %s: Delaunay triangulations of points, constrained\n"
           "Delaunay triangulations of points and segments, and meshes whose angles and areas keep bounds.\n", where);
    for (size_t i = 0; i < sizeof paragraphs / sizeof *paragraphs; i++)
        printf("\n%s", paragraphs[i]);
    if (further)
        printf("\n%s", further);
    printf("\n%s", further ? further_exit_codes : exit_codes);
}
