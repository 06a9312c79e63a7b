/* Lists the parents at each vertex (struct tri_incidence), and classifies how two parents meet. */
#include "triangle/mesh/parents.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/heap_sort.h"
#include "triangle/geometry/predicates.h"
#include "triangle/mesh/cavity.h"
#include "triangle/tunables.h"

/* If more parents than this end at a vertex, they are sorted by direction. */
enum { MANY_PARENTS = 16 };

bool tri_turns_before(struct tri_point o, struct tri_point a, struct tri_point b)
{
    bool a_down = a.y < o.y || (a.y == o.y && a.x < o.x), b_down = b.y < o.y || (b.y == o.y && b.x < o.x);
    return a_down != b_down ? b_down : tri_orient2d(o, a, b) > 0;
}

/* Returns the end of the parent that is not vertex v. */
static struct tri_point far_end(const struct tri_mesh *mesh, tri_parent_id parent, tri_vertex_id v)
{
    const int32_t *ends = mesh->parents[parent].v;
    return mesh->xy[ends[ends[0] == v]];
}

struct hub {
    const struct tri_mesh *mesh;
    tri_vertex_id vertex;
};

static bool is_before(const void *context, int32_t a, int32_t b)
{
    const struct hub *hub = context;
    return tri_turns_before(hub->mesh->xy[hub->vertex], far_end(hub->mesh, a, hub->vertex),
                            far_end(hub->mesh, b, hub->vertex));
}

void tri_incidence_fill(struct tri_mesh *mesh)
{
    size_t n = (size_t)mesh->incidence.n_vertices;
    int32_t *fill = mesh->incidence.start + 1; /* shifted by one, so that filling leaves the final starts in place */
    memset(mesh->incidence.start, 0, (n + 2) * sizeof *mesh->incidence.start);
    for (tri_parent_id p = 0; p < mesh->n_parents; p++)
        for (int k = 0; k < 2; k++)
            fill[mesh->parents[p].v[k] + 1]++;
    for (size_t v = 0; v < n; v++)
        fill[v + 1] += fill[v];
    for (tri_parent_id p = 0; p < mesh->n_parents; p++)
        for (int k = 0; k < 2; k++)
            mesh->incidence.parent[fill[mesh->parents[p].v[k]]++] = p;
    assert(mesh->incidence.start[n] == 2 * mesh->n_parents);
    for (tri_vertex_id v = 0; v < mesh->incidence.n_vertices; v++) {
        const int32_t first = mesh->incidence.start[v], n_parents = mesh->incidence.start[v + 1] - first;
        if (n_parents > MANY_PARENTS)
            tri_heap_sort(mesh->incidence.parent + first, n_parents, is_before, &(struct hub){mesh, v});
    }
}

enum tri_status tri_incidence_list(struct tri_mesh *mesh, struct tri_error *error)
{
    assert(!mesh->incidence.start && !mesh->incidence.parent);
    mesh->incidence.start = malloc(((size_t)mesh->n_vertices + 2) * sizeof *mesh->incidence.start);
    mesh->incidence.parent = malloc((2 * (size_t)mesh->n_parents + 1) * sizeof *mesh->incidence.parent);
    if (!mesh->incidence.start || !mesh->incidence.parent) {
        free(mesh->incidence.start);
        free(mesh->incidence.parent);
        mesh->incidence = (struct tri_incidence){0};
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d segments", (int)mesh->n_parents);
    }
    mesh->incidence.n_vertices = mesh->n_vertices;
    tri_incidence_fill(mesh);
    return TRI_OK;
}

/* Returns the parents that vertex v lies on: the one it was inserted on, or those that end at v. */
static const tri_parent_id *parents_of(const struct tri_mesh *mesh, tri_vertex_id v, int32_t *n)
{
    *n = 0;
    if (mesh->on[v] >= 0) {
        *n = 1;
        return &mesh->on[v];
    }
    if (v >= mesh->incidence.n_vertices)
        return NULL;
    *n = mesh->incidence.start[v + 1] - mesh->incidence.start[v];
    return mesh->incidence.parent + mesh->incidence.start[v];
}

/* Selects four of the n parents at a hub, which are sorted by direction: the two before the direction to q and the two
 * after it. A parent on which q lies, up to rounding, is among them, and so are its neighbours on both sides. */
