/* The long options of ptriangle: words that begin with two dashes. All other words belong to the grammar of Triangle.
 * */
#ifndef DRIVERS_MESH_LONG_OPTIONS_H
#define DRIVERS_MESH_LONG_OPTIONS_H

#include <stdbool.h>

#include "triangle/base/status.h"
#include "triangle/dropin/switches.h"

enum { LONG_OPTIONS_MAX_THREADS = 1024 }; /* a larger number is probably a typing error, and the system may reject it */

enum { LONG_OPTIONS_MOST_EXPORTS = 4 };

enum long_options_progress { PROGRESS_DEFAULT, PROGRESS_YES, PROGRESS_NO };

struct long_options {
    int threads;        /* 0: not given */
    const char *output; /* BASE of --output; NULL: not given. Words are borrowed from argv */
    int n_exports;      /* number of files in formats of other programs */
    const char *exports[LONG_OPTIONS_MOST_EXPORTS]; /* [n_exports] FILE of --output, whose suffix names a format */
    int n_streams;      /* number of HDF5 files */
    const char *streams[LONG_OPTIONS_MOST_EXPORTS]; /* [n_streams] FILE of --output */
    int n_parts;        /* number of parts of .msh files; 0: not given */
    const char *report; /* file of --report; NULL: none */
    const char *blocks; /* file of --blocks; NULL: none */
    enum long_options_progress progress;
    bool by_block;      /* --numbering blocks */
    double time_limit;  /* --time-limit in seconds; 0: none */
    double memory;      /* bytes that the process may use; 0: not given, or given as a share */
    double memory_share; /* share of the machine's memory, at most 1; 0: not given */
    const char *scratch; /* folder for data that do not fit in memory; NULL: not given */
    const char *checkpoint, *resume; /* folders; NULL: not given */
    bool has_every;
    double every;       /* minutes between checkpoints, if has_every */
    bool write_partial, dry_run;
    bool no_sync;       /* files get their names before they are on the disk */
    bool version, help;
};

/* Returns the folder in which a stopped run keeps its state; NULL: none. */
static inline const char *long_options_state(const struct long_options *o)
{
    return o->resume ? o->resume : o->checkpoint;
}

/* Returns true if files of other formats are requested, and none of Triangle's. */
static inline bool long_options_exports_alone(const struct long_options *o)
{
    return o->n_exports + o->n_streams > 0 && !o->output;
}

/* Returns true if the file name is "-", standard output. */
static inline bool long_options_report_is_printed(const struct long_options *o)
{
    return o->report[0] == '-' && o->report[1] == 0;
}

/* Reads the option argv[*at], which begins with two dashes. Its value is part of it (--name=value) or the next argument
 * (--name value). *at becomes the index of the last argument that was read. --max-area and --min-angle set the switches
 * -a and -q, but accept exponents; --holes sets a switch without a letter. Later options replace earlier ones.
 * TRI_BAD_INPUT: an unknown option, a missing or unexpected value, or a value out of range. */
enum tri_status long_options_take(struct long_options *options, struct tri_switches *switches, int argc,
                                  char *const *argv, int *at, struct tri_error *error);

/* Checks, after all arguments, that the options agree. TRI_BAD_INPUT. */
enum tri_status long_options_check(const struct long_options *options, struct tri_error *error);

/* Returns the number of threads: of --threads, otherwise of OMP_NUM_THREADS, otherwise of SLURM_CPUS_PER_TASK, which a
 * batch system sets. 0: OpenMP decides, also if OMP_NUM_THREADS is set. */
int long_options_threads(const struct long_options *options);

/* The help text of the long options: parts to be printed one after the other, then NULL. Compilers may limit the
 * length of one string. */
extern const char *const long_options_help[];

#endif
