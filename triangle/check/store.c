/* Stores half-edges in memory, or in files chosen by a hash of their edge, so that all half-edges of an edge are in
 * the same file. */
#include "triangle/check/internal.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/grow.h"
#include "triangle/base/system.h"

enum { MOST_BITS = 9, N_FILES = 1 << MOST_BITS, LEAST_ROOM = 256 };

struct file {
    tri_file kept; /* TRI_NO_FILE: not yet created */
    int64_t n;     /* half-edges in the file */
};

struct check_store {
    struct check_opens here; /* half-edges in memory */
    int64_t most; /* maximum number of half-edges in memory */
    int bits;     /* number of hash bits that choose a file */
    struct file file[N_FILES]; /* the files */
};

enum tri_status tri_check_store_new(struct checker *c)
{
    c->store = calloc(1, sizeof *c->store);
    if (c->store == NULL)
        return TRI_NO_MEMORY;
    for (int k = 0; k < N_FILES; k++)
        c->store->file[k].kept = TRI_NO_FILE;
    c->store->most = INT64_MAX;
    if (c->source->memory <= 0)
        return TRI_OK;
    c->store->most = LEAST_ROOM + (int64_t)fmin(c->source->memory / 8 / sizeof(struct check_open), 0x1p40);
    /* Even if all half-edges are spilled, each file should fit into memory. */
    double files = 3 * (double)c->n_triangles / (double)c->store->most;
    while (c->store->bits < MOST_BITS && (double)(1 << c->store->bits) < files)
        c->store->bits++;
    return TRI_OK;
}

void tri_check_store_free(struct check_store *s)
{
    for (int k = 0; s != NULL && k < N_FILES; k++)
        (void)tri_file_close(s->file[k].kept);
    if (s != NULL)
        free(s->here.at);
    free(s);
}

static int hash(const struct check_open *e)
{
    uint64_t low = (uint64_t)(e->from < e->to ? e->from : e->to), high = (uint64_t)(e->from < e->to ? e->to : e->from);
    uint64_t h = (low * 0x9e3779b97f4a7c15u ^ high) * 0xbf58476d1ce4e5b9u;
    return (int)(h >> (64 - MOST_BITS));
}

static int compare_hashes(const void *a, const void *b)
{
    return hash(a) - hash(b);
}

static int file_of(const struct check_store *s, const struct check_open *e)
{
    return hash(e) >> (MOST_BITS - s->bits);
}

static const char *folder_of(const struct checker *c)
{
    return c->source->scratch != NULL ? c->source->scratch : "/tmp";
}

static enum tri_status fail(struct checker *c)
{
    return tri_fail(c->error, TRI_CANNOT_WRITE, folder_of(c), 0, "cannot write half-edges to a file there: %s",
                    strerror(errno));
}

static bool open_file(const struct checker *c, struct file *file)
{
    if (file->kept == TRI_NO_FILE)
        file->kept = tri_scratch_file(folder_of(c));
    return file->kept != TRI_NO_FILE;
}

/* Moves all half-edges from memory to the files. */
static enum tri_status spill(struct checker *c)
{
    struct check_store *s = c->store;
    struct check_open *at = s->here.at;
    if (s->here.n > 1)
        qsort(at, (size_t)s->here.n, sizeof *at, compare_hashes);
    for (int64_t i = 0, j; i < s->here.n; i = j) {
        struct file *file = &s->file[file_of(s, &at[i])];
        for (j = i + 1; j < s->here.n && file_of(s, &at[j]) == file_of(s, &at[i]); j++) {
        }
        if (!open_file(c, file) ||
            !tri_write_at(file->kept, at + i, (size_t)(j - i) * sizeof *at, (uint64_t)file->n * sizeof *at))
            return fail(c);
        file->n += j - i;
    }
    s->here.n = 0;
    return TRI_OK;
}

enum tri_status tri_check_store_add(struct checker *c, struct check_open e)
{
    enum tri_status status = c->store->here.n >= c->store->most ? spill(c) : TRI_OK;
    struct check_opens *here = &c->store->here;
    if (status == TRI_OK && !tri_grow_far(&here->at, &here->room, here->n + 1, sizeof *here->at))
        return TRI_NO_MEMORY;
    if (status == TRI_OK)
        here->at[here->n++] = e;
    return status;
}

static enum tri_status fetch(struct checker *c, struct file *file)
{
    struct check_opens *here = &c->store->here;
    if (file->n > here->room) {
        free(here->at);
        here->room = 0;
        here->at = tri_check_array(file->n, sizeof *here->at);
        if (here->at == NULL)
            return TRI_NO_MEMORY;
        here->room = file->n;
    }
    here->n = file->n;
    if (!tri_read_back(file->kept, here->at, (size_t)here->n * sizeof *here->at, 0))
        return tri_fail(c->error, TRI_CANNOT_READ, folder_of(c), 0, "cannot read half-edges from a file there");
    (void)tri_file_close(file->kept);
    *file = (struct file){TRI_NO_FILE, 0};
    return TRI_OK;
}

/* Calls `take` with all half-edges of each file, or with those in memory if nothing was spilled. `take` may sort
 * them. The store is empty afterwards. */
