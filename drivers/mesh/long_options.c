/* One table lists the names. Each option reads its own value. */
#include "drivers/mesh/long_options.h"

#include <float.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "drivers/mesh/streams.h"
#include "drivers/words.h"
#include "triangle/base/system.h"
#include "triangle/text/decimal.h"
#include "triangle/text/formats.h"

const char *const long_options_help[] = {
    "Long options (--name VALUE or --name=VALUE; numbers may have exponents)\n"
    "  --threads N        number of threads. Default: OMP_NUM_THREADS, otherwise SLURM_CPUS_PER_TASK, otherwise\n"
    "                     one for each core. The mesh is the same for any number of threads\n"
    "  --max-area X       same as -aX: no triangle larger than X\n"
    "  --min-angle X      same as -qX: no angle below X degrees\n"
    "  --holes auto       with -p: find the holes from the segments, without hole points. Places that are separated\n"
    "                     from the outside by an even number of segments are removed. Rings may lie in rings\n"
    "  --holes points     find the holes from the hole points of the input (the default)\n"
    "  --output BASE      write BASE.node, BASE.ele, BASE.poly and so on. If BASE ends in .node, .ele or .poly, that\n"
    "                     ending is removed. Any other ending of a dot and letters (.shp) is an error. Names such as\n"
    "                     run.1 and mesh.v2 are allowed; for the name mesh.fine write mesh.fine.node\n"
    "  --output FILE.h5 | FILE.vtkhdf | FILE.vtu | FILE.msh | FILE.2dm | FILE.14 | FILE.grd\n"
    "                     write the mesh as HDF5 (with FILE.xdmf beside it), or for VTK and ParaView, Gmsh, SMS or\n"
    "                     ADCIRC. This replaces BASE.node and so on, unless --output BASE is given as well. Up to 4\n"
    "                     such files\n"
    "  --parts N          cut .msh files into N parts, at most 512 in all. FILE.msh becomes FILE_1.msh ...\n"
    "                     FILE_N.msh, in the format of Gmsh's partitions, with the same numbers as in one file\n"
    "  --report FILE      write times, blocks, memory and mesh statistics as JSON. -: to standard output, where\n"
    "                     with -Q nothing else is printed\n"
    "  --blocks FILE      write the block and phase of each triangle, one per line, for meshplot --blocks\n"
    "  --numbering curve|blocks\n"
    "                     curve (the default): number new vertices and triangles along a space-filling curve, which\n"
    "                     makes solvers faster. blocks: number them in the order in which the blocks of the\n"
    "                     schedule created them, which takes less time\n",

    "  --memory SIZE      memory that the program may use: 500M, 4G (K, M, G, T: powers of 1000), or 60% of what\n"
    "                     the machine has. Default: the memory that is free, within the limits of batch systems. A\n"
    "                     mesh that does not fit is kept partly in files. If that is impossible, the program reports\n"
    "                     an error before the run starts\n"
    "  --scratch DIR      folder for data that do not fit into memory. Default: TMPDIR, otherwise the output folder\n"
    "  --checkpoint DIR   save checkpoints in this folder, so that a run that was stopped or killed can be resumed.\n"
    "                     Its files are removed when the run succeeds. If no checkpoint has been written yet, a\n"
    "                     resumed run starts again from the input\n"
    "  --every MINUTES    time between two checkpoints (default 10). 0: after each step, which is a phase of the\n"
    "                     schedule, or a column of a mesh that is swept. A signal that ends the run also writes a\n"
    "                     checkpoint. With --time-limit the last one is started early enough, according to the\n"
    "                     measured speed of the disk\n"
    "  --resume DIR       continue from the checkpoint in this folder, with the same input and switches and any\n"
    "                     number of threads. The files are the same as those of a run that was never stopped. With\n"
    "                     --checkpoint DIR as well: start a new run if the folder has no checkpoint\n"
    "  --dry-run          estimate triangles, memory, disk and time; refine and write nothing\n"
    "  --time-limit T     stop after T seconds (also 90s, 10m, 2h), with exit code 124\n"
    "  --write-partial    if a time limit or a signal stops refinement, write the current mesh, which is valid. This\n"
    "                     may exceed the limit. Without this option a stopped run writes nothing\n"
    "  --no-sync          do not wait until files of 8 MB or more are on the disk before they get their names. This\n"
    "                     is faster, but a loss of power may leave them empty\n"
    "  --progress         report progress on standard error: one line on a terminal (there the default), otherwise\n"
    "                     one line for each stage. Never with -Q\n"
    "  --no-progress      do not report progress\n"
    "  --version, --help  print name and version; print this help\n",

    NULL,
};

