/* The files, one row at a time.
 *
 * Numbers: vertex v of the mesh is written as number_of(v), v itself unless -j leaves some out; the node amid edge i
 * (-o2) comes behind all vertices. Triangles and subsegments keep their order. */
#include "drivers/mesh_files.h"

#include <stdlib.h>
#include <string.h>

#include "drivers/interrupt.h"
#include "triangle/text/decimal.h"
#include "triangle/topology.h"
#include "triangle/generate.h"
#include "triangle/text/write.h"

struct writer {
    const struct mesh_files *files;
    const struct tri_switches *switches;
    const struct tri_mesh *mesh;
    struct tri_edge_list edges; /* made where a file needs them */
    struct tri_used used;       /* vertices written; vertex and number are NULL: all are */
    int32_t n_vertices;         /* written, nodes amid edges not counted */
    int32_t base;
    int32_t n_attributes;       /* of vertices */
    int n_nodes;                /* of a triangle */
    int32_t n_columns;          /* of triangle attributes */
    struct tri_error *error;
};

enum plan { NOT_ASKED, SUPPRESSED, WRITTEN };

/* --- rows */

static int32_t number_of(const struct writer *w, int32_t v) { return w->used.number ? w->used.number[v] : v; }

/* A vertex with coordinates or attributes that lie nowhere in memory. marker NULL: no column. */
static char *blend_row(char *at, const struct writer *w, int64_t number, const struct tri_blend *blend,
                       const int32_t *marker)
{
    at = tri_row_node(at, number, blend->at, NULL, 0, NULL) - 1; /* over the '\n' */
    for (int32_t k = 0; k < w->n_attributes; k++) {
        memcpy(at, "  ", 2);
        at = tri_print_real(at + 2, tri_blend_attribute(w->mesh, blend, k));
    }
    if (marker) {
        memcpy(at, "    ", 4);
        at = tri_print_integer(at + 4, *marker, 0);
    }
    *at = '\n';
    return at + 1;
}

static char *vertex_row(char *at, const struct writer *w, size_t i)
{
    const struct tri_mesh *mesh = w->mesh;
    int32_t v = w->used.vertex ? w->used.vertex[i] : (int32_t)i;
    double place[2];
    const double *xy = place;
    if (v < mesh->n_input)
        xy = &w->files->pslg->points[2 * (size_t)v];
    else
        tri_mesh_place(mesh, v, place);
    const double *attributes = w->n_attributes ? &mesh->attributes[(size_t)v * (size_t)w->n_attributes] : NULL;
    const int32_t *marker = w->switches->no_markers ? NULL : &mesh->vertex_markers[v];
    return tri_row_node(at, (int64_t)i + w->base, xy, attributes, w->n_attributes, marker);
}

static char *node_row(void *user, size_t i, char *at)
{
    const struct writer *w = user;
    if (i < (size_t)w->n_vertices)
        return vertex_row(at, w, i);
    int32_t code = w->edges.codes[i - (size_t)w->n_vertices], marker = tri_edge_marker(w->mesh, code);
    struct tri_blend middle = tri_edge_middle(w->mesh, code);
    return blend_row(at, w, (int64_t)i + w->base, &middle, w->switches->no_markers ? NULL : &marker);
}

static char *ele_row(void *user, size_t i, char *at)
{
    const struct writer *w = user;
    const struct tri_triangle *t = &w->mesh->tri[i];
    int32_t nodes[6] = {number_of(w, t->v[0]), number_of(w, t->v[1]), number_of(w, t->v[2])};
    for (int e = 0; w->n_nodes == 6 && e < 3; e++)
        nodes[3 + e] = w->n_vertices + w->edges.number[3 * i + (size_t)e];
    return tri_row_ele(at, (int64_t)i + w->base, w->base, nodes, w->n_nodes, tri_region_attributes(w->mesh, t->region),
                       w->n_columns);
}

static char *edge_row(void *user, size_t i, char *at)
{
    const struct writer *w = user;
    int32_t code = w->edges.codes[i], ends[2], marker = tri_edge_marker(w->mesh, code);
    tri_edge_ends(w->mesh, code, ends);
    ends[0] = number_of(w, ends[0]);
    ends[1] = number_of(w, ends[1]);
    return tri_row_edge(at, (int64_t)i + w->base, w->base, ends, w->switches->no_markers ? NULL : &marker);
}

static char *neigh_row(void *user, size_t i, char *at)
{
    const struct writer *w = user;
    int32_t neighbors[3];
    tri_neighbors(w->mesh, (int32_t)i, neighbors);
    return tri_row_neigh(at, (int64_t)i + w->base, w->base, neighbors);
}

