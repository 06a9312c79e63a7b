/* Meshes of the public header: made, refined, deleted.
 *
 * INVARIANT. Between calls a mesh has no unused numbers, its points are in the caller's order, and the arrays
 * derived from the mesh are up to date. */
#include "triangle/api/opaque_mesh.h"

#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/api/figure.h"
#include "triangle/mesh/surface.h"
#include "triangle/refine/census.h"
#include "triangle/size/estimate.h"
#include "triangle/tunables.h"

/* --- settings */

static struct tri_sizes sizes_of(const struct tri_settings *s)
{
    return (struct tri_sizes){.fields = s->sizes, .n = s->n_sizes, .gradation = s->gradation, .min_size = s->min_size,
                              .max_size = s->max_size, .elements_across = s->elements_across,
                              .per_circle = s->per_circle};
}

enum tri_status tri_api_settings_take(struct tri_settings *settings, const struct tri_settings *given,
                                      struct tri_error *error)
{
    enum tri_status status = tri_api_struct_take(settings, sizeof *settings, given, "tri_settings", error);
    if (status)
        return status;
    if (!(settings->min_angle >= 0 && settings->min_angle < 180))
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "settings: min_angle is %g degrees", settings->min_angle);
    if (!(settings->max_area >= 0))
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "settings: max_area is %g", settings->max_area);
    if (settings->protect < 0 || settings->protect > 2)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "settings: protect is %d", settings->protect);
    if (settings->optimise > 1000)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "settings: optimise is %d, and above 1000", settings->optimise);
    if ((unsigned)settings->placement > TRI_PLACEMENT_FRONT)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "settings: placement is %d", (int)settings->placement);
    for (int k = 0; settings->fence && k < 4; k++)
        if (isnan(settings->fence[k]))
            return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "settings: fence is not a number");
    const struct tri_sizes sizes = sizes_of(settings);
    return tri_sizes_check(&sizes, error);
}

/* The caller's size functions, and the first invalid length. Several threads may call them. */
struct sizes {
    const struct tri_settings *settings; /* with the caller's functions */
    atomic_flag is_odd;                  /* set: an invalid length was returned */
    double odd, odd_at[2];               /* the first invalid length, and its position */
};

static void note_odd(struct sizes *sizes, double length, const double at[2])
{
    if (atomic_flag_test_and_set_explicit(&sizes->is_odd, memory_order_relaxed))
        return;
    sizes->odd = length;
    sizes->odd_at[0] = at[0];
    sizes->odd_at[1] = at[1];
}

static double ask_length(void *user, const double at[2])
{
    struct sizes *sizes = user;
    double length = sizes->settings->edge_length(sizes->settings->edge_length_user, at);
    if (!(length > 0))
        note_odd(sizes, length, at);
    return length;
}

static bool has_lengths(const struct tri_settings *s)
{
    const struct tri_sizes sizes = sizes_of(s);
    return tri_sizes_any(&sizes);
}

static bool has_bounds(const struct tri_api_mesh *m, const struct tri_settings *s)
{
    return s->min_angle > 0 || s->max_area > 0 || s->conforming || s->edge_length || s->unsuitable || m->has_areas ||
           has_lengths(s);
}

static struct tri_quality quality_of(const struct tri_api_mesh *m, struct sizes *sizes)
{
    const struct tri_settings *s = sizes->settings;
    struct tri_quality how = tri_quality_defaults();
    how.min_angle = s->min_angle;
    how.max_area = s->max_area;
    how.region_areas = m->has_areas;
    how.lattice = s->placement == TRI_PLACEMENT_LATTICE && !m->has_triangles;
    how.conforming = s->conforming;
    how.front = s->placement != TRI_PLACEMENT_CLASSIC && tri_allows_front(&how);
    how.protect = s->protect;
    how.max_steiner = s->most_new_points > 0 ? s->most_new_points : -1;
    how.passes = s->gate || s->fence ? 0 : s->optimise || !has_lengths(s) ? s->optimise : 1;
    how.edge_length = s->edge_length ? ask_length : NULL;
    how.edge_length_user = sizes;
    how.unsuitable = s->unsuitable;
    how.unsuitable_user = s->unsuitable_user;
    return how;
}

