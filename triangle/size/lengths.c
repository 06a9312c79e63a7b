/* Wanted edge lengths: makes the sources (sources.h) and takes their minimum. */
#include "triangle/size/lengths.h"

#include <stdio.h>

#include "triangle/base/hash.h"
#include "triangle/size/sources.h"

enum { NOTE = 256 };

static const double USUAL_GRADATION = 0.2;

struct tri_lengths {
    double number;         /* smallest length that holds everywhere; infinity: none */
    double min_size;       /* 0: none */
    struct tri_near near;  /* all segments and points with lengths */
    struct tri_raster *raster; /* [n_rasters] */
    struct tri_background *background; /* [n_backgrounds] */
    struct tri_sampled *sampled; /* [n_sampled] */
    int64_t n_rasters, n_backgrounds, n_sampled; /* numbers of sources */
    char note[NOTE];                             /* warning for the user; "": none */
};

/* --- validation */

static bool is_finite_above(double x, double least) { return x > least && x < HUGE_VAL; }

static enum tri_status check_raster(const struct tri_size_field *f, struct tri_error *error)
{
    const struct tri_reals *v = &f->values;
    if (!v->at || v->n < 1 || v->width < 1 || v->stride < v->width)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "it has no values");
    if (v->n > INT32_MAX / v->width)
        return tri_fail(error, TRI_TOO_LARGE, NULL, 0, "it has more than 2^31 values");
    for (int k = 0; k < 2; k++)
        if (!isfinite(f->origin[k]) || !is_finite_above(f->step[k], 0))
            return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "its origin is (%g, %g), its step (%g, %g)", f->origin[0],
                            f->origin[1], f->step[0], f->step[1]);
    return TRI_OK;
}

static enum tri_status check_mesh(const struct tri_size_field *f, struct tri_error *error)
{
    const struct tri_reals *p = &f->points, *v = &f->values;
    const struct tri_ints *t = &f->triangles;
    if (!p->at || p->n < 1 || p->width != 2 || p->stride < 2)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "it has no points");
    if (t->n < 0 || (t->n > 0 && (!t->at || t->width != 3 || t->stride < 3)))
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "its triangles have %lld corners", (long long)t->width);
    if (!v->at || v->n != p->n || v->width != 1 || v->stride < 1)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "it has %lld points and %lld values", (long long)p->n,
                        (long long)v->n);
    if (p->n > TRI_MAX_VERTICES || t->n > TRI_MAX_TRIANGLES)
        return tri_fail(error, TRI_TOO_LARGE, NULL, 0, "it has %lld triangles", (long long)t->n);
    for (int64_t i = 0; i < p->n; i++)
        if (!isfinite(p->at[i * p->stride]) || !isfinite(p->at[i * p->stride + 1]))
            return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "its point %lld is (%g, %g)", (long long)i,
                            p->at[i * p->stride], p->at[i * p->stride + 1]);
    for (int64_t i = 0; i < 3 * t->n; i++) {
        const int32_t corner = t->at[i / 3 * t->stride + i % 3];
        if (corner < 0 || corner >= p->n)
            return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "its triangle %lld has the corner %d, of %lld points",
                            (long long)(i / 3), corner, (long long)p->n);
    }
    return TRI_OK;
}

static enum tri_status check_field(const struct tri_size_field *f, struct tri_error *error)
{
    switch (f->kind) {
    case TRI_SIZE_NUMBER:
        return f->length > 0 ? TRI_OK : tri_fail(error, TRI_BAD_INPUT, NULL, 0, "its length is %g", f->length);
    case TRI_SIZE_NEAR:
        return is_finite_above(f->length, 0) && !isnan(f->growth)
                   ? TRI_OK
                   : tri_fail(error, TRI_BAD_INPUT, NULL, 0, "its length is %g, its growth %g", f->length, f->growth);
    case TRI_SIZE_RASTER: return check_raster(f, error);
    case TRI_SIZE_MESH: return check_mesh(f, error);
    case TRI_SIZE_FUNCTION:
        return f->function ? TRI_OK : tri_fail(error, TRI_BAD_INPUT, NULL, 0, "it is NULL");
    }
    return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "its kind is %d", (int)f->kind);
}