enum id {
    FLAG, NAME, THREADS, MAX_AREA, MIN_ANGLE, HOLES, OUTPUT, PARTS, NUMBERING, MEMORY, EVERY, TIME_LIMIT,
    PROGRESS, NO_PROGRESS
};

static const struct kind {
    const char *name;
    enum id id;
    const char *wanted; /* requirement for a value, for errors; NULL: the option has no value */
    size_t at;          /* for a flag or a name: offset of the member */
} kinds[] = {
    {"threads", THREADS, "not a whole number from 1 to 1024", 0},
    {"max-area", MAX_AREA, "not a number > 0", 0},
    {"min-angle", MIN_ANGLE, "not a number from 0 to 60", 0}, /* no triangle has three angles above 60 degrees */
    {"holes", HOLES, "neither auto nor points", 0},
    {"output", OUTPUT, "", 0},
    {"parts", PARTS, "not a whole number from 1 to 512", 0},
    {"report", NAME, "", offsetof(struct long_options, report)},
    {"blocks", NAME, "", offsetof(struct long_options, blocks)},
    {"numbering", NUMBERING, "neither curve nor blocks", 0},
    {"memory", MEMORY, "not a size such as 500M, 4G or 60%, from 1M on", 0},
    {"scratch", NAME, "", offsetof(struct long_options, scratch)},
    {"checkpoint", NAME, "", offsetof(struct long_options, checkpoint)},
    {"every", EVERY, "not a number of minutes", 0},
    {"resume", NAME, "", offsetof(struct long_options, resume)},
    {"dry-run", FLAG, NULL, offsetof(struct long_options, dry_run)},
    {"time-limit", TIME_LIMIT, "not a time such as 90, 90s, 10m or 2h, from 0.001 s to 1e9 s", 0},
    {"write-partial", FLAG, NULL, offsetof(struct long_options, write_partial)},
    {"no-sync", FLAG, NULL, offsetof(struct long_options, no_sync)},
    {"progress", PROGRESS, NULL, 0},
    {"no-progress", NO_PROGRESS, NULL, 0},
    {"version", FLAG, NULL, offsetof(struct long_options, version)},
    {"help", FLAG, NULL, offsetof(struct long_options, help)},
};

_Static_assert((int)LONG_OPTIONS_MAX_THREADS == 1024 && (int)TRI_MOST_PARTS == 512, "as the errors say");

static const struct kind *find_kind(const char *name, size_t length)
{
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (strlen(kinds[i].name) == length && memcmp(kinds[i].name, name, length) == 0)
            return &kinds[i];
    return NULL;
}

/* --- values; functions return false, and change nothing, if the text is invalid */

/* Reads a whole number from 1 to most. */
static bool read_whole(const char *text, int most, int *value)
{
    int64_t number;
    const char *end = text + strlen(text);
    if (end == text || tri_scan_integer(text, end, &number) != end || number < 1 || number > most)
        return false;
    *value = (int)number;
    return true;
}

static bool read_choice(const char *text, const char *off, const char *on, bool *value)
{
    const bool is_on = strcmp(text, on) == 0, known = is_on || strcmp(text, off) == 0;
    *value = known ? is_on : *value;
    return known;
}

static bool read_value(struct long_options *options, struct tri_switches *switches, enum id id, const char *text)
{
    static const double seconds[] = {1, 60, 3600};
    switch (id) {
    case THREADS: return read_whole(text, LONG_OPTIONS_MAX_THREADS, &options->threads);
    case PARTS: return read_whole(text, TRI_MOST_PARTS, &options->n_parts);
    case MAX_AREA:
        return words_take_real(text, "", NULL, DBL_TRUE_MIN, DBL_MAX, &switches->max_area) &&
               (switches->area = true);
    case MIN_ANGLE: return words_take_real(text, "", NULL, 0, 60, &switches->min_angle) && (switches->angle = true);
    case EVERY: return words_take_real(text, "", NULL, 0, 1e6, &options->every) && (options->has_every = true);
    case TIME_LIMIT: return words_take_real(text, "smh", seconds, 1e-3, 1e9, &options->time_limit);
    case MEMORY: return words_take_size(text, 1e6, &options->memory, &options->memory_share);
    case HOLES: return read_choice(text, "points", "auto", &switches->even_odd);
    case NUMBERING: return read_choice(text, "curve", "blocks", &options->by_block);
    default: return false;
    }
}

