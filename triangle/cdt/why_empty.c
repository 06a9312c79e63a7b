/* Finds out why a mesh has no triangles.
 *
 * THEOREM. The segments enclose no area if and only if the subsegments along which they run form a forest. A tree with
 * more than one vertex has leaves: points at which a single segment ends. A segment between two leaves of a tree closes
 * a ring, unless the path between them is straight. */
#include "triangle/cdt/why_empty.h"

#include <assert.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "triangle/cdt/constrain.h"
#include "triangle/geometry/predicates.h"

/* A connected set of walls. */
struct part {
    struct tri_point low, high; /* corners of its bounding box */
    int32_t n_vertices, n_walls;
};

struct figure {
    const struct tri_mesh *mesh;
    bool even_odd;
    int32_t *root;     /* [n_vertices] union-find: parent of the vertex; roots represent connected parts */
    int32_t *ends;     /* [n_vertices] number of walls that end there */
    struct part *parts; /* [n_vertices] the part of each root */
    int32_t n_walls;
};

/* Does the subsegment count as a wall that can enclose an area? */
static bool is_wall(const struct figure *f, tri_sub_id s)
{
    const struct tri_parent *parent = &f->mesh->parents[f->mesh->sub[s].parent];
    return f->even_odd ? parent->odd : parent->segment != TRI_NONE;
}

static int32_t root_of(const struct figure *f, tri_vertex_id v)
{
    while (f->root[v] != v)
        v = f->root[v] = f->root[f->root[v]];
    return v;
}

static void find_parts(struct figure *f)
{
    const struct tri_mesh *mesh = f->mesh;
    for (tri_vertex_id v = 0; v < mesh->n_vertices; v++)
        f->root[v] = v;
    for (tri_sub_id s = 0; s < mesh->n_subs; s++)
        if (is_wall(f, s))
            f->root[root_of(f, mesh->sub[s].v[0])] = root_of(f, mesh->sub[s].v[1]);
    for (tri_sub_id s = 0; s < mesh->n_subs; s++)
        if (is_wall(f, s)) {
            f->ends[mesh->sub[s].v[0]]++;
            f->ends[mesh->sub[s].v[1]]++;
            f->parts[root_of(f, mesh->sub[s].v[0])].n_walls++;
            f->n_walls++;
        }
    for (tri_vertex_id v = 0; v < mesh->n_vertices; v++) {
        struct part *part = &f->parts[root_of(f, v)];
        const struct tri_point p = mesh->xy[v];
        if (part->n_vertices++ == 0)
            part->low = part->high = p;
        part->low = (struct tri_point){fmin(part->low.x, p.x), fmin(part->low.y, p.y)};
        part->high = (struct tri_point){fmax(part->high.x, p.x), fmax(part->high.y, p.y)};
    }
}

/* Returns the part with the largest extent. */
static int32_t find_outline(const struct figure *f)
{
    double largest = -1;
    int32_t outline = TRI_NONE;
    for (int32_t v = 0; v < f->mesh->n_vertices; v++) {
        const struct part *part = &f->parts[v];
        const double extent = part->high.x - part->low.x + (part->high.y - part->low.y);
        if (part->n_walls > 0 && extent > largest) {
            largest = extent;
            outline = v;
        }
    }
    return outline;
}

/* Returns the vertex of the part that is farthest from p. */
static struct tri_point farthest(const struct figure *f, int32_t part, struct tri_point p)
{
    struct tri_point far = p;
    for (tri_vertex_id v = 0; v < f->mesh->n_vertices; v++) {
        const struct tri_point q = f->mesh->xy[v];
        if (root_of(f, v) == part && tri_distance2(p, q) > tri_distance2(p, far))
            far = q;
    }
    return far;
}

/* Do all vertices of the part lie on one line, up to rounding? */
static bool is_straight(const struct figure *f, int32_t part)
{
    const struct part *box = &f->parts[part];
    const double size = fmax(fmax(fabs(box->low.x), fabs(box->low.y)), fmax(fabs(box->high.x), fabs(box->high.y)));
    const struct tri_point a = farthest(f, part, f->mesh->xy[part]), b = farthest(f, part, a);
    const double off = 2 * TRI_SEGMENT_ASTRAY * 0x1p-52 * size * sqrt(tri_distance2(a, b));
    for (tri_vertex_id v = 0; v < f->mesh->n_vertices; v++)
        if (root_of(f, v) == part && fabs(tri_orient2d(a, b, f->mesh->xy[v])) > off)
            return false;
    return true;
}