/* Reports the error of a field, with the field's index and kind. */
static enum tri_status fail_field(const struct tri_sizes *sizes, int64_t k, const struct tri_error *own,
                             struct tri_error *error)
{
    static const char *const names[] = {"", ", a number", ", a raster", ", a mesh", ", a function", ", near segments"};
    const int kind = (int)sizes->fields[k].kind;
    const char *name = kind > 0 && kind < (int)(sizeof names / sizeof *names) ? names[kind] : "";
    return own->status == TRI_BAD_INPUT || own->status == TRI_TOO_LARGE
               ? tri_fail(error, own->status, NULL, 0, "sizes[%lld]%s: %s", (long long)k, name, own->text)
               : tri_fail(error, own->status, NULL, 0, "%s", own->text);
}

enum tri_status tri_sizes_check(const struct tri_sizes *s, struct tri_error *error)
{
    struct tri_error own;
    if (!(s->gradation >= 0))
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "gradation is %g", s->gradation);
    if (!(s->min_size >= 0 && s->min_size < HUGE_VAL))
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "min_size is %g", s->min_size);
    if (!(s->max_size >= 0))
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "max_size is %g", s->max_size);
    if (s->max_size > 0 && s->min_size > s->max_size)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "min_size %g is above max_size %g", s->min_size, s->max_size);
    if (!(s->elements_across >= 0 && s->elements_across < HUGE_VAL))
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "elements_across is %g", s->elements_across);
    if (!(s->per_circle >= 0 && s->per_circle < HUGE_VAL))
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "per_circle is %g", s->per_circle);
    if (s->n < 0 || (s->n > 0 && !s->fields))
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "sizes is NULL, and n_sizes %lld", (long long)s->n);
    for (int64_t k = 0; k < s->n; k++)
        if (check_field(&s->fields[k], &own))
            return fail_field(s, k, &own, error);
    return TRI_OK;
}

/* Returns the number of sources whose length is not constant. */
static int64_t count_sources(const struct tri_lengths *l)
{
    return l->near.n + l->n_rasters + l->n_backgrounds + l->n_sampled;
}

/* --- making */

struct making {
    struct tri_lengths *out; /* the result */
    const struct tri_sizes *sizes; /* the request */
    struct tri_size_frame frame;   /* data common to all sources */
};

/* Returns the bounding box of the mesh. Its boundary consists of subsegments. */
static struct tri_size_frame frame_of(const struct tri_sizes *sizes, const struct tri_mesh *mesh)
{
    struct tri_size_frame f = {.mesh = mesh, .gradation = sizes->gradation > 0 ? sizes->gradation : USUAL_GRADATION};
    f.low = f.high = mesh->n_subs > 0 ? mesh->xy[mesh->sub[0].v[0]] : (struct tri_point){0, 0};
    for (tri_sub_id s = 0; s < mesh->n_subs; s++)
        for (int k = 0; k < 2; k++) {
            const struct tri_point p = mesh->xy[mesh->sub[s].v[k]];
            f.low = (struct tri_point){tri_lesser(f.low.x, p.x), tri_lesser(f.low.y, p.y)};
            f.high = (struct tri_point){tri_larger(f.high.x, p.x), tri_larger(f.high.y, p.y)};
        }
    return f;
}

/* Returns the marker of a subsegment as callers see it: a boundary without a marker has 1. */
static int32_t marker_of(const struct tri_subsegment *s)
{
    return s->marker == 0 && tri_is_boundary(s) ? 1 : s->marker;
}

/* Returns the growth of a field. If both the growth and the gradation are given, the smaller one counts. */
static double growth_of(const struct making *m, const struct tri_size_field *f)
{
    const double given = m->sizes->gradation;
    return f->growth < 0 ? m->frame.gradation : given > 0 ? fmin(f->growth, given) : f->growth;
}

static enum tri_status add_near_field(struct making *m, const struct tri_size_field *f, struct tri_error *error)
{
    const struct tri_mesh *mesh = m->frame.mesh;
    const double growth = growth_of(m, f);
    const int32_t before = m->out->near.n;
    if (!(growth < HUGE_VAL))
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "its growth is infinite");
    for (tri_sub_id s = 0; s < mesh->n_subs; s++) {
        const tri_vertex_id *v = mesh->sub[s].v;
        if (marker_of(&mesh->sub[s]) == f->marker &&
            !tri_near_add(&m->out->near, mesh->xy[v[0]], mesh->xy[v[1]], tri_size_of(&m->frame, f->length), growth))
            return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for sizes");
    }
    return m->out->near.n > before ? TRI_OK
                                   : tri_fail(error, TRI_BAD_INPUT, NULL, 0, "no segment has the marker %d", f->marker);
}

