/* Parses the string in one pass. Each switch reads what follows its letter and returns the next position. */
#include "triangle/dropin/switches.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double DEFAULT_ANGLE = 20;

enum {
    MAX_DIGITS = 800, /* enough to round every decimal number correctly, since the exact decimal form of a double has
                         at most 767 digits */
    MAX_SHIFT = 100000
};

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

struct tri_switches tri_switches_none(void) { return (struct tri_switches){.max_steiner = -1, .passes = -1}; }

/* Returns the value of a run of digits and dots up to its second dot. The number is passed to strtod as an integer
 * with an exponent, because strtod's decimal point depends on the locale. */
static double value_of(const char *run, const char *end)
{
    char text[MAX_DIGITS + 32];
    size_t n = 0;
    long shift = 0; /* the value is digits * 10^shift */
    bool fraction = false, inexact = false;
    for (; run < end && !(fraction && *run == '.'); run++) {
        if (*run == '.') {
            fraction = true;
        } else if (n < MAX_DIGITS) {
            if (n > 0 || *run != '0')
                text[n++] = *run;
            shift -= fraction && shift > -MAX_SHIFT;
        } else {
            inexact = inexact || *run != '0';
            shift += !fraction && shift < MAX_SHIFT;
        }
    }
    if (n == 0)
        return 0;
    if (inexact)
        text[n - 1] |= 1; /* 0, 2, .. become 1, 3, ..: this only has to break a tie */
    text[n++] = 'e';
    text[n++] = shift < 0 ? '-' : '+';
    char reversed[24];
    int m = 0;
    for (long rest = labs(shift); m == 0 || rest > 0; rest /= 10)
        reversed[m++] = (char)('0' + rest % 10);
    while (m > 0)
        text[n++] = reversed[--m];
    text[n] = 0;
    return strtod(text, NULL);
}

/* Records a number, from its letter to `end`, if text like an exponent follows. */
static void note_exponent(struct tri_switches *s, const char *letter, const char *end)
{
    const char *digits = end + 1;
    if (*end != 'e' && *end != 'E')
        return;
    digits += *digits == '+' || *digits == '-';
    if (!is_digit(*digits) || s->n_notes == TRI_SWITCH_NOTES)
        return;
    while (is_digit(*digits))
        digits++;
    size_t n = (size_t)(digits - letter);
    n = n < TRI_SWITCH_NOTE_CHARS ? n : TRI_SWITCH_NOTE_CHARS - 1;
    memcpy(s->notes[s->n_notes], letter, n);
    s->notes[s->n_notes++][n] = 0;
}

/* Returns the end of the run of digits and dots that begins at `at`. */
static const char *run_end(const char *at)
{
    while (is_digit(*at) || *at == '.')
        at++;
    return at;
}

static const char *add_angle(struct tri_switches *s, const char *letter)
{
    const char *begin = letter + 1, *end = run_end(begin);
    s->angle = true;
    s->min_angle = end > begin ? value_of(begin, end) : DEFAULT_ANGLE;
    if (end > begin)
        note_exponent(s, letter, end);
    return end;
}

static const char *add_area(struct tri_switches *s, const char *letter)
{
    const char *begin = letter + 1, *end = run_end(begin);
    if (end == begin) {
        s->area_lists = true;
        return end;
    }
    s->area = true;
    s->max_area = value_of(begin, end);
    s->bad_area = s->bad_area || !(s->max_area > 0);
    note_exponent(s, letter, end);
    return end;
}

static const char *add_limit(struct tri_switches *s, const char *letter)
{
    const char *at = letter + 1;
    int64_t limit = 0;
    for (; is_digit(*at); at++)
        limit = limit > INT64_MAX / 10 - 10 ? limit : 10 * limit + (*at - '0');
    s->max_steiner = limit;
    if (at > letter + 1)
        note_exponent(s, letter, at);
    return at;
}

/* Returns the flag of a switch without a value, or NULL for another letter. */
static bool *flag_of(struct tri_switches *s, char letter)
{
    switch (letter) {
    case 'p': return &s->segments;
    case 'r': return &s->mesh;
    case 'u': return &s->user_test;
    case 'A': return &s->regions;
    case 'c': return &s->keep_hull;
    case 'D': return &s->conforming;
    case 'j': return &s->jettison;
    case 'e': return &s->edges;
    case 'v': return &s->voronoi;
    case 'n': return &s->neighbors;
    case 'g': return &s->off;
    case 'B': return &s->no_markers;
    case 'P': return &s->no_poly;
    case 'N': return &s->no_node;
    case 'E': return &s->no_ele;
    case 'I': return &s->no_iteration;
    case 'O': return &s->ignore_holes;
    case 'z': return &s->from_zero;
    case 's': return &s->split_recovery;
    case 'w': return &s->weighted;
    case 'W': return &s->weighted;
    case 'C': return &s->check;
    case 'Q': return &s->quiet;
    case 'h': return &s->help;
    case 'H': return &s->help;
    case '?': return &s->help;
    default: return NULL;
    }
}