/* Finds input points at which a single wall ends, in one part or (TRI_NONE) in all. */
static struct tri_empty find_leaves(const struct figure *f, int32_t part, enum tri_empty_reason reason)
{
    const int32_t *origin = f->mesh->origin;
    struct tri_empty why = {reason, 0, {INT32_MAX, INT32_MAX}};
    for (tri_vertex_id v = 0; v < f->mesh->n_input; v++) {
        const int32_t number = origin ? origin[v] : v;
        if (f->ends[v] != 1 || (part != TRI_NONE && root_of(f, v) != part))
            continue;
        why.n++;
        if (number < why.v[0]) {
            why.v[1] = why.v[0];
            why.v[0] = number;
        } else if (number < why.v[1]) {
            why.v[1] = number;
        }
    }
    return why.n > 1 ? why : (struct tri_empty){TRI_EMPTY_LOOSE, 0, {TRI_NONE, TRI_NONE}};
}

static bool has_segments(const struct tri_mesh *mesh)
{
    for (tri_sub_id s = 0; s < mesh->n_subs; s++)
        if (mesh->parents[mesh->sub[s].parent].segment != TRI_NONE)
            return true;
    return false;
}

static struct tri_empty explain(const struct figure *f, bool keep_hull, const struct tri_emptied *holes)
{
    const int32_t outline = find_outline(f);
    const struct part *part = &f->parts[outline == TRI_NONE ? 0 : outline];
    if (!keep_hull && outline != TRI_NONE && part->n_walls < part->n_vertices && !is_straight(f, outline))
        return find_leaves(f, outline, TRI_EMPTY_OPEN);
    if (holes->n == 1)
        return (struct tri_empty){TRI_EMPTY_HOLE, holes->first, {TRI_NONE, TRI_NONE}};
    if (holes->n > 1)
        return (struct tri_empty){TRI_EMPTY_HOLES, holes->n, {TRI_NONE, TRI_NONE}};
    if (outline != TRI_NONE)
        return find_leaves(f, TRI_NONE, TRI_EMPTY_LOOSE);
    return (struct tri_empty){has_segments(f->mesh) ? TRI_EMPTY_CANCELLED : TRI_EMPTY_BARE, 0, {TRI_NONE, TRI_NONE}};
}

enum tri_status tri_why_empty(struct tri_empty *why, const struct tri_mesh *mesh, bool even_odd, bool keep_hull,
                              const struct tri_emptied *holes, struct tri_error *error)
{
    const size_t n = (size_t)mesh->n_vertices;
    struct figure f = {mesh, even_odd, malloc(n * sizeof *f.root), calloc(n, sizeof *f.ends),
                       calloc(n, sizeof *f.parts), 0};
    enum tri_status status = TRI_OK;
    assert(mesh->n_triangles > 0);
    if (f.root && f.ends && f.parts) {
        find_parts(&f);
        *why = explain(&f, keep_hull, holes);
    } else {
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d points", (int)mesh->n_vertices);
    }
    free(f.root);
    free(f.ends);
    free(f.parts);
    return status;
}

/* --- texts */

static int32_t invalid_end(const struct tri_pslg *pslg, int32_t k)
{
    for (int end = 0; end < 2; end++) {
        const int32_t v = pslg->segments[2 * (size_t)k + (size_t)end];
        if (v < 0 || v >= pslg->n_points)
            return end;
    }
    return TRI_NONE;
}

/* Are both ends of the segment at the same place? Its point numbers must be valid. */
static bool has_equal_ends(const struct tri_pslg *pslg, int32_t k)
{
    const int32_t *v = &pslg->segments[2 * (size_t)k];
    const double *a = &pslg->points[2 * (size_t)v[0]], *b = &pslg->points[2 * (size_t)v[1]];
    return a[0] == b[0] && a[1] == b[1];
}