/* Notes the first field that does not cover the mesh. low, high: the field's box, in units of the mesh. */
static void note_uncovered(struct making *m, int64_t k, struct tri_point low, struct tri_point high)
{
    const struct tri_size_frame *f = &m->frame;
    const double unit = f->mesh->unit, room = 1e-6 * tri_larger(f->high.x - f->low.x, f->high.y - f->low.y);
    if (m->out->note[0] || (f->low.x >= low.x - room && f->low.y >= low.y - room && f->high.x <= high.x + room &&
                            f->high.y <= high.y + room))
        return;
    snprintf(m->out->note, sizeof m->out->note, "sizes[%lld] covers (%.6g, %.6g) to (%.6g, %.6g), the mesh (%.6g, %.6g)"
             " to (%.6g, %.6g): outside, the nearest lengths count", (long long)k, low.x * unit, low.y * unit,
             high.x * unit, high.y * unit, f->low.x * unit, f->low.y * unit, f->high.x * unit, f->high.y * unit);
}

static enum tri_status add_raster_field(struct making *m, int64_t k, struct tri_error *error)
{
    struct tri_raster *r = &m->out->raster[m->out->n_rasters];
    const enum tri_status status = tri_raster_make(r, &m->sizes->fields[k], &m->frame, error);
    if (status)
        return status;
    m->out->n_rasters++;
    const double x = 0.5 / r->inverse[0], y = 0.5 / r->inverse[1]; /* a value holds for a cell around its node */
    const double width = (double)(2 * r->n[0] - 1) * x, height = (double)(2 * r->n[1] - 1) * y;
    note_uncovered(m, k, (struct tri_point){r->origin[0] - x, r->origin[1] - y},
                   (struct tri_point){r->origin[0] + width, r->origin[1] + height});
    return TRI_OK;
}

static enum tri_status add_mesh_field(struct making *m, int64_t k, struct tri_error *error)
{
    struct tri_background *b = &m->out->background[m->out->n_backgrounds];
    const enum tri_status status = tri_background_make(b, &m->sizes->fields[k], &m->frame, error);
    if (status)
        return status;
    m->out->n_backgrounds++;
    struct tri_point low = b->at[b->corner[0]], high = low;
    for (int64_t i = 0; i < 3 * (int64_t)b->n_triangles; i++) {
        const struct tri_point p = b->at[b->corner[i]];
        low = (struct tri_point){tri_lesser(low.x, p.x), tri_lesser(low.y, p.y)};
        high = (struct tri_point){tri_larger(high.x, p.x), tri_larger(high.y, p.y)};
    }
    for (int32_t v = 0; m->sizes->fields[k].triangles.n == 0 && m->frame.gradation < HUGE_VAL && v < b->n; v++)
        if (b->length[v] > 0 && !tri_near_add(&m->out->near, b->at[v], b->at[v], b->length[v], m->frame.gradation))
            return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for sizes");
    note_uncovered(m, k, low, high);
    return TRI_OK;
}

static enum tri_status add_function_field(struct making *m, int64_t k, struct tri_error *error)
{
    struct tri_sampled *s = &m->out->sampled[m->out->n_sampled];
    const enum tri_status status = tri_sampled_make(s, &m->sizes->fields[k], &m->frame, error);
    m->out->n_sampled += !status;
    if (!status && s->is_coarse && !m->out->note[0])
        snprintf(m->out->note, sizeof m->out->note, "sizes[%lld] varies too much for %d places: between these, lengths"
                 " are bilinear", (long long)k, TRI_SAMPLES);
    return status;
}

static enum tri_status add_field(struct making *m, int64_t k, struct tri_error *error)
{
    const struct tri_size_field *f = &m->sizes->fields[k];
    switch (f->kind) {
    case TRI_SIZE_NUMBER: m->out->number = fmin(m->out->number, f->length / m->frame.mesh->unit); return TRI_OK;
    case TRI_SIZE_NEAR: return add_near_field(m, f, error);
    case TRI_SIZE_RASTER: return add_raster_field(m, k, error);
    case TRI_SIZE_MESH: return add_mesh_field(m, k, error);
    case TRI_SIZE_FUNCTION: return add_function_field(m, k, error);
    }
    return TRI_OK;
}

