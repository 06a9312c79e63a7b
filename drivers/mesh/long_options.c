/* One table of names; a value is read by the option that asks for it. */
#include "drivers/mesh/long_options.h"

#include <stdlib.h>
#include <string.h>

#include "drivers/mesh/streams.h"
#include "triangle/text/decimal.h"
#include "triangle/text/formats.h"

const char long_options_help[] =
    "Long options (--name VALUE or --name=VALUE; numbers may have exponents)\n"
    "  --threads N        threads to work with. Default: OMP_NUM_THREADS, else SLURM_CPUS_PER_TASK, else\n"
    "                     all cores. The mesh is the same for any number\n"
    "  --max-area X       as -aX: no triangle larger than X\n"
    "  --min-angle X      as -qX: no angle below X degrees\n"
    "  --holes auto       with -p: segments tell what is inside, and no hole points are needed: what lies\n"
    "                     behind an even number of them is removed. Rings may lie in rings\n"
    "  --holes points     hole points tell (the default)\n"
    "  --output BASE      results are called BASE.node, BASE.ele, BASE.poly and so on; one of these endings is no\n"
    "                     part of BASE, and any other of a dot and letters (.shp) is refused: run.1 and mesh.v2 are\n"
    "                     names, and mesh.fine.node says that mesh.fine is one\n"
    "  --output FILE.h5 | FILE.vtu | FILE.msh | FILE.2dm | FILE.14 | FILE.grd\n"
    "                     the mesh as HDF5, with FILE.xdmf beside it, or for VTK and ParaView, Gmsh, SMS or ADCIRC,\n"
    "                     in place of BASE.node and so on, or beside them if --output BASE is given, too; up to 4\n"
    "                     such files\n"
    "  --parts N          .msh files are cut into N parts (512 in all): FILE.msh becomes FILE_1.msh ... FILE_N.msh,\n"
    "                     partitioned as Gmsh does it, with the same numbers as in one file\n"
    "  --report FILE      seconds, blocks, memory and mesh statistics, as JSON; -: on standard output, where\n"
    "                     with -Q nothing else is printed\n"
    "  --blocks FILE      block and phase of each triangle, a line each, for meshplot --blocks\n"
    "  --numbering curve|blocks\n"
    "                     curve: new vertices and triangles are numbered along a space-filling curve, which\n"
    "                     makes solvers faster (the default); blocks, quicker: as the blocks of the schedule\n"
    "                     made them\n"
    "  --memory SIZE      memory that the program may take: 500M, 4G (K, M, G, T: powers of 1024), or 60% of what\n"
    "                     the machine has. Default: what is left, by limits of batch systems too. The program keeps\n"
    "                     within, by files where a mesh does not fit, or refuses before it costs time\n"
    "  --scratch DIR      folder for what does not fit into memory. Default: TMPDIR, else that of the output\n"
    "  --checkpoint DIR   a run keeps in this folder what it needs to go on after it was stopped or killed; at\n"
    "                     the end its files are removed. Before the schedule it starts over\n"
    "  --every MINUTES    the time between two checkpoints (10), 0: after each step: a phase, or a column of a\n"
    "                     mesh that is swept. A signal that ends the run, and --time-limit, take one, too\n"
    "  --resume DIR       goes on from there, with the same input and switches, on any number of threads: the files\n"
    "                     are those of a run that was never stopped. With --checkpoint DIR: or begins\n"
    "  --dry-run          estimate triangles, memory, disk and time; refine and write nothing\n"
    "  --time-limit T     stop after T seconds (also 90s, 10m, 2h), with exit code 124\n"
    "  --write-partial    a run that is stopped while it refines, by the limit or a signal, writes the valid\n"
    "                     mesh that it has, whatever time that takes; else it writes nothing\n"
    "  --progress         say on standard error how far the work is: one line on a terminal (there by\n"
    "                     default), else a line for each stage. Never with -Q\n"
    "  --no-progress      say nothing of that\n"
    "  --version, --help  name and version; this help\n";

enum id {
    THREADS, MAX_AREA, MIN_ANGLE, HOLES, OUTPUT, PARTS, REPORT, BLOCKS, NUMBERING, MEMORY, SCRATCH, CHECKPOINT, EVERY,
    RESUME, DRY_RUN, TIME_LIMIT, WRITE_PARTIAL, PROGRESS, NO_PROGRESS, VERSION, HELP
};