/* *fence receives the settings' fence in units of the mesh. */
static struct tri_refine_hooks hooks_of(const struct tri_api_mesh *m, const struct tri_settings *s,
                                        struct tri_fence *fence)
{
    struct tri_refine_hooks hooks = {.gate = s->gate, .gate_user = s->gate_user};
    if (s->fence) {
        double unit = m->mesh.unit;
        *fence = (struct tri_fence){s->fence[0] / unit, s->fence[1] / unit, s->fence[2] / unit, s->fence[3] / unit};
        hooks.fence = fence;
    }
    return hooks;
}

/* --- arrays derived from the mesh */

static void free_derived(struct tri_api_mesh *m)
{
    free(m->places);
    free(m->attributes);
    free(m->neighbors);
    free(m->edges);
    free(m->edge_markers);
    m->places = m->attributes = NULL;
    m->neighbors = m->edges = m->edge_markers = NULL;
    m->n_edges = 0;
}

static enum tri_status make_places(struct tri_api_mesh *m, struct tri_error *error)
{
    const struct tri_mesh *mesh = &m->mesh;
    if (mesh->unit == 1)
        return TRI_OK;
    m->places = malloc(((size_t)mesh->n_vertices + 1) * 2 * sizeof *m->places);
    if (!m->places)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d points", (int)mesh->n_vertices);
    for (tri_vertex_id v = 0; v < mesh->n_vertices; v++)
        tri_mesh_place(mesh, v, &m->places[2 * (size_t)v]);
    return TRI_OK;
}

static enum tri_status make_attributes(struct tri_api_mesh *m, struct tri_error *error)
{
    const struct tri_mesh *mesh = &m->mesh;
    size_t n = (size_t)mesh->n_triangles, width = mesh->columns ? (size_t)mesh->n_columns : 1;
    if (!m->has_attributes)
        return TRI_OK;
    m->attributes = malloc((n * width + 1) * sizeof *m->attributes);
    if (!m->attributes)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the attributes of %zu triangles", n);
    for (size_t t = 0; t < n; t++)
        for (size_t k = 0; k < width; k++)
            m->attributes[width * t + k] = tri_region_attributes(mesh, mesh->tri[t].region)[k];
    return TRI_OK;
}

static void add_note(struct tri_api_mesh *m, const char *note)
{
    const size_t n = strlen(m->notes);
    snprintf(m->notes + n, sizeof m->notes - n, "%s%s", n > 0 && note[0] ? "\n" : "", note);
}

static void make_notes(struct tri_api_mesh *m, const struct tri_settings *s)
{
    const struct tri_quality asked = {.min_angle = s->min_angle, .conforming = s->conforming};
    char lowered[TRI_ANGLE_NOTE];
    m->notes[0] = 0;
    add_note(m, m->report.notes.empty);
    add_note(m, m->report.notes.skipped);
    add_note(m, m->odd_length);
    add_note(m, m->uncovered);
    if (tri_note_lowered_angle(&asked, lowered))
        add_note(m, lowered);
    if (s->note && m->notes[0])
        s->note(s->note_user, m->notes);
}

/* Restores the invariant. */
static enum tri_status update_derived(struct tri_api_mesh *m, const struct tri_settings *s, struct tri_error *error)
{
    free_derived(m);
    make_notes(m, s);
    m->mesh.stop = NULL;
    enum tri_status status = make_places(m, error);
    return status ? status : make_attributes(m, error);
}

/* --- making and refining */

static void note_sizes(struct tri_api_mesh *m, const struct tri_api_figure *figure)
{
    const struct tri_pslg *pslg = &figure->pslg;
    const struct tri_elements *elements = &figure->elements;
    m->has_triangles = elements->n > 0;
    if (m->has_triangles) {
        m->has_attributes = elements->n_attributes > 0;
        for (int32_t t = 0; elements->areas && t < elements->n && !m->has_areas; t++)
            m->has_areas = elements->areas[t] > 0;
    } else {
        m->has_attributes = pslg->n_regions > 0;
        for (int32_t k = 0; k < pslg->n_regions; k++)
            m->has_areas = m->has_areas || pslg->regions[4 * (size_t)k + 3] > 0;
    }
}

/* The progress of refinement, for settings.progress. */
struct following {
    const struct tri_settings *settings; /* with the caller's progress function */
    double first, estimate, done; /* triangles at the start and at the end (estimated); reported fraction */
};

