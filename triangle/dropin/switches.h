/* Switches of Triangle: strings of one-letter switches, some followed by a number, such as pq30a0.5e.
 *
 * The parser only records what was said; what follows from it is asked of the functions below. Letters that are no
 * switches, digits, dashes, blanks and brackets are skipped, so that every string has a meaning. Independent of the
 * locale.
 *
 * Numbers: q and a take the longest run of digits and dots right behind them, read as strtod would; S takes digits.
 * There are no signs and no exponents: a1e-6 is area 1, switch e, and a rest that is skipped. Since hardly anyone
 * means that, it is noted. */
#ifndef TRIANGLE_DROPIN_SWITCHES_H
#define TRIANGLE_DROPIN_SWITCHES_H

#include <stdbool.h>
#include <stdint.h>

#include "triangle/api/generate.h"
#include "triangle/mesh/grid.h"

enum { TRI_SWITCH_NOTES = 4, TRI_SWITCH_NOTE_CHARS = 32 };

struct tri_switches {
    bool segments;       /* p */
    bool mesh;           /* r: the input is a mesh */
    bool angle;          /* q */
    double min_angle;    /* degrees; q without number: 20 */
    bool area;           /* a with a number */
    double max_area;     /* > 0 */
    bool area_lists;     /* a without number: areas of regions (p) or of triangles (r) */
    bool user_test;      /* u */
    bool regions;        /* A */
    bool keep_hull;      /* c */
    bool even_odd;       /* --holes auto: no letter */
    enum tri_placement placement; /* --placement: no letter */
    int passes;          /* --optimise: passes of smoothing; no letter; -1: not given */
    bool conforming;     /* D */
    bool jettison;       /* j */
    bool edges, voronoi, neighbors, off; /* e v n g */
    bool no_markers;     /* B */
    bool no_poly, no_node, no_ele; /* P N E */
    bool no_iteration;   /* I */
    bool ignore_holes;   /* O */
    bool from_zero;      /* z */
    bool second_order;   /* o2 */
    int protect;         /* how many Y: 0, 1, 2 or more */
    int64_t max_steiner; /* S; -1: not given */
    bool split_recovery; /* s: accepted; segments are recovered without further vertices all the same */
    bool weighted;       /* w W: accepted, no effect */
    bool check;          /* C */
    bool quiet;          /* Q */
    int verbosity;       /* how many V */
    bool help;           /* h H ? */
    bool bad_area;       /* an area bound that is not > 0 was given: an error */
    int n_notes;         /* numbers that look as if they had an exponent, as far as there is room */
    char notes[TRI_SWITCH_NOTES][TRI_SWITCH_NOTE_CHARS]; /* each as it was written */
};

/* Nothing said yet. */
struct tri_switches tri_switches_none(void);

/* Adds the switches of one string to those there are. Later numbers replace earlier ones. */
void tri_switches_add(struct tri_switches *switches, const char *text);

/* TRI_BAD_INPUT: something that cannot be. */
enum tri_status tri_switches_check(const struct tri_switches *switches, struct tri_error *error);

/* Tells in a sentence each of what was said that has not the effect that one might expect. misread: it was taken for
 * something else than what was written. */
void tri_switches_warn(const struct tri_switches *switches, void (*warn)(void *user, const char *text, bool misread),
                       void *user);

/* Does the quality stage run? */
bool tri_switches_refine(const struct tri_switches *switches);

/* Is the section of regions of a .poly file (or the list of regions) part of the input? */
bool tri_switches_use_regions(const struct tri_switches *switches);

/* Are there segments in the output, where nobody suppresses them? */
bool tri_switches_show_segments(const struct tri_switches *switches);

/* What of a mesh is handed out; base and is_edge are the caller's to set. The elements count with r alone. */
struct tri_grid_options tri_switches_grid(const struct tri_switches *switches, const struct tri_mesh *mesh,
                                          const struct tri_pslg *pslg, const struct tri_elements *elements);

/* What tri_generate is to do. The user's test (u) and a mesh as input (r) are the caller's to add. */
struct tri_options tri_switches_options(const struct tri_switches *switches);

#endif