/* Adds the lengths that follow from the shape of the input. */
static enum tri_status add_shape_lengths(struct making *m, struct tri_error *error)
{
    const struct tri_sizes *s = m->sizes;
    struct tri_near *near = &m->out->near;
    enum tri_status status = s->region_areas ? tri_near_regions(near, &m->frame, error) : TRI_OK;
    if (!status && s->per_circle > 0)
        status = tri_near_curves(near, &m->frame, s->per_circle, error);
    if (!status && s->elements_across > 0)
        status = tri_near_channels(near, &m->frame, s->elements_across, error);
    return status ? status : tri_near_settle(near, &m->frame, error);
}

static enum tri_status add_all_fields(struct making *m, struct tri_error *error)
{
    struct tri_lengths *l = m->out;
    const double unit = m->frame.mesh->unit;
    l->min_size = m->sizes->min_size / unit;
    l->number = m->sizes->max_size > 0 ? m->sizes->max_size / unit : HUGE_VAL;
    const size_t n = (size_t)m->sizes->n + 1;
    l->raster = calloc(n, sizeof *l->raster);
    l->background = calloc(n, sizeof *l->background);
    l->sampled = calloc(n, sizeof *l->sampled);
    if (!l->raster || !l->background || !l->sampled)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for sizes");
    for (int64_t k = 0; k < m->sizes->n; k++) {
        struct tri_error own;
        if (add_field(m, k, &own))
            return fail_field(m->sizes, k, &own, error);
    }
    return add_shape_lengths(m, error);
}

enum tri_status tri_lengths_new(struct tri_lengths **lengths, const struct tri_sizes *sizes,
                                const struct tri_mesh *mesh, const struct tri_executor *executor,
                                struct tri_error *error)
{
    *lengths = NULL;
    enum tri_status status = tri_sizes_check(sizes, error);
    if (status || mesh->n_subs == 0 || !tri_sizes_any(sizes)) /* for an empty mesh there is nothing to compute */
        return status;
    struct making m = {calloc(1, sizeof *m.out), sizes, frame_of(sizes, mesh)};
    m.frame.executor = executor;
    if (!m.out)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for sizes");
    status = add_all_fields(&m, error);
    if (status || (count_sources(m.out) == 0 && !(m.out->number < HUGE_VAL)))
        tri_lengths_free(m.out);
    else
        *lengths = m.out;
    return status;
}

void tri_lengths_free(struct tri_lengths *l)
{
    if (!l)
        return;
    for (int64_t k = 0; k < l->n_rasters; k++)
        tri_raster_clear(&l->raster[k]);
    for (int64_t k = 0; k < l->n_backgrounds; k++)
        tri_background_clear(&l->background[k]);
    for (int64_t k = 0; k < l->n_sampled; k++)
        tri_sampled_clear(&l->sampled[k]);
    tri_near_clear(&l->near);
    free(l->raster);
    free(l->background);
    free(l->sampled);
    free(l);
}

/* --- evaluation */

double tri_lengths_at(const struct tri_lengths *l, struct tri_point p)
{
    double h = l->number;
    if (l->near.n > 0)
        h = tri_lesser(h, tri_near_at(&l->near, p));
    for (int64_t k = 0; k < l->n_rasters; k++)
        h = tri_lesser(h, tri_raster_at(&l->raster[k], p));
    for (int64_t k = 0; k < l->n_backgrounds; k++)
        h = tri_lesser(h, tri_background_at(&l->background[k], p));
    for (int64_t k = 0; k < l->n_sampled; k++)
        h = tri_lesser(h, tri_sampled_at(&l->sampled[k], p));
    return tri_larger(h, l->min_size);
}

double tri_lengths_uniform(const struct tri_lengths *l)
{
    return count_sources(l) == 0 && l->number < HUGE_VAL ? tri_larger(l->number, l->min_size) : 0;
}

const char *tri_lengths_note(const struct tri_lengths *l) { return l ? l->note : ""; }

uint64_t tri_lengths_hash(const struct tri_lengths *l)
{
    if (!l)
        return 0;
    const double kept[] = {l->number, l->min_size};
    uint64_t hash = tri_near_hash(&l->near, tri_hash(1, kept, sizeof kept));
    for (int64_t k = 0; k < l->n_rasters; k++)
        hash = tri_raster_hash(&l->raster[k], hash);
    for (int64_t k = 0; k < l->n_backgrounds; k++)
        hash = tri_background_hash(&l->background[k], hash);
    for (int64_t k = 0; k < l->n_sampled; k++)
        hash = tri_sampled_hash(&l->sampled[k], hash);
    return hash;
}