static void report_fraction(void *user, int64_t triangles)
{
    struct following *f = user;
    const double most = 0.99; /* completion is reported separately */
    double done = f->estimate > f->first ? ((double)triangles - f->first) / (f->estimate - f->first) : 0;
    f->done = done > most ? most : done > f->done ? done : f->done;
    f->settings->progress(f->settings->progress_user, f->done, triangles);
}

static enum tri_status refine_told(const struct tri_api_way *way, struct tri_mesh *mesh, const struct tri_quality *how,
                                   const struct tri_refine_hooks *hooks, const struct tri_settings *s,
                                   struct tri_refine_report *report, struct tri_error *error)
{
    double sure;
    enum tri_status status = tri_refine_prepare(mesh, way->executor, error); /* the estimate needs feature sizes */
    if (status)
        return status;
    struct following f = {s, (double)mesh->n_triangles, tri_estimate(mesh, how, way->executor, &sure), 0};
    struct tri_refine_hooks told = *hooks;
    told.told = report_fraction;
    told.told_user = &f;
    status = way->refine(way, mesh, how, &told, s, report, error);
    if (!status)
        s->progress(s->progress_user, 1, mesh->n_triangles);
    return status;
}

/* The refinement that tri_generate calls. */
struct refiner {
    struct tri_api_mesh *m; /* the mesh */
    const struct tri_settings *settings; /* the caller's settings */
    const struct tri_api_way *way;       /* the refinement to call */
};

static void note_odd_length(struct tri_api_mesh *m, const struct sizes *sizes)
{
    snprintf(m->odd_length, sizeof m->odd_length, "edge_length returned %g at (%.12g, %.12g): it must be above 0,"
             " and is ignored there", isnan(sizes->odd) ? fabs(sizes->odd) : sizes->odd, sizes->odd_at[0],
             sizes->odd_at[1]);
}

static enum tri_status refine(void *user, struct tri_mesh *mesh, const struct tri_quality *quality,
                              struct tri_refine_report *report, struct tri_error *error)
{
    const struct refiner *refiner = user;
    const struct tri_settings *s = refiner->settings;
    struct tri_fence fence;
    struct sizes sizes = {.settings = s, .is_odd = ATOMIC_FLAG_INIT};
    struct tri_quality how = quality_of(refiner->m, &sizes);
    const struct tri_refine_hooks hooks = hooks_of(refiner->m, s, &fence);
    (void)quality;
    *report = (struct tri_refine_report){0};
    refiner->m->odd_length[0] = refiner->m->uncovered[0] = 0;
    refiner->m->refined = (struct tri_settings){0};
    if (!has_bounds(refiner->m, s) && !refiner->way->figure)
        return TRI_OK;
    struct tri_lengths *lengths;
    struct tri_sizes asked = sizes_of(s);
    asked.region_areas = how.region_areas;
    enum tri_status status = tri_lengths_new(&lengths, &asked, mesh, refiner->way->executor, error);
    how.lengths = lengths;
    snprintf(refiner->m->uncovered, sizeof refiner->m->uncovered, "%s", tri_lengths_note(lengths));
    if (!status)
        status = s->progress ? refine_told(refiner->way, mesh, &how, &hooks, s, report, error)
                             : refiner->way->refine(refiner->way, mesh, &how, &hooks, s, report, error);
    tri_lengths_free(lengths);
    if (atomic_flag_test_and_set(&sizes.is_odd))
        note_odd_length(refiner->m, &sizes);
    if (!status)
        refiner->m->refined = *s;
    return status;
}

static enum tri_status generate(struct tri_api_mesh *m, const struct tri_api_figure *figure,
                                const struct tri_settings *s, const struct tri_api_way *way,
                                struct tri_error *error)
{
    const struct tri_pslg *pslg = &figure->pslg;
    const struct tri_stop stop = {s->stop, s->stop_user};
    const struct refiner refiner = {m, s, way};
    struct tri_options how = tri_defaults();
    how.elements = figure->elements.n > 0 ? &figure->elements : NULL;
    how.use_segments = pslg->n_segments > 0 || (!how.elements && (pslg->n_holes > 0 || pslg->n_regions > 0));
    how.keep_hull = s->keep_hull || pslg->n_segments == 0;
    how.even_odd = s->even_odd;
    how.spread_regions = pslg->n_regions > 0;
    how.refine = how.elements || has_bounds(m, s) || way->figure; /* a mesh may be refined later and must be Delaunay
                                                                     for that */
    how.refine_call = refine;
    how.refine_user = (void *)&refiner; /* it is only read */
    how.executor = way->executor;
    how.stop = s->stop ? &stop : NULL;
    return tri_generate(&m->mesh, pslg, &how, &m->report, error);
}

