/* Parses the command line word by word, and derives the names of input and output files. */
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
    size_t kept = n; /* digits before trailing nines, which become zeros */
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

/* Removes the suffix of the input file and sets the switches that it implies. If there is no file mesh.14, the name
 * mesh.14 is a base name. */
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
    arguments->is_geojson = cut_suffix(name, ".geojson");
    if (arguments->is_geojson || cut_suffix(name, ".poly"))
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
        if (arguments->is_geojson && arguments->sizes.region_polygons)
            return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "the polygons of %.80s are the regions: --region-polygons is"
                            " for other inputs", arguments->file);
        if (arguments->is_geojson)
            arguments->sizes.region_polygons = arguments->file;
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

/* --- Help texts. cmake/help.awk turns them into manual pages, and its head describes the format. The text is split
 * into paragraphs because compilers may limit the length of a string. */

static const char *const paragraphs[] = {
    "Switches may be joined (-pq30a0.5e). They may stand before or after the input file.\n",

    "Input\n"
    "  file.node  points\n"
    "  file.geojson  polygons, each of them a region: the domain is their union (sets -p)\n"
    "  file.poly  points, segments, holes and regions (sets -p)\n"
    "  file.ele   triangles (sets -r)\n"
    "  file.area  the largest area allowed for each triangle (sets -r and -a)\n"
    "  file.msh   a mesh and its segments, as ptriangle writes them (sets -r and -p); also .vtu, .2dm, .14, .grd\n"
    "The results are written to file.1.node, file.1.ele and so on. A run with file.1 as input writes file.2.\n",

    "What to make\n"
    "  -p      read a planar straight line graph (.poly): keep its segments, empty its holes\n"
    "  -r      read a mesh (.node, .ele) and refine it; with -p, keep the segments of its .poly file\n"
    "  -c      keep all triangles inside the convex hull; the edges of the hull become segments\n"
    "  -D      conforming: every triangle is Delaunay, not only constrained Delaunay\n"
    "  -O      ignore the holes\n"
    "  -A      give each triangle the attribute of its region\n"
    "  --region-polygons FILE.geojson\n"
    "          with -p: divide the domain into regions by polygons, of which later ones cover earlier ones. With -A\n"
    "          a triangle has the property attribute of its feature, or the feature's number, counted from 1. With\n"
    "          -a the property area is its largest area. The regions of the input hold outside the polygons\n"
    "  -s      accepted without effect: recovering a segment never needs extra vertices\n",

    "Bounds\n"
    "  -q      no angle below 20 degrees; -q30: below 30. Bounds up to 28 are always reached, except near small\n"
    "          angles of the input and near details finer than 512 units in the last place of the largest\n"
    "          coordinate. Of 133 real inputs, 101 (76%) reach 36 degrees and 31 (23%) reach 38.\n"
    "          A bound above 38 is treated as 38. With -D, a bound above 36 is treated as 36\n"
    "  -a0.5   no triangle larger than 0.5. The number must not have an exponent: -a1e-3 means -a1 -e\n"
    "  -a      read area bounds from the regions of the .poly file or, with -r, from the .area file\n"
    "  --placement lattice|front|classic\n"
    "          where new vertices are placed. lattice (the default): in a hexagonal lattice, which needs a third\n"
    "          fewer triangles. It applies if only an area bound sets the size and the angle bound is at most 30\n"
    "          degrees. With lengths (below) that vary, lattice means front. With -r or above 30 degrees it means\n"
    "          classic. front: vertices advance from the segments inwards and form nearly equilateral triangles,\n"
    "          for angle bounds up to 30 degrees. classic: neither lattice nor front\n"
    "  -u      a size test of the calling program; without effect on the command line\n"
    "  -Y      insert no vertices on the boundary; -YY: on no segment\n"
    "  -S100   insert at most 100 new vertices. Vertices where segments cross are not counted\n",

    "Sizes (--size 500 or --size=500; at most 8 sources by --size and --size-near, the least length counts)\n"
    "  --size H | FILE\n"
    "          make edges about as long as H, or as the length that FILE gives at each place. FILE is a raster\n"
    "          (.asc; or .npy as FILE.npy@XMIN,YMIN,XMAX,YMAX, the positions of its first and last value) or a mesh\n"
    "          with a length at each point (.node and .ele; .msh of Gmsh and of JIGSAW; .pos; .vtu, .2dm, .14,\n"
    "          .grd). Outside the field the nearest length counts. Without -q the angle bound is 20 degrees\n"
    "  --size-near MARKER:H[,GROWTH]\n"
    "          make edges of length H at the segments with this marker. Away from them the length grows by GROWTH\n"
    "          per unit of distance (default: the value of --gradation)\n"
    "  --elements-across N\n"
    "          fit N edge lengths across channels: between boundaries, or borders of regions, that face each other\n"
    "  --per-circle N\n"
    "          on curved boundaries, fit N edge lengths around a circle of the same curvature\n"
    "  --gradation G\n"
    "          let the lengths of all sources grow by at most G per unit of distance (default 0.2; inf: no limit).\n"
    "          The default does not limit a GROWTH\n"
    "  --min-size H, --max-size H\n"
    "          raise shorter lengths to H, or reduce longer ones to H. --max-size alone applies everywhere\n"
    "  --min-edge L\n"
    "          remove details of the input below L before meshing, and print how many. Corners whose triangle with\n"
    "          both neighbours is smaller than L*L/2 go, those with the smallest triangle first (Visvalingam and\n"
    "          Whyatt), and corners at segments shorter than L. Islands smaller than L*L go with the hole points and\n"
    "          regions in them. Corners stay if segments with other markers, or more than two, meet there, or if\n"
    "          segments would cross, touch or come too near. Points of the input have new numbers then\n"
    "  --optimise N\n"
    "          run N passes of smoothing, which move new vertices inside regions to improve the triangles;\n"
    "          from the second pass on edges are flipped as well. A resumed run starts the passes again\n"
    "          (default: 1 with lengths, otherwise 0). Cannot be combined with -a, -D or -S\n",

    "Output\n"
    "  -e      also write the edges (.edge)\n"
    "  -n      also write the neighbours of triangles (.neigh)\n"
    "  -v      also write the Voronoi diagram (.v.node, .v.edge)\n"
    "  -g      also write an Object File Format file (.off)\n"
    "  -o2     six nodes per triangle: the corners and the midpoints of the edges\n"
    "  -z      count from 0 if the input file does not say where it starts\n"
    "  -j      leave out vertices that no triangle uses\n"
    "  -B      no boundary markers\n"
    "  -P -N -E  write no .poly, .node, .ele file\n"
    "  -I      no iteration number: name the results like the input. The input file is never overwritten\n",

    "Other\n"
    "  -Q      print errors only\n"
    "  -V      print more; -VV: the same\n"
    "  -C      check the mesh and print the result\n"
    "  -h, --help  print this help\n"
    "  --version   print name and version\n"
    "  -i -F -l -X -w -W   accepted; the result does not depend on them\n",
};