static int list_neighbours(const struct tri_mesh *mesh, tri_vertex_id hub, const tri_parent_id *incident, int32_t n,
                           struct tri_point q, tri_parent_id *beside)
{
    assert(n > MANY_PARENTS);
    int32_t low = 0, high = n;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (tri_turns_before(mesh->xy[hub], far_end(mesh, incident[middle], hub), q))
            low = middle + 1;
        else
            high = middle;
    }
    for (int k = 0; k < 4; k++)
        beside[k] = incident[(low + n + k - 2) % n];
    return 4;
}

const tri_parent_id *tri_parents_beside(const struct tri_mesh *mesh, tri_vertex_id u, tri_vertex_id v,
                                           tri_vertex_id w, tri_parent_id beside[8], int32_t *n)
{
    const tri_parent_id *incident = parents_of(mesh, u, n);
    if (*n <= MANY_PARENTS)
        return incident;
    int32_t all = *n;
    *n = list_neighbours(mesh, u, incident, all, mesh->xy[v], beside);
    *n += list_neighbours(mesh, u, incident, all, mesh->xy[w], beside + *n);
    return beside;
}

bool tri_is_on_parent(const struct tri_mesh *mesh, tri_vertex_id v)
{
    int32_t n;
    parents_of(mesh, v, &n);
    return n > 0;
}

/* Does a parent join the two vertices? Searches the shorter of their lists, since one vertex may be a hub. */
static bool are_joined(const struct tri_mesh *mesh, tri_vertex_id u, tri_vertex_id v)
{
    int32_t nu, nv;
    const tri_parent_id *pu = parents_of(mesh, u, &nu), *pv = parents_of(mesh, v, &nv);
    for (int32_t i = 0; i < (nu < nv ? nu : nv); i++) {
        const tri_vertex_id *ends = mesh->parents[(nu < nv ? pu : pv)[i]].v;
        if ((ends[0] == u && ends[1] == v) || (ends[0] == v && ends[1] == u))
            return true;
    }
    return false;
}

tri_vertex_id tri_common_end(const struct tri_mesh *mesh, tri_parent_id parent, tri_vertex_id v)
{
    const tri_vertex_id *ends = mesh->parents[parent].v;
    const int32_t on = mesh->on[v];
    for (int k = 0; k < 2; k++) {
        const tri_vertex_id *others = on >= 0 ? mesh->parents[on].v : NULL;
        if (others ? others[0] == ends[k] || others[1] == ends[k] : are_joined(mesh, ends[k], v))
            return ends[k];
    }
    return TRI_NONE;
}

/* Classifies the angle between the legs oa and ob. */
static enum tri_corner corner_at(struct tri_point o, struct tri_point a, struct tri_point b)
{
    double ax = a.x - o.x, ay = a.y - o.y, bx = b.x - o.x, by = b.y - o.y;
    double dot = ax * bx + ay * by, sine = fabs(ax * by - ay * bx);
    if (!(dot > 0 && 3 * dot * dot > sine * sine))
        return TRI_WIDE_CORNER;
    return TRI_SHARP * sine > dot ? TRI_NARROW_CORNER : TRI_SPIKE;
}

enum tri_corner tri_corner_between(const struct tri_mesh *mesh, tri_parent_id p, tri_parent_id q)
{
    const tri_vertex_id *a = mesh->parents[p].v, *b = mesh->parents[q].v;
    for (int i = 0; p != q && i < 2; i++)
        for (int k = 0; k < 2; k++)
            if (a[i] == b[k])
                return corner_at(mesh->xy[a[i]], mesh->xy[a[1 - i]], mesh->xy[b[1 - k]]);
    return TRI_APART;
}

bool tri_touches(const struct tri_mesh *mesh, tri_parent_id parent, tri_vertex_id v)
{
    const struct tri_parent *p = &mesh->parents[parent];
    struct tri_relative a = tri_relative(&mesh->xy[p->v[0]], mesh->xy[v]);
    struct tri_relative b = tri_relative(&mesh->xy[p->v[1]], mesh->xy[v]);
    double x = b.x - a.x, y = b.y - a.y, l = x * x + y * y, cross = tri_cross(a, b);
    if (a.l > b.l + l || b.l > a.l + l)
        return tri_lesser(a.l, b.l) < mesh->limits.shortest2;
    return cross * cross < mesh->limits.shortest2 * l;
}