static enum tri_status make(struct tri_api_mesh *m, const struct tri_api_figure *figure, const struct tri_settings *s,
                            const struct tri_api_way *way, struct tri_error *error)
{
    note_sizes(m, figure);
    enum tri_status status = generate(m, figure, s, way, error);
    if (!m->mesh.regions) /* the mesh is empty */
        return status;
    enum tri_status settled = update_derived(m, s, status ? NULL : error);
    if (settled)
        tri_mesh_free(&m->mesh);
    return status ? status : settled;
}

enum tri_status tri_api_mesh_new(struct tri_mesh **mesh, const struct tri_figure *figure,
                                 const struct tri_settings *settings, const struct tri_api_way *way,
                                 struct tri_error *error)
{
    struct tri_api_figure taken;
    struct tri_api_mesh *m = calloc(1, sizeof *m);
    *mesh = NULL;
    if (!m)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a mesh");
    enum tri_status status = tri_api_figure_take(&taken, figure, error);
    status = status ? status : make(m, &taken, settings, way, error);
    tri_api_figure_free(&taken);
    if (m->mesh.regions && (!status || status == TRI_NO_MEMORY || status == TRI_STOPPED))
        *mesh = &m->mesh;
    else /* the mesh is empty, or was refused */
        tri_mesh_delete(&m->mesh);
    return status;
}

/* Streams the mesh of a converted figure. */
static enum tri_status stream(struct tri_api_figure *figure, const struct tri_settings *settings,
                              const struct tri_api_way *given, struct tri_error *error)
{
    struct tri_api_mesh m = {0};
    struct tri_api_way way = *given;
    note_sizes(&m, figure);
    way.figure = &figure->pslg;
    way.has_attributes = m.has_attributes;
    enum tri_status status = generate(&m, figure, settings, &way, error);
    if (!status)
        make_notes(&m, settings);
    tri_mesh_free(&m.mesh);
    return status;
}

enum tri_status tri_api_mesh_stream(const struct tri_figure *figure, const struct tri_settings *settings,
                                    const struct tri_api_way *way, struct tri_error *error)
{
    struct tri_api_figure taken;
    enum tri_status status = tri_api_figure_take(&taken, figure, error);
    status = status ? status : stream(&taken, settings, way, error);
    tri_api_figure_free(&taken);
    return status;
}

enum tri_status tri_api_mesh_refine(struct tri_mesh *mesh, const struct tri_settings *settings,
                                    const struct tri_api_way *way, struct tri_error *error)
{
    struct tri_api_mesh *m = (struct tri_api_mesh *)mesh;
    const struct tri_stop stop = {settings->stop, settings->stop_user};
    struct refiner refiner = {m, settings, way};
    mesh->stop = settings->stop ? &stop : NULL;
    enum tri_status status = refine(&refiner, mesh, NULL, &m->report.quality, error);
    enum tri_status settled = update_derived(m, settings, status ? NULL : error);
    return status ? status : settled;
}

static enum tri_status refine_here(const struct tri_api_way *way, struct tri_mesh *mesh,
                                   const struct tri_quality *quality, const struct tri_refine_hooks *hooks,
                                   const struct tri_settings *settings, struct tri_refine_report *report,
                                   struct tri_error *error)
{
    (void)way;
    (void)settings;
    return tri_refine_whole(mesh, quality, hooks, report, error);
}

enum tri_status tri_mesh_new(struct tri_mesh **mesh, const struct tri_figure *figure,
                             const struct tri_settings *settings, struct tri_error *error)
{
    const struct tri_api_way way = {.refine = refine_here};
    struct tri_settings own;
    *mesh = NULL;
    enum tri_status status = tri_api_settings_take(&own, settings, error);
    return status ? status : tri_api_mesh_new(mesh, figure, &own, &way, error);
}