static const char exit_codes[] =
    "Exit code: 0 for success; 1 after an error; 128 + n after signal n. A signal that would end a program ends\n"
    "the run within a second, and the run reports how far it got. All output files appear together once every\n"
    "one is complete and nothing can fail any more. With any exit code other than 0 no file has changed. Devices\n"
    "and pipes are the exception.\n";

/* For programs with long options. */
static const char further_exit_codes[] =
    "Exit code: 0 for success; 1 after an error; 124 when --time-limit is over; 128 + n after signal n. A signal\n"
    "that would end a program ends the run within a second, or within five with --checkpoint. The run then\n"
    "reports how far it got and what is kept. All output files appear together once every one is complete and\n"
    "nothing can fail any more. With any exit code other than 0 no file has changed. Exceptions are partial\n"
    "meshes and checkpoints, if requested, and devices and pipes.\n";

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

void help_full(const char *program, const char *where, const char *const *further)
{
    print_usage(program);
    printf("\nMakes triangle meshes of plane figures %s: Delaunay triangulations of points, constrained\n"
           "Delaunay triangulations of points and segments, and meshes with bounds on angles and areas.\n", where);
    for (size_t i = 0; i < sizeof paragraphs / sizeof *paragraphs; i++)
        printf("\n%s", paragraphs[i]);
    for (const char *const *part = further; part && *part; part++)
        printf("%s%s", part == further ? "\n" : "", *part);
    printf("\n%s", further ? further_exit_codes : exit_codes);
}