/* Describes the first skipped segment, preferring one with an invalid point number. Returns whether there is such a
 * one. */
static bool put_skipped(char *text, size_t size, const struct tri_pslg *pslg, int32_t n_skipped, int32_t base)
{
    int32_t wrong = TRI_NONE, empty = TRI_NONE;
    for (int32_t k = 0; n_skipped > 0 && wrong == TRI_NONE && k < pslg->n_segments; k++)
        if (invalid_end(pslg, k) != TRI_NONE)
            wrong = k;
        else if (empty == TRI_NONE && has_equal_ends(pslg, k))
            empty = k;
    int length = 0;
    if (wrong != TRI_NONE)
        length = snprintf(text, size, "segment %" PRId32 " names point %" PRId64 " of %" PRId32
                          ": numbers count from %" PRId32 " here", wrong + base,
                          (int64_t)pslg->segments[2 * (size_t)wrong + (size_t)invalid_end(pslg, wrong)] + base,
                          pslg->n_points, base);
    else if (empty != TRI_NONE)
        length = snprintf(text, size, "segment %" PRId32 " begins and ends at the same place, at point %" PRId32,
                          empty + base, pslg->segments[2 * (size_t)empty] + base);
    if (n_skipped == 1)
        snprintf(text + length, size - (size_t)length, "%s", length ? "; it is skipped" : "a segment is skipped");
    else if (n_skipped > 1)
        snprintf(text + length, size - (size_t)length, "%s%" PRId32 " segments are skipped", length ? "; " : "",
                 n_skipped);
    return wrong != TRI_NONE;
}

static void put_ends(char *text, size_t size, const struct tri_empty *why, int32_t base)
{
    int length = snprintf(text, size, "%s %" PRId32 "%s%" PRId32, "points", why->v[0] + base,
                          why->n > 2 ? ", " : " and ", why->v[1] + base);
    if (why->n > 2)
        snprintf(text + length, size - (size_t)length, " and %" PRId32 " more", why->n - 2);
}

static void put_reason(char *text, size_t size, const struct tri_empty *why, const struct tri_pslg *pslg, int32_t base)
{
    char ends[80];
    put_ends(ends, sizeof ends, why, base);
    switch (why->reason) {
    case TRI_EMPTY_NOT: break;
    case TRI_EMPTY_LINE: snprintf(text, size, "all points lie on one line"); break;
    case TRI_EMPTY_BARE:
        snprintf(text, size, pslg->n_segments > 0 ? "all segments are skipped" : "there are no segments");
        break;
    case TRI_EMPTY_CANCELLED:
        snprintf(text, size, "segments lie on one another in pairs, and cancel by the even-odd rule");
        break;
    case TRI_EMPTY_OPEN: snprintf(text, size, "the outline is open at %s", ends); break;
    case TRI_EMPTY_LOOSE:
        snprintf(text, size, "the segments enclose nothing%s%s", why->n ? ": they are open at " : "",
                 why->n ? ends : "");
        break;
    case TRI_EMPTY_HOLE: snprintf(text, size, "hole %" PRId32 " lies in the only face", why->n + base); break;
    case TRI_EMPTY_HOLES: snprintf(text, size, "holes lie in all %" PRId32 " faces", why->n); break;
    }
}

void tri_notes_make(struct tri_notes *notes, const struct tri_empty *why, const struct tri_pslg *pslg,
                    int32_t n_skipped, int32_t base)
{
    *notes = (struct tri_notes){0};
    const bool is_wrong = put_skipped(notes->skipped, sizeof notes->skipped, pslg, n_skipped, base);
    const bool is_unclosed = why->reason == TRI_EMPTY_BARE || why->reason == TRI_EMPTY_OPEN ||
                             why->reason == TRI_EMPTY_LOOSE;
    if (why->reason == TRI_EMPTY_NOT)
        return;
    int length = snprintf(notes->empty, sizeof notes->empty, "the mesh is empty: %s",
                          is_wrong && is_unclosed ? notes->skipped : "");
    if (is_wrong && is_unclosed)
        notes->skipped[0] = 0;
    else
        put_reason(notes->empty + length, sizeof notes->empty - (size_t)length, why, pslg, base);
}