enum tri_status tri_mesh_refine(struct tri_mesh *mesh, const struct tri_settings *settings, struct tri_error *error)
{
    const struct tri_api_way way = {.refine = refine_here};
    struct tri_settings own;
    enum tri_status status = tri_api_settings_take(&own, settings, error);
    return status ? status : tri_api_mesh_refine(mesh, &own, &way, error);
}

void tri_mesh_delete(struct tri_mesh *mesh)
{
    struct tri_api_mesh *m = (struct tri_api_mesh *)mesh;
    if (!m)
        return;
    free_derived(m);
    tri_mesh_free(&m->mesh);
    free(m);
}

/* --- queries */

const char *tri_mesh_notes(const struct tri_mesh *mesh) { return ((const struct tri_api_mesh *)mesh)->notes; }

int64_t tri_mesh_count(const struct tri_mesh *mesh, enum tri_count what)
{
    const struct tri_api_mesh *m = (const struct tri_api_mesh *)mesh;
    const struct tri_report *report = &m->report;
    switch (what) {
    case TRI_COUNT_DUPLICATES: return report->duplicates;
    case TRI_COUNT_CROSSINGS: return report->constrain.crossings;
    case TRI_COUNT_SKIPPED_SEGMENTS: return report->constrain.skipped + report->loose;
    case TRI_COUNT_NEW_POINTS: return report->quality.inserted_free;
    case TRI_COUNT_NEW_POINTS_ON_SEGMENTS: return report->quality.inserted_on_segments;
    case TRI_COUNT_GATED: return report->quality.gated;
    case TRI_COUNT_FENCED: return report->quality.fenced;
    }
    return 0;
}

_Static_assert((int)TRI_REASONS == (int)TRI_EXCUSES && (int)TRI_REASON_INPUT_ANGLE == (int)TRI_EXCUSE_INPUT_ANGLE &&
                   (int)TRI_REASON_NARROW_GAP == (int)TRI_EXCUSE_NARROW_GAP &&
                   (int)TRI_REASON_PROTECTED == (int)TRI_EXCUSE_PROTECTED &&
                   (int)TRI_REASON_LIMIT == (int)TRI_EXCUSE_LIMIT &&
                   (int)TRI_REASON_PRECISION == (int)TRI_EXCUSE_PRECISION &&
                   (int)TRI_REASON_DEFERRED == (int)TRI_EXCUSE_DEFERRED,
               "the reasons of the header are those of the library");

/* Was the mesh refined successfully with bounds at least as strict as these? */
static bool is_refined_for(const struct tri_api_mesh *m, const struct tri_settings *s)
{
    const struct tri_settings *done = &m->refined;
    const bool same_lengths = done->edge_length == s->edge_length && done->edge_length_user == s->edge_length_user;
    const bool same_test = done->unsuitable == s->unsuitable && done->unsuitable_user == s->unsuitable_user;
    const bool area = s->max_area == 0 || (done->max_area > 0 && done->max_area <= s->max_area);
    return s->min_angle <= done->min_angle && area && (!s->edge_length || same_lengths) &&
           (!s->unsuitable || same_test);
}

int64_t tri_mesh_count_bad(const struct tri_mesh *mesh, const struct tri_settings *settings, int64_t *by_reason,
                           int n_reasons)
{
    const struct tri_api_mesh *m = (const struct tri_api_mesh *)mesh;
    int64_t count[TRI_EXCUSES], sum = 0;
    struct tri_settings own;
    if (tri_api_settings_take(&own, settings, NULL))
        return -1;
    struct sizes sizes = {.settings = &own, .is_odd = ATOMIC_FLAG_INIT};
    const struct tri_quality how = quality_of(m, &sizes);
    struct tri_refine_report report = m->report.quality;
    report.gated += !is_refined_for(m, &own); /* then triangles without another reason count as deferred to a later
                                                 refinement */
    tri_count_bad(mesh, &how, &report, NULL, count);
    for (int k = 0; by_reason && k < n_reasons; k++)
        by_reason[k] = 0;
    for (int k = 0; k < TRI_EXCUSES; k++) {
        sum += count[k];
        if (by_reason && n_reasons > 0)
            by_reason[k < n_reasons ? k : n_reasons - 1] += count[k];
    }
    return sum;
}
