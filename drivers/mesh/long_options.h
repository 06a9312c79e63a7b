/* The long options of ptriangle: words that begin with two dashes. All other words belong to the grammar of Triangle.
 * */
#ifndef DRIVERS_MESH_LONG_OPTIONS_H
#define DRIVERS_MESH_LONG_OPTIONS_H

#include <stdbool.h>

#include "triangle/base/status.h"
#include "triangle/dropin/switches.h"

enum { LONG_OPTIONS_MAX_THREADS = 1024 }; /* more is a slip of the finger, and the system may refuse them */

enum { LONG_OPTIONS_MOST_EXPORTS = 4 };

enum long_options_progress { PROGRESS_DEFAULT, PROGRESS_YES, PROGRESS_NO };

struct long_options {
    int threads;        /* 0: not given */
    const char *output; /* BASE of --output; NULL: not given. Words are borrowed from argv */
    int n_exports;      /* files in other programs' formats */
    const char *exports[LONG_OPTIONS_MOST_EXPORTS]; /* [n_exports] FILE of --output, whose suffix names a format */
    int n_streams;      /* the same for HDF5 */
    const char *streams[LONG_OPTIONS_MOST_EXPORTS]; /* [n_streams] */
    int n_parts;        /* into which such files are cut; 0: not given */
    const char *report; /* file; NULL: none */
    const char *blocks; /* file; NULL: none */
    enum long_options_progress progress;
    bool by_block;      /* --numbering blocks */
    double time_limit;  /* seconds; 0: none */
    double memory;      /* bytes that the process may take; 0: not given, or .. */
    double memory_share; /* .. this share of what the machine has, to 1; 0: not given */
    const char *scratch; /* directory for what does not fit in memory; NULL: not given */
    const char *checkpoint, *resume; /* directories; NULL: not given */
    bool has_every;
    double every;       /* minutes between checkpoints, if given */
    bool write_partial, dry_run;
    bool no_sync;       /* files get their names though the disk may not have them yet */
    bool version, help;
};

/* Where a run that is stopped takes the time to keep its state; NULL: nowhere. */
static inline const char *long_options_state(const struct long_options *o)
{
    return o->resume ? o->resume : o->checkpoint;
}

/* Are there files of other formats, and none of Triangle's? */
static inline bool long_options_exports_alone(const struct long_options *o)
{
    return o->n_exports + o->n_streams > 0 && !o->output;
}

/* Does its name, "-", stand for standard output? */
static inline bool long_options_report_is_printed(const struct long_options *o)
{
    return o->report[0] == '-' && o->report[1] == 0;
}

/* Takes argv[*at], which begins with two dashes, and the next word too where that is its value (--name value; or
 * --name=value in one word); *at becomes the index of the last word taken. --max-area and --min-angle set the switches
 * -a and -q, but take exponents; --holes sets a switch without a letter. What comes later replaces what
 * came before. TRI_BAD_INPUT: an unknown option, a value too many, too few or out of range. */
enum tri_status long_options_take(struct long_options *options, struct tri_switches *switches, int argc,
                                  char *const *argv, int *at, struct tri_error *error);

/* Once all words have been taken: do they agree? TRI_BAD_INPUT. */
enum tri_status long_options_check(const struct long_options *options, struct tri_error *error);

/* Threads to work with: those of --threads, else of OMP_NUM_THREADS, else of SLURM_CPUS_PER_TASK, which a batch system
 * sets; 0: OpenMP decides, as it does where OMP_NUM_THREADS is set. */
int long_options_threads(const struct long_options *options);

/* The help text of the long options: parts to be printed one after the other, then NULL. Compilers may limit the
 * length of one string. */
extern const char *const long_options_help[];

#endif