/* Parses one switch with its value; returns the next position. */
static const char *add_one(struct tri_switches *s, const char *at)
{
    bool *flag = flag_of(s, *at);
    if (flag)
        *flag = true;
    switch (*at) {
    case 'q': return add_angle(s, at);
    case 'a': return add_area(s, at);
    case 'S': return add_limit(s, at);
    case 'V': s->verbosity++; break;
    case 'Y': s->protect += s->protect < 2; break;
    case 'o':
        if (at[1] == '2') {
            s->second_order = true;
            return at + 2;
        }
        break;
    default: break;
    }
    return at + 1;
}

void tri_switches_add(struct tri_switches *switches, const char *text)
{
    while (*text)
        text = add_one(switches, text);
}

enum tri_status tri_switches_check(const struct tri_switches *s, struct tri_error *error)
{
    return s->bad_area ? tri_fail(error, TRI_BAD_INPUT, NULL, 0, "the maximum area (-a) must be > 0") : TRI_OK;
}

void tri_switches_warn(const struct tri_switches *s, void (*warn)(void *user, const char *text, bool misread),
                       void *user)
{
    char text[160];
    for (int i = 0; i < s->n_notes; i++) {
        snprintf(text, sizeof text, "-%s: numbers of switches have no exponent; the e is taken for a switch",
                 s->notes[i]);
        warn(user, text, true);
    }
    if (s->jettison && s->no_node)
        warn(user, "-j and -N: vertices are renumbered, but their new numbers are not written", false);
    if (s->weighted && (s->segments || s->mesh || tri_switches_refine(s)))
        warn(user, "weighted triangulations (-w, -W) are not made with -p, -q, -a, -u or -r: the switch is ignored",
             false);
    const struct tri_quality quality = {.min_angle = s->min_angle, .conforming = s->conforming};
    if (s->angle && s->min_angle < 180 && tri_note_lowered_angle(&quality, text))
        warn(user, text, false);
}

bool tri_switches_refine(const struct tri_switches *s)
{
    return s->angle || s->area || s->area_lists || s->user_test || s->conforming;
}

bool tri_switches_use_regions(const struct tri_switches *s)
{
    return s->segments && !s->mesh && (s->regions || s->area_lists);
}

bool tri_switches_show_segments(const struct tri_switches *s) { return s->segments || s->keep_hull; }

struct tri_grid_options tri_switches_grid(const struct tri_switches *s, const struct tri_mesh *mesh,
                                          const struct tri_pslg *pslg, const struct tri_elements *elements)
{
    return (struct tri_grid_options){.mesh = mesh, .pslg = pslg, .elements = s->mesh ? elements : NULL,
                                     .markers = !s->no_markers,
                                     .regions = s->regions && s->segments && pslg->n_regions > 0,
                                     .jettison = s->jettison, .second_order = s->second_order,
                                     .edges = s->edges || s->voronoi};
}

struct tri_options tri_switches_options(const struct tri_switches *s)
{
    struct tri_options options = tri_defaults();
    options.use_segments = s->segments;
    options.keep_hull = s->keep_hull;
    options.even_odd = s->even_odd;
    options.ignore_holes = s->ignore_holes;
    options.spread_regions = tri_switches_use_regions(s);
    options.refine = tri_switches_refine(s);
    /* No triangle has three angles of 180 degrees. Triangle compares squared cosines, for which this means no bound. */
    options.quality.min_angle = s->angle && s->min_angle < 180 ? s->min_angle : 0;
    options.quality.max_area = s->area ? s->max_area : 0;
    options.quality.region_areas = (s->segments || s->mesh) && s->area_lists;
    options.quality.lattice = !s->mesh && s->placement == TRI_PLACEMENT_LATTICE;
    options.quality.passes = s->passes > 0 ? s->passes : 0;
    options.quality.conforming = s->conforming;
    options.quality.front = s->placement != TRI_PLACEMENT_CLASSIC && tri_allows_front(&options.quality);
    options.quality.protect = s->protect;
    options.quality.max_steiner = s->max_steiner;
    return options;
}
