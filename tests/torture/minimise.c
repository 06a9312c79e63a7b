/* Delta debugging (Zeller and Hildebrandt 2002): removes smaller and smaller parts, one after another. */
#include "tests/torture/minimise.h"

enum kind { SEGMENTS, HOLES, REGIONS, POINTS, KINDS };

struct search {
    struct torture_case *best;
    case_fails *fails;
    void *user;
    int32_t trials;
};

/* --- copies */

static void *copied(const void *from, int32_t n, size_t item)
{
    void *to = malloc((size_t)n * item + 1);
    assert_non_null(to);
    if (n > 0 && from)
        memcpy(to, from, (size_t)n * item);
    return to;
}

static struct torture_case copy_of(const struct torture_case *c)
{
    struct torture_case copy = *c;
    const struct tri_pslg *p = &c->figure.pslg;
    struct tri_pslg *q = &copy.figure.pslg;
    q->points = copied(p->points, p->n_points, 2 * sizeof *p->points);
    q->markers = p->markers ? copied(p->markers, p->n_points, sizeof *p->markers) : NULL;
    q->attributes = NULL;
    if (p->n_attributes > 0)
        q->attributes = copied(p->attributes, p->n_points, (size_t)p->n_attributes * sizeof *p->attributes);
    q->segments = copied(p->segments, p->n_segments, 2 * sizeof *p->segments);
    q->segment_markers = NULL;
    if (p->segment_markers)
        q->segment_markers = copied(p->segment_markers, p->n_segments, sizeof *p->segment_markers);
    q->holes = copied(p->holes, p->n_holes, 2 * sizeof *p->holes);
    q->regions = copied(p->regions, p->n_regions, 4 * sizeof *p->regions);
    return copy;
}

/* Keeps the trial if it fails in the same way. */
static bool try(struct search *s, struct torture_case *trial)
{
    if (s->trials-- > 0 && s->fails(s->user, trial)) {
        case_free(s->best);
        *s->best = *trial;
        return true;
    }
    case_free(trial);
    return false;
}

/* --- removing items */

/* Removes items first .. last - 1 of an array of n. */
static void cut(void *array, int32_t n, size_t item, int32_t first, int32_t last)
{
    char *at = array;
    if (at)
        memmove(at + (size_t)first * item, at + (size_t)last * item, (size_t)(n - last) * item);
}

static void cut_segments(struct tri_pslg *p, int32_t first, int32_t last)
{
    cut(p->segments, p->n_segments, 2 * sizeof *p->segments, first, last);
    cut(p->segment_markers, p->n_segments, sizeof *p->segment_markers, first, last);
    p->n_segments -= last - first;
}

/* Removes points together with their segments. */
static void cut_points(struct tri_pslg *p, int32_t first, int32_t last)
{
    for (int32_t s = p->n_segments - 1; s >= 0; s--) {
        int32_t *v = p->segments + 2 * (size_t)s;
        bool gone = (v[0] >= first && v[0] < last) || (v[1] >= first && v[1] < last);
        for (int k = 0; k < 2; k++)
            v[k] -= v[k] >= last ? last - first : 0;
        if (gone)
            cut_segments(p, s, s + 1);
    }
    cut(p->points, p->n_points, 2 * sizeof *p->points, first, last);
    cut(p->markers, p->n_points, sizeof *p->markers, first, last);
    cut(p->attributes, p->n_points, (size_t)p->n_attributes * sizeof *p->attributes, first, last);
    p->n_points -= last - first;
}

static int32_t *count_of(struct tri_pslg *p, enum kind kind)
{
    int32_t *counts[KINDS] = {&p->n_segments, &p->n_holes, &p->n_regions, &p->n_points};
    return counts[kind];
}

static void cut_kind(struct tri_pslg *p, enum kind kind, int32_t first, int32_t last)
{
    if (kind == SEGMENTS) {
        cut_segments(p, first, last);
    } else if (kind == POINTS) {
        cut_points(p, first, last);
    } else {
        size_t item = kind == HOLES ? 2 * sizeof(double) : 4 * sizeof(double);
        cut(kind == HOLES ? p->holes : p->regions, *count_of(p, kind), item, first, last);
        *count_of(p, kind) -= last - first;
    }
}

static bool leave_out(struct search *s, enum kind kind)
{
    bool found = false;
    for (int32_t size = *count_of(&s->best->figure.pslg, kind); size > 0; size /= 2) {
        for (int32_t first = 0; first < *count_of(&s->best->figure.pslg, kind) && s->trials > 0;) {
            struct torture_case trial = copy_of(s->best);
            struct tri_pslg *p = &trial.figure.pslg;
            int32_t n = *count_of(p, kind), last = first + size < n ? first + size : n;
            cut_kind(p, kind, first, last);
            bool smaller = (kind != POINTS || p->n_points >= 3) && try(s, &trial);
            found = found || smaller;
            first += smaller ? 0 : size;
        }
    }
    return found;
}

/* --- simplifying */

static void simplify_switches(struct search *s)
{
    for (size_t i = 1; i < strlen(s->best->switches);) {
        struct torture_case trial = copy_of(s->best);
        char *at = trial.switches + i;
        size_t n = 1 + strspn(at + 1, "0123456789.");
        memmove(at, at + n, strlen(at + n) + 1);
        i += try(s, &trial) ? 0 : n;
    }
    for (int k = 0; k < 4; k++) {
        struct torture_case trial = copy_of(s->best);
        struct tri_pslg *p = &trial.figure.pslg;
        if (k == 0)
            trial.block = 0;
        else if (k == 1)
            trial.again = false;
        else if (k == 2)
            p->n_attributes = 0;
        else if (p->segment_markers)
            memset(p->segment_markers, 0, (size_t)p->n_segments * sizeof *p->segment_markers);
        try(s, &trial);
    }
}

static void simplify_numbers(struct search *s)
{
    for (size_t i = 0; i < 2 * (size_t)s->best->figure.pslg.n_points; i++) {
        for (int digits = 1; digits <= 15 && s->trials > 0; digits++) {
            char text[40];
            struct torture_case trial = copy_of(s->best);
            double *x = trial.figure.pslg.points + i, before = *x;
            snprintf(text, sizeof text, "%.*g", digits, *x);
            *x = strtod(text, NULL);
            if (*x == before)
                digits = 15;
            if (try(s, &trial))
                break;
        }
    }
}

void minimise(struct torture_case *c, case_fails *fails, void *user, int32_t trials)
{
    struct search s = {c, fails, user, trials};
    bool smaller = true;
    simplify_switches(&s);
    while (smaller && s.trials > 0) {
        smaller = false;
        for (int kind = 0; kind < KINDS; kind++)
            smaller = leave_out(&s, (enum kind)kind) || smaller;
    }
    simplify_switches(&s);
    simplify_numbers(&s);
}