static enum tri_status drain(struct checker *c,
                             enum tri_status (*take)(struct checker *c, struct check_open *at, int64_t n))
{
    struct check_store *s = c->store;
    bool spilled = false;
    for (int k = 0; k < N_FILES; k++)
        spilled = spilled || s->file[k].n > 0;
    enum tri_status status = spilled ? spill(c) : take(c, s->here.at, s->here.n);
    for (int k = 0; k < N_FILES && status == TRI_OK; k++) {
        if (s->file[k].n == 0)
            continue;
        status = fetch(c, &s->file[k]);
        status = status == TRI_OK ? take(c, s->here.at, s->here.n) : status;
    }
    free(s->here.at);
    s->here = (struct check_opens){0};
    return status;
}

/* After the last part, matches the half-edges that have no twin within their own part.
 *
 * Sorted by edge, the two half-edges of an edge are adjacent. A single one is a boundary edge. More than two, or two
 * with the same direction, are faults and also count as boundary edges. */

static int compare_edges(const struct check_open *a, const struct check_open *b)
{
    int64_t low = a->from < a->to ? a->from : a->to, other = b->from < b->to ? b->from : b->to;
    int64_t high = a->from + a->to - low, far = b->from + b->to - other;
    return low != other ? (low < other ? -1 : 1) : (high > far) - (high < far);
}

static int compare_opens(const void *left, const void *right)
{
    const struct check_open *a = left, *b = right;
    int order = compare_edges(a, b);
    return order != 0 ? order : (a->half_edge > b->half_edge) - (a->half_edge < b->half_edge);
}

static int compare_half_edges(const void *left, const void *right)
{
    const struct check_boundary_edge *a = left, *b = right;
    return (a->half_edge > b->half_edge) - (a->half_edge < b->half_edge);
}

/* Reports the first half-edge of a faulty edge; all count as faults. */
static void report_bad_edge(struct checker *c, const struct check_open *at, int64_t n)
{
    int64_t same = 0;
    for (int64_t i = 0; i < n; i++)
        same += at[i].from == at->from;
    c->at = at->half_edge;
    tri_check_fault(c, TRI_CHECK_EDGES, "%ld triangles lie on the %s side of edge %ld-%ld of triangle %ld",
                    (long)(same > 1 ? same : n - same), same > 1 ? "same" : "other", check_number(c, at->from),
                    check_number(c, at->to), check_number(c, at->half_edge / 3));
    c->at = 0;
    c->report->item[TRI_CHECK_EDGES].count += n - 1;
}

static enum tri_status keep_boundary(struct checker *c, const struct check_open *e)
{
    struct check_boundary *b = &c->boundary;
    if (!tri_grow_far(&b->at, &b->room, b->n + 1, sizeof *b->at))
        return TRI_NO_MEMORY;
    b->at[b->n++] = (struct check_boundary_edge){e->from, e->to, e->half_edge, e->attribute, e->constrained};
    return TRI_OK;
}

/* Matches the half-edges of one edge. */
static enum tri_status match_edge(struct checker *c, const struct check_open *at, int64_t n)
{
    if (n == 2 && at[0].from == at[1].to) {
        tri_check_matched(c, &at[0], &at[1]);
        return TRI_OK;
    }
    if (n == 1)
        tri_check_matched(c, at, NULL);
    else
        report_bad_edge(c, at, n);
    enum tri_status status = TRI_OK;
    for (int64_t i = 0; i < n && status == TRI_OK; i++)
        status = keep_boundary(c, &at[i]);
    return status;
}

static enum tri_status match_all(struct checker *c, struct check_open *at, int64_t n)
{
    enum tri_status status = TRI_OK;
    if (n > 1)
        qsort(at, (size_t)n, sizeof *at, compare_opens);
    for (int64_t i = 0, next; i < n && status == TRI_OK; i = next) {
        for (next = i + 1; next < n && compare_edges(&at[i], &at[next]) == 0; next++) {
        }
        status = match_edge(c, at + i, next - i);
    }
    return status;
}

static void count_edges(struct checker *c)
{
    struct tri_check_report *r = c->report;
    int64_t first;
    r->n_used_points = tri_check_count(c, c->n_points, check_is_used, &first);
    r->n_boundary_edges = c->boundary.n;
    r->n_edges = (3 * c->n_triangles + c->boundary.n) / 2;
    for (int64_t i = 0; i < c->boundary.n; i++) {
        c->state[c->boundary.at[i].from] |= CHECK_BOUNDARY;
        c->state[c->boundary.at[i].to] |= CHECK_BOUNDARY;
    }
}

enum tri_status tri_check_match(struct checker *c)
{
    tri_check_begin(c, TRI_CHECK_EDGES);
    tri_check_release_part(c); /* frees memory; the part is loaded again when needed */
    enum tri_status status = drain(c, match_all);
    if (status != TRI_OK)
        return status;
    if (c->boundary.n > 1)
        qsort(c->boundary.at, (size_t)c->boundary.n, sizeof *c->boundary.at, compare_half_edges);
    count_edges(c);
    return c->boundary.n > INT32_MAX / 2 ? TRI_TOO_LARGE : TRI_OK;
}