int long_options_threads(const struct long_options *options)
{
    const char *openmp = getenv("OMP_NUM_THREADS"), *slurm = getenv("SLURM_CPUS_PER_TASK");
    int threads = options->threads;
    if (threads == 0 && slurm && !(openmp && *openmp))
        (void)read_whole(slurm, LONG_OPTIONS_MAX_THREADS, &threads);
    return threads;
}

/* --- output */

/* Adds a file of another format. */
static enum tri_status add_file(const char **names, int *n, const char *value, struct tri_error *error)
{
    if (*n == LONG_OPTIONS_MOST_EXPORTS)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--output: no more than %d files of other formats",
                        LONG_OPTIONS_MOST_EXPORTS);
    names[(*n)++] = value;
    return TRI_OK;
}

/* Returns true if the last part is a name to which suffixes can be appended. */
static bool is_base(const char *value)
{
    const char *last = value + tri_path_folder_length(value);
    return *last && strcmp(last, ".") != 0 && strcmp(last, "..") != 0 && !tri_name_ends(last, ".h5") &&
           !tri_name_ends(last, ".vtkhdf");
}

static enum tri_status read_output(struct long_options *options, const char *value, struct tri_error *error)
{
    if (tri_name_h5(value) > 0)
        return add_file(options->streams, &options->n_streams, value, error);
    if (tri_format_of(value))
        return add_file(options->exports, &options->n_exports, value, error);
    const char *missing = value[tri_format_base(value)] ? NULL : tri_format_missing(value);
    if (missing)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--output: there is no format %.20s: there are .h5, .vtkhdf, "
                        TRI_FORMAT_SUFFIXES ", and .node, .ele, .poly; for a name with a dot add .node", missing);
    if (!is_base(value))
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0,
                        "--output: \"%.40s\" does not end in a name that .node and so on could go behind", value);
    options->output = value;
    return TRI_OK;
}

enum tri_status long_options_check(const struct long_options *options, struct tri_error *error)
{
    int n_cut = 0;
    for (int i = 0; i < options->n_exports; i++)
        n_cut += tri_format_of(options->exports[i])->write_parts != NULL;
    if (n_cut * options->n_parts > TRI_MOST_PARTS)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--parts: %d parts of each of %d .msh files are more than %d",
                        options->n_parts, n_cut, TRI_MOST_PARTS);
    if (n_cut > 0 || options->n_parts == 0)
        return TRI_OK;
    return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--parts is for .msh files; --output FILE.msh names one");
}

static enum tri_status apply(struct long_options *options, struct tri_switches *switches, const struct kind *kind,
                             const char *value, struct tri_error *error)
{
    void *at = (char *)options + kind->at;
    if ((kind->id == NAME || kind->id == OUTPUT) && !*value)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--%s: the name is empty", kind->name);
    switch (kind->id) {
    case FLAG: *(bool *)at = true; return TRI_OK;
    case NAME: *(const char **)at = value; return TRI_OK;
    case PROGRESS: options->progress = PROGRESS_YES; return TRI_OK;
    case NO_PROGRESS: options->progress = PROGRESS_NO; return TRI_OK;
    case OUTPUT: return read_output(options, value, error);
    default: break;
    }
    if (read_value(options, switches, kind->id, value))
        return TRI_OK;
    return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--%s: \"%.40s\" is %s", kind->name, value, kind->wanted);
}

enum tri_status long_options_take(struct long_options *options, struct tri_switches *switches, int argc,
                                  char *const *argv, int *at, struct tri_error *error)
{
    const char *name = argv[*at] + 2, *equals = strchr(name, '=');
    size_t length = equals ? (size_t)(equals - name) : strlen(name);
    const struct kind *kind = find_kind(name, length);
    const char *value = equals ? equals + 1 : NULL;
    if (!kind)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "there is no option --%.*s (see --help)",
                        (int)(length < 40 ? length : 40), name);
    if (value && !kind->wanted)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--%s takes no value", kind->name);
    if (!value && kind->wanted) {
        if (*at + 1 >= argc)
            return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--%s needs a value", kind->name);
        value = argv[++*at];
    }
    return apply(options, switches, kind, value, error);
}