static const struct kind {
    const char *name;
    enum id id;
    bool has_value;
} kinds[] = {
    {"threads", THREADS, true},     {"max-area", MAX_AREA, true},  {"min-angle", MIN_ANGLE, true},
    {"output", OUTPUT, true},       {"report", REPORT, true},      {"blocks", BLOCKS, true},
    {"numbering", NUMBERING, true}, {"progress", PROGRESS, false}, {"no-progress", NO_PROGRESS, false},
    {"dry-run", DRY_RUN, false},    {"time-limit", TIME_LIMIT, true}, {"write-partial", WRITE_PARTIAL, false},
    {"version", VERSION, false},    {"help", HELP, false},         {"holes", HOLES, true},
    {"memory", MEMORY, true},       {"scratch", SCRATCH, true},    {"checkpoint", CHECKPOINT, true},
    {"every", EVERY, true},         {"resume", RESUME, true},      {"parts", PARTS, true},
};

static const struct kind *find_kind(const char *name, size_t length)
{
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (strlen(kinds[i].name) == length && memcmp(kinds[i].name, name, length) == 0)
            return &kinds[i];
    return NULL;
}

/* The whole text is a number. */
static bool is_real(const char *text, double *value)
{
    const char *end = text + strlen(text);
    return end > text && tri_scan_real(text, end, value) == end;
}

/* The whole text is a number from 1 to most; 0: it is not. */
static int number_up_to(int most, const char *text)
{
    int64_t number;
    const char *end = text + strlen(text);
    if (end == text || tri_scan_integer(text, end, &number) != end || number < 1)
        return 0;
    return number <= most ? (int)number : 0;
}

static int number_of_threads(const char *text) { return number_up_to(LONG_OPTIONS_MAX_THREADS, text); }

int long_options_threads(const struct long_options *options)
{
    const char *openmp = getenv("OMP_NUM_THREADS"), *slurm = getenv("SLURM_CPUS_PER_TASK");
    if (options->threads || !slurm || (openmp && *openmp))
        return options->threads;
    return number_of_threads(slurm);
}

static enum tri_status take_threads(struct long_options *options, const char *value, struct tri_error *error)
{
    int threads = number_of_threads(value);
    if (!threads)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--threads: \"%.40s\" is not a whole number from 1 to %d", value,
                        LONG_OPTIONS_MAX_THREADS);
    options->threads = threads;
    return TRI_OK;
}

static enum tri_status take_area(struct tri_switches *switches, const char *value, struct tri_error *error)
{
    double area;
    if (!is_real(value, &area) || !(area > 0 && area <= 1.7976931348623157e308))
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--max-area: \"%.40s\" is not a number > 0", value);
    switches->area = true;
    switches->max_area = area;
    return TRI_OK;
}

/* No triangle has three angles above 60 degrees. */
static enum tri_status take_angle(struct tri_switches *switches, const char *value, struct tri_error *error)
{
    double angle;
    if (!is_real(value, &angle) || !(angle >= 0 && angle <= 60))
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--min-angle: \"%.40s\" is not a number from 0 to 60", value);
    switches->angle = true;
    switches->min_angle = angle;
    return TRI_OK;
}

static enum tri_status take_holes(struct tri_switches *switches, const char *value, struct tri_error *error)
{
    switches->even_odd = strcmp(value, "auto") == 0;
    if (switches->even_odd || strcmp(value, "points") == 0)
        return TRI_OK;
    return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--holes: \"%.40s\" is neither auto nor points", value);
}

static enum tri_status take_numbering(struct long_options *options, const char *value, struct tri_error *error)
{
    options->by_block = strcmp(value, "blocks") == 0;
    if (options->by_block || strcmp(value, "curve") == 0)
        return TRI_OK;
    return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--numbering: \"%.40s\" is neither curve nor blocks", value);
}

/* Seconds, or a number with s, m or h behind it. */
static enum tri_status take_time(struct long_options *options, const char *value, struct tri_error *error)
{
    static const struct {
        char letter;
        double seconds;
    } units[] = {{0, 1}, {'s', 1}, {'m', 60}, {'h', 3600}};
    double number = 0;
    const char *end = tri_scan_real(value, value + strlen(value), &number);
    for (size_t i = 0; end > value && i < sizeof units / sizeof *units; i++) {
        double seconds = number * units[i].seconds;
        if (end[0] != units[i].letter || (end[0] && end[1]) || !(seconds >= 1e-3 && seconds <= 1e9))
            continue;
        options->time_limit = seconds;
        return TRI_OK;
    }
    return tri_fail(error, TRI_BAD_INPUT, NULL, 0,
                    "--time-limit: \"%.40s\" is not a time such as 90, 90s, 10m or 2h, from 0.001 s to 1e9 s", value);
}

static enum tri_status take_every(struct long_options *options, const char *value, struct tri_error *error)
{
    double minutes;
    if (!is_real(value, &minutes) || !(minutes >= 0 && minutes <= 1e6))
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--every: \"%.40s\" is not a number of minutes", value);
    options->every = minutes;
    options->has_every = true;
    return TRI_OK;
}

static bool ends_with(const char *end, char letter) { return end[0] == letter && (letter == 0 || end[1] == 0); }