static char *v_node_row(void *user, size_t i, char *at)
{
    const struct writer *w = user;
    struct tri_blend center = tri_voronoi_vertex(w->mesh, (int32_t)i);
    return blend_row(at, w, (int64_t)i + w->base, &center, NULL);
}

static char *v_edge_row(void *user, size_t i, char *at)
{
    const struct writer *w = user;
    int32_t ends[2];
    double direction[2];
    tri_voronoi_edge(w->mesh, w->edges.codes[i], ends, direction);
    return tri_row_v_edge(at, (int64_t)i + w->base, w->base, ends, direction);
}

/* --- files */

static enum tri_status write_rows(struct writer *w, struct tri_output *output, size_t n, size_t max_row_bytes,
                                  char *(*row)(void *, size_t, char *))
{
    return tri_write_table(output, n, max_row_bytes, row, w, w->files->executor, w->error);
}

static size_t count_nodes(const struct writer *w)
{
    return (size_t)w->n_vertices + (w->n_nodes == 6 ? (size_t)w->edges.n : 0);
}

static enum tri_status write_node(struct writer *w, struct tri_output *output)
{
    size_t n = count_nodes(w);
    const int64_t counts[] = {(int64_t)n, 2, w->n_attributes, !w->switches->no_markers};
    enum tri_status status = tri_write_counts(output, counts, 4, w->error);
    return status ? status : write_rows(w, output, n, tri_row_node_bytes(w->n_attributes), node_row);
}

static enum tri_status write_ele(struct writer *w, struct tri_output *output)
{
    const int64_t counts[] = {w->mesh->n_slots, w->n_nodes, w->n_columns};
    enum tri_status status = tri_write_counts(output, counts, 3, w->error);
    size_t row_bytes = tri_row_ele_bytes(w->n_nodes, w->n_columns);
    return status ? status : write_rows(w, output, (size_t)w->mesh->n_slots, row_bytes, ele_row);
}

static void add_segment(const struct writer *w, struct tri_pslg *pslg, const int32_t v[2], int32_t marker)
{
    int32_t from = number_of(w, v[0]), to = number_of(w, v[1]);
    if (from == TRI_NONE || to == TRI_NONE)
        return;
    pslg->segments[2 * (size_t)pslg->n_segments] = from;
    pslg->segments[2 * (size_t)pslg->n_segments + 1] = to;
    pslg->segment_markers[pslg->n_segments++] = marker;
}

/* The subsegments, then the segments of the input that are no edges of the mesh (-rp). */
static void list_segments(const struct writer *w, struct tri_pslg *pslg)
{
    const struct tri_pslg *input = w->files->pslg;
    const int32_t *markers = input->segment_markers;
    for (int32_t s = 0; s < w->mesh->n_subs; s++)
        add_segment(w, pslg, w->mesh->sub[s].v, w->mesh->sub[s].marker);
    for (int32_t k = 0; w->files->is_edge && w->switches->segments && k < input->n_segments; k++)
        if (!w->files->is_edge[k])
            add_segment(w, pslg, &input->segments[2 * (size_t)k], markers ? markers[k] : 0);
}

/* Subsegments are few beside triangles, so that a copy of them costs nothing. */
static enum tri_status write_poly(struct writer *w, struct tri_output *output)
{
    const struct tri_pslg *input = w->files->pslg;
    bool read_regions = tri_switches_use_regions(w->switches);
    size_t n = (size_t)w->mesh->n_subs + (size_t)input->n_segments + 1;
    struct tri_pslg pslg = {.n_attributes = w->n_attributes, .n_holes = input->n_holes, .holes = input->holes,
                            .n_regions = read_regions ? input->n_regions : 0, .regions = input->regions};
    pslg.segments = malloc(n * 2 * sizeof *pslg.segments);
    pslg.segment_markers = malloc(n * sizeof *pslg.segment_markers);
    struct tri_layout layout = {w->base, w->files->executor};
    enum tri_status status;
    if (pslg.segments && pslg.segment_markers) {
        list_segments(w, &pslg);
        status = tri_write_poly(output, &layout, &pslg, !w->switches->no_markers, w->error);
    } else {
        status = tri_fail(w->error, TRI_NO_MEMORY, NULL, 0, "out of memory for %zu segments", n);
    }
    free(pslg.segments);
    free(pslg.segment_markers);
    return status;
}

static enum tri_status write_edge(struct writer *w, struct tri_output *output)
{
    enum tri_status status = tri_write_counts(output, (int64_t[]){w->edges.n, !w->switches->no_markers}, 2, w->error);
    return status ? status : write_rows(w, output, (size_t)w->edges.n, TRI_ROW_EDGE_BYTES, edge_row);
}

