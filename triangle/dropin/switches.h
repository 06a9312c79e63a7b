/* Switches of Triangle: strings of one-letter switches, some with a number, such as pq30a0.5e.
 *
 * The parser only records the switches; the functions below interpret them. It skips letters that are no switches,
 * digits, dashes, blanks and brackets, so every string is valid. It does not depend on the locale.
 *
 * Numbers: q and a read the longest run of digits and dots directly after them, like strtod; S reads digits. There
 * are no signs and no exponents: a1e-6 means area 1, switch e, and a skipped rest. Since this is probably a mistake,
 * it is recorded. */
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
    double min_angle;    /* degrees; 20 if q has no number */
    bool area;           /* a with a number was given */
    double max_area;     /* > 0 */
    bool area_lists;     /* a without a number: areas of regions (p) or of triangles (r) */
    bool user_test;      /* u */
    bool regions;        /* A */
    bool keep_hull;      /* c */
    bool even_odd;       /* option --holes auto, which has no letter */
    enum tri_placement placement; /* option --placement, which has no letter */
    int passes;          /* option --optimise, which has no letter: smoothing passes; -1: not given */
    bool conforming;     /* D */
    bool jettison;       /* j */
    bool edges, voronoi, neighbors, off; /* e v n g */
    bool no_markers;     /* B */
    bool no_poly, no_node, no_ele; /* P N E */
    bool no_iteration;   /* I */
    bool ignore_holes;   /* O */
    bool from_zero;      /* z */
    bool second_order;   /* o2 */
    int protect;         /* number of Ys: 0, 1, or 2 for two or more */
    int64_t max_steiner; /* S; -1: not given */
    bool split_recovery; /* s: accepted without effect; segments are always recovered without additional vertices */
    bool weighted;       /* w W: accepted without effect */
    bool check;          /* C */
    bool quiet;          /* Q */
    int verbosity;       /* number of Vs */
    bool help;           /* h H ? */
    bool bad_area;       /* true: an area bound that is not > 0 was given, which is an error */
    int n_notes;         /* recorded numbers that look as if they had an exponent */
    char notes[TRI_SWITCH_NOTES][TRI_SWITCH_NOTE_CHARS]; /* each number as it was written */
};

/* Returns the state without any switch. */
struct tri_switches tri_switches_none(void);

/* Adds the switches of a string. Later numbers replace earlier ones. */
void tri_switches_add(struct tri_switches *switches, const char *text);

/* Returns TRI_BAD_INPUT if a switch has an invalid value. */
enum tri_status tri_switches_check(const struct tri_switches *switches, struct tri_error *error);

/* Calls warn with one sentence for each switch that does not have the expected effect. misread: the text was
 * understood differently from how it was written. */
void tri_switches_warn(const struct tri_switches *switches, void (*warn)(void *user, const char *text, bool misread),
                       void *user);

/* Does the quality stage run? */
bool tri_switches_refine(const struct tri_switches *switches);

/* Are the regions of a .poly file (or the list of regions) part of the input? */
bool tri_switches_use_regions(const struct tri_switches *switches);

/* Does the output have segments, unless another switch suppresses them? */
bool tri_switches_show_segments(const struct tri_switches *switches);

/* Returns which parts of a mesh to output. The caller sets base and is_edge. The elements are used with r only. */
struct tri_grid_options tri_switches_grid(const struct tri_switches *switches, const struct tri_mesh *mesh,
                                          const struct tri_pslg *pslg, const struct tri_elements *elements);

/* Returns the options for tri_generate. The caller adds the size test (u) and the input mesh (r). */
struct tri_options tri_switches_options(const struct tri_switches *switches);

#endif