/* Bytes, a number with K, M, G or T behind it, or a share in per cent. */
static enum tri_status take_memory(struct long_options *options, const char *value, struct tri_error *error)
{
    static const struct {
        char letter;
        double bytes;
    } units[] = {{0, 1}, {'K', 0x1p10}, {'M', 0x1p20}, {'G', 0x1p30}, {'T', 0x1p40}};
    double number = 0;
    const char *end = tri_scan_real(value, value + strlen(value), &number);
    if (end > value && ends_with(end, '%') && number > 0 && number <= 100) {
        options->memory_share = number / 100;
        options->memory = 0;
        return TRI_OK;
    }
    for (size_t i = 0; end > value && i < sizeof units / sizeof *units; i++) {
        double bytes = number * units[i].bytes;
        if (!ends_with(end, units[i].letter) || !(bytes >= 0x1p20 && bytes <= 0x1p60))
            continue;
        options->memory = bytes;
        options->memory_share = 0;
        return TRI_OK;
    }
    return tri_fail(error, TRI_BAD_INPUT, NULL, 0,
                    "--memory: \"%.40s\" is not a size such as 500M, 4G or 60%%, from 1M on", value);
}

static enum tri_status take_name(const char **name, const struct kind *kind, const char *value, struct tri_error *error)
{
    if (!*value)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--%s: the name is empty", kind->name);
    *name = value;
    return TRI_OK;
}

/* One more file of some kind. */
static enum tri_status add_file(const char **names, int *n, const char *value, struct tri_error *error)
{
    if (*n == LONG_OPTIONS_MOST_EXPORTS)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--output: no more than %d files of other formats",
                        LONG_OPTIONS_MOST_EXPORTS);
    names[(*n)++] = value;
    return TRI_OK;
}

/* Is its last part a name that suffixes can go behind? */
static bool is_base(const char *value)
{
    const char *slash = strrchr(value, '/'), *last = slash ? slash + 1 : value;
    return *last && strcmp(last, ".") != 0 && strcmp(last, "..") != 0 && !tri_name_ends(last, STREAM_SUFFIX);
}

static enum tri_status take_output(struct long_options *options, const struct kind *kind, const char *value,
                                   struct tri_error *error)
{
    if (stream_is_wanted(value))
        return add_file(options->streams, &options->n_streams, value, error);
    if (tri_format_of(value))
        return add_file(options->exports, &options->n_exports, value, error);
    const char *missing = value[tri_format_base(value)] ? NULL : tri_format_missing(value);
    if (missing)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--output: there is no format %.20s: there are " STREAM_SUFFIX
                        ", " TRI_FORMAT_SUFFIXES ", and .node, .ele, .poly; for a name with a dot add .node", missing);
    if (*value && !is_base(value))
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0,
                        "--output: \"%.40s\" does not end in a name that .node and so on could go behind", value);
    return take_name(&options->output, kind, value, error);
}

static enum tri_status take_parts(struct long_options *options, const char *value, struct tri_error *error)
{
    options->n_parts = number_up_to(TRI_MOST_PARTS, value);
    if (options->n_parts)
        return TRI_OK;
    return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--parts: \"%.40s\" is not a whole number from 1 to %d", value,
                    TRI_MOST_PARTS);
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
    switch (kind->id) {
    case THREADS: return take_threads(options, value, error);
    case MAX_AREA: return take_area(switches, value, error);
    case MIN_ANGLE: return take_angle(switches, value, error);
    case HOLES: return take_holes(switches, value, error);
    case OUTPUT: return take_output(options, kind, value, error);
    case PARTS: return take_parts(options, value, error);
    case REPORT: return take_name(&options->report, kind, value, error);
    case BLOCKS: return take_name(&options->blocks, kind, value, error);
    case NUMBERING: return take_numbering(options, value, error);
    case TIME_LIMIT: return take_time(options, value, error);
    case MEMORY: return take_memory(options, value, error);
    case SCRATCH: return take_name(&options->scratch, kind, value, error);
    case CHECKPOINT: return take_name(&options->checkpoint, kind, value, error);
    case RESUME: return take_name(&options->resume, kind, value, error);
    case EVERY: return take_every(options, value, error);
    case DRY_RUN: options->dry_run = true; break;
    case WRITE_PARTIAL: options->write_partial = true; break;
    case PROGRESS: options->progress = PROGRESS_YES; break;
    case NO_PROGRESS: options->progress = PROGRESS_NO; break;
    case VERSION: options->version = true; break;
    case HELP: options->help = true; break;
    }
    return TRI_OK;
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
    if (value && !kind->has_value)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--%s takes no value", kind->name);
    if (!value && kind->has_value) {
        if (*at + 1 >= argc)
            return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--%s needs a value", kind->name);
        value = argv[++*at];
    }
    return apply(options, switches, kind, value, error);
}