static enum tri_status write_v_node(struct writer *w, struct tri_output *output)
{
    size_t n = (size_t)w->mesh->n_slots;
    enum tri_status status = tri_write_counts(output, (int64_t[]){(int64_t)n, 2, w->n_attributes, 0}, 4, w->error);
    return status ? status : write_rows(w, output, n, tri_row_node_bytes(w->n_attributes), v_node_row);
}

static enum tri_status write_v_edge(struct writer *w, struct tri_output *output)
{
    enum tri_status status = tri_write_counts(output, (int64_t[]){w->edges.n, 0}, 2, w->error);
    return status ? status : write_rows(w, output, (size_t)w->edges.n, TRI_ROW_V_EDGE_BYTES, v_edge_row);
}

static enum tri_status write_neigh(struct writer *w, struct tri_output *output)
{
    enum tri_status status = tri_write_counts(output, (int64_t[]){w->mesh->n_slots, 3}, 2, w->error);
    return status ? status : write_rows(w, output, (size_t)w->mesh->n_slots, TRI_ROW_NEIGH_BYTES, neigh_row);
}

/* --- .off: always counts from 0 */

static char *off_vertex_row(void *user, size_t i, char *at)
{
    const struct writer *w = user;
    double xy[2];
    if (i >= (size_t)w->n_vertices) {
        struct tri_blend middle = tri_edge_middle(w->mesh, w->edges.codes[i - (size_t)w->n_vertices]);
        memcpy(xy, middle.at, sizeof xy);
    } else {
        tri_mesh_place(w->mesh, w->used.vertex ? w->used.vertex[i] : (int32_t)i, xy);
    }
    *at = ' ';
    at = tri_print_real(at + 1, xy[0]);
    memcpy(at, "  ", 2);
    at = tri_print_real(at + 2, xy[1]);
    memcpy(at, "  0\n", 4);
    return at + 4;
}

static char *off_face_row(void *user, size_t i, char *at)
{
    const struct writer *w = user;
    memcpy(at, " 3 ", 3);
    at += 3;
    for (int k = 0; k < 3; k++) {
        memcpy(at, "  ", 2);
        at = tri_print_integer(at + 2, number_of(w, w->mesh->tri[i].v[k]), 4);
    }
    *at = '\n';
    return at + 1;
}

static enum tri_status write_off(struct writer *w, struct tri_output *output)
{
    size_t n = count_nodes(w), n_faces = (size_t)w->mesh->n_slots;
    enum tri_status status = tri_write_off_header(output, n, n_faces, (size_t)w->edges.n, w->error);
    status = status ? status : write_rows(w, output, n, tri_row_node_bytes(0), off_vertex_row);
    return status ? status : write_rows(w, output, n_faces, tri_row_ele_bytes(3, 0), off_face_row);
}

/* --- the table of files, in the order in which they are written */

static enum plan asked(bool by_switch) { return by_switch ? WRITTEN : NOT_ASKED; }

static enum plan plan_node(const struct mesh_files *f)
{
    const struct tri_switches *s = &f->arguments->switches;
    return s->no_node || (s->no_iteration && !f->points_in_poly) ? SUPPRESSED : WRITTEN;
}

static enum plan plan_ele(const struct mesh_files *f) { return f->arguments->switches.no_ele ? SUPPRESSED : WRITTEN; }

static enum plan plan_poly(const struct mesh_files *f)
{
    const struct tri_switches *s = &f->arguments->switches;
    if (!s->segments && !s->keep_hull)
        return NOT_ASKED;
    return s->no_poly || s->no_iteration ? SUPPRESSED : WRITTEN;
}

static enum plan plan_off(const struct mesh_files *f) { return asked(f->arguments->switches.off); }
static enum plan plan_edge(const struct mesh_files *f) { return asked(f->arguments->switches.edges); }
static enum plan plan_voronoi(const struct mesh_files *f) { return asked(f->arguments->switches.voronoi); }
static enum plan plan_neigh(const struct mesh_files *f) { return asked(f->arguments->switches.neighbors); }

static const struct kind {
    const char *suffix, *article;
    enum plan (*plan)(const struct mesh_files *files);
    enum tri_status (*write)(struct writer *w, struct tri_output *output);
} kinds[] = {
    {".node", "a", plan_node, write_node},
    {".ele", "an", plan_ele, write_ele},
    {".poly", "a", plan_poly, write_poly},
    {".off", "an", plan_off, write_off},
    {".edge", "an", plan_edge, write_edge},
    {".v.node", "a", plan_voronoi, write_v_node},
    {".v.edge", "a", plan_voronoi, write_v_edge},
    {".neigh", "a", plan_neigh, write_neigh},
};

enum { N_KINDS = sizeof kinds / sizeof *kinds };

/* --- all together */

/* Columns of triangle attributes in the .ele file: with -r those of the input, else one with -A and regions. */
static int32_t count_columns(const struct mesh_files *f)
{
    const struct tri_switches *s = &f->arguments->switches;
    return s->mesh ? f->mesh->n_columns : s->regions && s->segments && f->pslg->n_regions > 0;
}

/* Which vertices are written? */
static enum tri_status choose_vertices(struct writer *w)
{
    const struct mesh_files *f = w->files;
    enum tri_status status = tri_kept_make(&w->used, f->mesh, f->elements, w->switches->jettison, w->error);
    w->n_vertices = w->used.number ? w->used.n : f->mesh->n_vertices;
    return status;
}

/* One file more in a set on trial. */
static enum tri_status try_file(struct tri_output_set *set, const char *path, const struct file_names *read,
                                struct tri_error *error)
{
    struct tri_output *output;
    for (int i = 0; i < read->n; i++)
        if (tri_is_same_file(path, read->name[i]))
            return tri_fail(error, TRI_CANNOT_WRITE, path, 0, "would be overwritten, a file of the input");
    return interrupt_open(set, path, &output, error);
}

static enum tri_status try_all(struct tri_output_set *set, const struct mesh_files *files,
                               const struct file_names *further, const struct file_names *read,
                               struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (int k = 0; k < N_KINDS && !status; k++) {
        if (kinds[k].plan(files) != WRITTEN)
            continue;
        char *path = joined(files->arguments->output, kinds[k].suffix);
        status = path ? try_file(set, path, read, error)
                      : tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for file names");
        free(path);
    }
    for (int i = 0; i < further->n && !status; i++)
        status = try_file(set, further->name[i], read, error);
    return status;
}

enum tri_status mesh_files_check(const struct mesh_files *files, const struct file_names *further,
                                 const struct file_names *read, struct tri_error *error)
{
    static struct tri_output_set set; /* outlives this call, since signals look at it */
    interrupt_begin(&set);
    set.trial = true;
    enum tri_status status = try_all(&set, files, further, read, error);
    interrupt_drop(&set);
    return status;
}

static enum tri_status prepare(struct writer *w)
{
    const struct mesh_files *f = w->files;
    w->switches = &f->arguments->switches;
    w->mesh = f->mesh;
    w->base = f->base;
    w->n_attributes = f->mesh->n_attributes;
    w->n_nodes = w->switches->second_order ? 6 : 3;
    w->n_columns = count_columns(f);
    enum tri_status status = choose_vertices(w);
    bool numbers = w->switches->second_order;
    if (!status && (numbers || w->switches->edges || w->switches->voronoi || w->switches->off))
        status = tri_edge_list_make(&w->edges, f->mesh, numbers, w->error);
    return status;
}

static enum tri_status write_file(struct writer *w, const struct kind *kind, struct tri_output_set *set)
{
    char *path = joined(w->files->arguments->output, kind->suffix);
    if (!path)
        return tri_fail(w->error, TRI_NO_MEMORY, NULL, 0, "out of memory for file names");
    console_say(w->files->console, "Writing %s.\n", path);
    struct tri_output *output;
    enum tri_status status = interrupt_open(set, path, &output, w->error);
    free(path);
    status = status ? status : kind->write(w, output);
    return status ? status : tri_write_comment(output, w->files->arguments->argc, w->files->arguments->argv, w->error);
}

static enum tri_status write_all(struct writer *w, struct tri_output_set *set)
{
    for (int k = 0; k < N_KINDS; k++) {
        enum plan plan = kinds[k].plan(w->files);
        if (plan == SUPPRESSED)
            console_say(w->files->console, "NOT writing %s %s file.\n", kinds[k].article, kinds[k].suffix);
        enum tri_status status = plan == WRITTEN ? write_file(w, &kinds[k], set) : TRI_OK;
        if (status)
            return status;
    }
    return TRI_OK;
}

enum tri_status mesh_files_write(const struct mesh_files *files, struct tri_output_set *set, struct tri_error *error)
{
    struct writer w = {.files = files, .error = error};
    enum tri_status status = prepare(&w);
    status = status ? status : write_all(&w, set);
    tri_edge_list_free(&w.edges);
    tri_used_free(&w.used);
    return status;
}
