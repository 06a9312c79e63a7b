/* Makes many lattice triangles (cells) at once, where large areas are free of features.
 *
 * First the free sites are found (sites.h). A cell exists if its three sites are free or occupied by a vertex. A
 * site belongs to the rim if some, but not all, of the six triangles around it are cells. Rim sites are inserted one
 * by one like any other point, until the border of the cells is a chain of mesh edges. The triangles inside the
 * border are then replaced by the cells, which are all good. All other triangles are left to the refinement loop.
 *
 * THEOREM (docs/theory.md, the lattice). The result is the constrained Delaunay triangulation of its vertices:
 * inside the border there are only sites, and is_delaunay tests that no vertex across the border lies in the
 * circumcircle of a cell.
 *
 * INVARIANT. The mesh is valid after each rim insertion. Every step that may fail comes before the first cell is
 * made. */
#include "triangle/refine/refiner.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/base/grow.h"
#include "triangle/geometry/predicates.h"
#include "triangle/refine/sites.h"
#include "triangle/tunables.h"

/* A triangle that is too large. */
struct large {
    double area2;           /* twice the bound on its area */
    struct tri_entry entry; /* the triangle and its generation number */
    int32_t place;          /* index in the worklist or, after the worklist, in the queue */
};

struct place {
    int32_t row, column; /* as in struct tri_sites */
};

/* An edge of the border, as seen from the triangles on both sides. */
struct border {
    tri_halfedge inside;  /* half-edge of the triangle inside */
    tri_halfedge outside; /* half-edge of the triangle outside */
    tri_region_id region; /* region on the inside */
};

struct tri_fill {
    struct large *large;   /* [n_large] sorted by bound, then by place */
    int32_t n_large, large_capacity; /* entries of `large`; allocated */
    int32_t done;          /* the current sites are those for the bound of large[done] */
    double cells;          /* number of cells that fit into these triangles */
    struct tri_sites sites;          /* the sites of the current bound */
    bool has_sites;        /* true: the sites for the current bound have been found */
    struct place *check;   /* [n_check] sites whose neighbourhood has changed, to be looked at */
    int32_t n_check, check_capacity; /* entries of `check`; allocated */
    struct border *border; /* [n_border] border edges in the order of the cells */
    int32_t n_border, border_capacity; /* entries of `border`; allocated */
    int32_t n_new, n_cells;  /* sites without a vertex; cells */
    tri_triangle_id *number; /* [n_numbers] triangle numbers for the cells, those of replaced triangles first */
    int32_t n_numbers, number_capacity; /* entries of `number`; allocated */
    int32_t n_reused;        /* leading entries of `number` that belonged to replaced triangles */
};

/* Marks the links from triangles inside to the outside during the walk over the inside. No subsegment has this
 * number. */
static const tri_link CUT = TRI_BEYOND + 1;

/* --- sites and cells */

/* The neighbours of a site, counter-clockwise from the right. In an odd row, the upper and lower neighbours are one
 * column farther to the right than in an even row. */
enum { RIGHT, UP_RIGHT, UP_LEFT, LEFT, DOWN_LEFT, DOWN_RIGHT, AROUND };

static struct place next_to(struct place at, int k)
{
    static const int row[AROUND] = {0, 1, 1, 0, -1, -1}, column[AROUND] = {1, 0, -1, -1, -1, 0};
    return (struct place){at.row + row[k], at.column + column[k] + (row[k] & at.row & 1)};
}

static int32_t site_at(const struct tri_fill *f, struct place at) { return tri_site(&f->sites, at.row, at.column); }

static bool is_in(const struct tri_fill *f, struct place at)
{
    return f->sites.at[site_at(f, at)] != TRI_SITE_OUT;
}

/* Where the neighbours of the sites of a row are stored, as differences between indices. */
struct around {
    int32_t up, down; /* from a site to its upper right and lower right neighbours; each upper left and lower left
                         neighbour is stored directly before */
    int32_t up2;      /* from a site to the one two rows above, in the same column */
};

/* Computes the differences for a row at least TRI_SITE_MARGIN rows from the first and the last. If one of the rows is
 * empty, differences to it are not indices. Only sites that are not TRI_SITE_OUT use them, and around these no row is
 * empty. */
static struct around around_row(const struct tri_sites *s, int32_t row)
{
    const int32_t shift = row & 1, base = s->row[row].base;
    return (struct around){s->row[row + 1].base + shift - base, s->row[row - 1].base + shift - base,
                           s->row[row + 2].base - base};
}

/* Returns a bit mask: bit k is set if neighbour k is not TRI_SITE_OUT. site: index of a site that is not
 * TRI_SITE_OUT. */
static unsigned neighbours_in(const struct tri_sites *s, struct around to, int32_t site)
{
    const int32_t *at = s->at + site;
    return (unsigned)(at[1] != TRI_SITE_OUT) | (unsigned)(at[to.up] != TRI_SITE_OUT) << 1 |
           (unsigned)(at[to.up - 1] != TRI_SITE_OUT) << 2 | (unsigned)(at[-1] != TRI_SITE_OUT) << 3 |
           (unsigned)(at[to.down - 1] != TRI_SITE_OUT) << 4 | (unsigned)(at[to.down] != TRI_SITE_OUT) << 5;
}

enum { ALL_IN = (1 << AROUND) - 1 };

/* Do both cells of a site (find_cell) exist, with a cell across each of their edges? False also for a few sites next to
 * TRI_SITE_OUT. */
static bool is_inner(const struct tri_sites *s, struct around to, int32_t site)
{
    return neighbours_in(s, to, site) == ALL_IN && s->at[site + to.up + 1] != TRI_SITE_OUT &&
           s->at[site + to.up2] != TRI_SITE_OUT;
}

/* Does at least one cell around the site exist? in: its neighbours as returned by neighbours_in. */
static bool has_cell(unsigned in) { return in & (in >> 1 | in << (AROUND - 1)); }

/* A cell: its sites counter-clockwise. across[k] is the third site of the cell across the edge opposite to site k. */
struct cell {
    int32_t site[3], across[3]; /* indices of sites */
    struct place at; /* position of site 0 */
    bool by_edge;    /* the cell stands on its lower edge; false: on its lowest corner */
};

/* Returns the positions of the sites of a cell. */
static struct place place_in_cell(const struct cell *c, int k)
{
    return k == 0 ? c->at : next_to(c->at, c->by_edge ? (k == 1 ? RIGHT : UP_RIGHT) : (k == 1 ? UP_RIGHT : UP_LEFT));
}

/* Finds the cell whose lower edge starts at this site (by_edge), or the cell whose lowest corner is this site.
 * Returns false if it does not exist. */
static bool find_cell(const struct tri_sites *s, struct around to, struct place at, bool by_edge, struct cell *c)
{
    const int32_t site = tri_site(s, at.row, at.column), up = site + to.up;
    if (s->at[up] == TRI_SITE_OUT || s->at[by_edge ? site + 1 : up - 1] == TRI_SITE_OUT)
        return false;
    *c = by_edge ? (struct cell){{site, site + 1, up}, {up + 1, up - 1, site + to.down}, at, true}
                 : (struct cell){{site, up, up - 1}, {site + to.up2, site - 1, site + 1}, at, false};
    return true;
}

/* Calls `visit` for each cell, row by row from left to right, until a call does not return DONE. `inner`, unless it is
 * NULL: counts the cells of inner sites, which are not visited. */
static inline enum tri_outcome each_cell(struct tri_refiner *r, int32_t *inner,
                                         enum tri_outcome (*visit)(struct tri_refiner *r, const struct cell *c))
{
    const struct tri_sites *s = &r->fill->sites;
    struct cell c;
    for (struct place at = {TRI_SITE_MARGIN, 0}; at.row < s->n_rows - TRI_SITE_MARGIN; at.row++) {
        const struct around to = around_row(s, at.row);
        for (at.column = s->row[at.row].first; at.column <= s->row[at.row].last; at.column++) {
            const int32_t site = tri_site(s, at.row, at.column);
            if (s->at[site] == TRI_SITE_OUT)
                continue;
            if (inner && is_inner(s, to, site)) {
                *inner += 2;
                continue;
            }
            for (int by_edge = 0; by_edge < 2; by_edge++)
                if (find_cell(s, to, at, by_edge, &c)) {
                    const enum tri_outcome outcome = visit(r, &c);
                    if (outcome != DONE)
                        return outcome;
                }
        }
    }
    return DONE;
}

/* --- inserting the rim */

static bool check(struct tri_fill *f, struct place at)
{
    if (!tri_grow(&f->check, &f->check_capacity, f->n_check + 1, sizeof *f->check))
        return false;
    f->check[f->n_check++] = at;
    return true;
}

/* Pushes the neighbours of a site onto the list of sites to look at. Returns FAILED if memory ran out. */
static enum tri_outcome check_around(struct tri_fill *f, struct place at)
{
    for (int k = 0; k < AROUND; k++)
        if (is_in(f, next_to(at, k)) && !check(f, next_to(at, k)))
            return FAILED;
    return DONE;
}

static enum tri_outcome drop_site(struct tri_fill *f, struct place at)
{
    f->sites.at[site_at(f, at)] = TRI_SITE_OUT;
    return check_around(f, at);
}

/* Updates the `near` triangles of sites whose vertices are corners of the last fan. */
static void note_fan(const struct tri_refiner *r)
{
    const struct tri_sites *s = &r->fill->sites;
    for (int32_t i = 0; i < r->cavity.n_edges; i++)
        for (int k = 1; k < 3; k++) { /* corner 0 is the new vertex */
            const tri_vertex_id v = r->mesh->tri[r->cavity.tri[i]].v[k];
            const int32_t site = tri_site_of(s, r->mesh->xy[v]);
            if (site != TRI_NONE && s->at[site] == v)
                s->near[site] = r->cavity.tri[i];
        }
}

/* Walks from *t to the triangle that contains p. REFUSED: a subsegment or the fence is in the way. */
static enum tri_outcome walk_to(struct tri_refiner *r, struct tri_point p, tri_triangle_id *t)
{
    const struct tri_mesh *m = r->mesh;
    for (int step = 0; step < TRI_LATTICE_STEPS; step++) {
        const struct tri_triangle *at = &m->tri[*t];
        int e = 0;
        while (e < 3 && tri_orient2d(m->xy[at->v[tri_next[e]]], m->xy[at->v[tri_prev[e]]], p) >= 0)
            e++;
        if (e == 3)
            return DONE;
        if (at->n[e] == TRI_BEYOND)
            return tri_request_beyond(r, (tri_vertex_id[]){at->v[tri_next[e]], at->v[tri_prev[e]]});
        if (at->n[e] < 0 || !tri_fence_owns(r->hooks->fence, m, tri_of(at->n[e])))
            return REFUSED;
        *t = tri_of(at->n[e]);
    }
    return REFUSED;
}

/* Inserts a rim site. */
static enum tri_outcome insert_site(struct tri_refiner *r, struct place at)
{
    struct tri_sites *s = &r->fill->sites;
    const int32_t site = site_at(r->fill, at);
    const struct tri_point p = tri_site_place(s, at.row, at.column);
    for (;;) {
        tri_triangle_id t = s->near[site]; /* determined anew after each split, so that a pause does not change it */
        for (int k = 0; k < AROUND; k++)
            if (s->at[site_at(r->fill, next_to(at, k))] >= 0)
                t = s->near[site_at(r->fill, next_to(at, k))];
        enum tri_outcome outcome = walk_to(r, p, &t);
        if (outcome == DONE)
            outcome = tri_insert_in_lattice(r, t, p, &s->lattice);
        if (outcome != DONE && outcome != AGAIN)
            return outcome;
        note_fan(r);
        if (outcome == AGAIN)
            continue;
        s->at[site] = r->mesh->n_vertices - 1;
        s->near[site] = r->cavity.tri[0];
        return DONE;
    }
}

/* Looks at a site. If all triangles around it are cells, it waits to be filled. If only some are, it is a rim site
 * and is inserted. If none is, it is left out. */
static enum tri_outcome look_at_site(struct tri_refiner *r, struct place at)
{
    struct tri_fill *f = r->fill;
    if (!is_in(f, at))
        return DONE;
    const unsigned in = neighbours_in(&f->sites, around_row(&f->sites, at.row), site_at(f, at));
    if (in == ALL_IN)
        return DONE;
    if (!has_cell(in))
        return drop_site(f, at);
    if (f->sites.at[site_at(f, at)] != TRI_SITE_FREE)
        return DONE;
    const enum tri_outcome outcome = insert_site(r, at);
    if (outcome == FAILED)
        return FAILED;
    return outcome == DONE ? check_around(f, at) : drop_site(f, at);
}

/* Looks at all sites in the list. FAILED: the current site is still in the list. */
static enum tri_outcome look_at_sites(struct tri_refiner *r)
{
    struct tri_fill *f = r->fill;
    while (f->n_check > 0) {
        if (tri_refiner_must_stop(r))
            return FAILED;
        const struct place at = f->check[--f->n_check];
        if (look_at_site(r, at) == FAILED) {
            check(f, at); /* this cannot fail for lack of room, because the entry was just popped */
            return FAILED;
        }
    }
    return DONE;
}

/* --- the border */

/* Finds the half-edge ab in the triangle on its left. Sets *edge to TRI_NONE if ab is not an edge of the mesh. t: a
 * triangle at a. */
static enum tri_outcome find_edge(struct tri_refiner *r, tri_triangle_id t, tri_vertex_id a, tri_vertex_id b,
                                  tri_halfedge *edge)
{
    const struct tri_triangle *tri = r->mesh->tri;
    *edge = TRI_NONE;
    for (int turn = 0; turn < 2; turn++) { /* around a, counter-clockwise first, then clockwise if a subsegment
                                              blocks the way */
        const int *side = turn == 0 ? tri_next : tri_prev;
        for (tri_triangle_id at = t;;) {
            const int k = tri_corner_of(&tri[at], a);
            if (tri[at].v[tri_next[k]] == b) {
                *edge = tri_code(at, tri_prev[k]);
                return DONE;
            }
            const tri_link link = tri[at].n[side[k]];
            if (link == TRI_BEYOND)
                return tri_request_beyond(r, (tri_vertex_id[]){a, tri[at].v[turn == 0 ? tri_prev[k] : tri_next[k]]});
            if (link < 0)
                break;
            at = tri_of(link);
            if (at == t)
                return DONE;
        }
    }
    return DONE;
}

/* Is the apex across the border not inside the circumcircle of the cell? */
static bool is_delaunay(const struct tri_refiner *r, const struct cell *c, tri_halfedge outside)
{
    const struct tri_sites *s = &r->fill->sites;
    struct tri_point p[3];
    for (int k = 0; k < 3; k++)
        p[k] = tri_site_place(s, place_in_cell(c, k).row, place_in_cell(c, k).column);
    return tri_incircle(p[0], p[1], p[2], r->mesh->xy[tri_apex(r->mesh, outside)]) <= 0;
}

/* Lists the border edges of a cell. If an edge is missing or does not qualify, its two sites are left out. */
static enum tri_outcome list_border(struct tri_refiner *r, const struct cell *c)
{
    struct tri_fill *f = r->fill;
    const struct tri_sites *s = &f->sites;
    const tri_vertex_id v[3] = {s->at[c->site[0]], s->at[c->site[1]], s->at[c->site[2]]};
    f->n_cells++;
    if (s->at[c->across[0]] != TRI_SITE_OUT && s->at[c->across[1]] != TRI_SITE_OUT &&
        s->at[c->across[2]] != TRI_SITE_OUT)
        return DONE;
    for (int e = 0; e < 3; e++) {
        const int a = tri_next[e], b = tri_prev[e];
        if (s->at[c->across[e]] != TRI_SITE_OUT || v[a] < 0 || v[b] < 0)
            continue;
        struct border border = {TRI_NONE, TRI_NONE, 0};
        if (find_edge(r, s->near[c->site[a]], v[a], v[b], &border.inside) == FAILED)
            return FAILED;
        if (border.inside != TRI_NONE) {
            border.outside = *tri_link_at(r->mesh, border.inside);
            border.region = r->mesh->tri[tri_of(border.inside)].region;
        }
        if (border.outside == TRI_BEYOND)
            return tri_request_beyond(r, (tri_vertex_id[]){v[a], v[b]});
        if (border.outside < 0 || !is_delaunay(r, c, border.outside)) {
            if (drop_site(f, place_in_cell(c, a)) == FAILED || drop_site(f, place_in_cell(c, b)) == FAILED)
                return FAILED;
            continue;
        }
        if (!tri_grow(&f->border, &f->border_capacity, f->n_border + 1, sizeof *f->border))
            return FAILED;
        f->border[f->n_border++] = border;
    }
    return DONE;
}

/* Inserts the rim, lists the border of the cells, and counts the sites without a vertex. */
static enum tri_outcome settle_rim(struct tri_refiner *r)
{
    struct tri_fill *f = r->fill;
    do {
        f->n_border = f->n_cells = f->n_new = 0;
        if (look_at_sites(r) == FAILED || each_cell(r, &f->n_cells, list_border) == FAILED)
            return FAILED;
    } while (f->n_check > 0);
    for (int32_t i = 0; i < f->sites.n; i++)
        f->n_new += f->sites.at[i] == TRI_SITE_FREE;
    return DONE;
}

/* --- removing the triangles inside */

/* Reverts the changes of walk_inside. */
static void revert_inside(const struct tri_refiner *r)
{
    const struct tri_fill *f = r->fill;
    for (int32_t i = 0; i < f->n_numbers; i++)
        r->mesh->tri[f->number[i]].region = ~r->mesh->tri[f->number[i]].region;
    for (int32_t i = 0; i < f->n_border; i++)
        *tri_link_at(r->mesh, f->border[i].inside) = f->border[i].outside;
}

/* Marks a triangle as inside and lists its number. Returns false if there are too many triangles, or if regions
 * meet. */
static bool note_inside(const struct tri_refiner *r, tri_triangle_id t, tri_region_id region)
{
    struct tri_fill *f = r->fill;
    struct tri_triangle *at = &r->mesh->tri[t];
    if (at->region == ~region)
        return true;
    if (at->region != region || f->n_numbers == f->n_cells)
        return false;
    at->region = ~region;
    f->number[f->n_numbers++] = t;
    return true;
}

/* Marks the neighbours of a triangle inside as inside. */
static enum tri_outcome mark_neighbours(struct tri_refiner *r, tri_triangle_id inside)
{
    const struct tri_triangle *t = &r->mesh->tri[inside];
    for (int e = 0; e < 3; e++) {
        if (t->n[e] == TRI_BEYOND)
            return tri_request_beyond(r, (tri_vertex_id[]){t->v[tri_next[e]], t->v[tri_prev[e]]});
        if (t->n[e] != CUT && (t->n[e] < 0 || !note_inside(r, tri_of(t->n[e]), ~t->region)))
            return REFUSED;
    }
    return DONE;
}

/* Lists the triangles inside the border, marks them by inverting their regions, and cuts their links to the outside.
 * REFUSED: not only sites are inside; the mesh is unchanged. */
static enum tri_outcome walk_inside(struct tri_refiner *r)
{
    struct tri_fill *f = r->fill;
    enum tri_outcome outcome = DONE;
    f->n_numbers = 0;
    for (int32_t i = 0; i < f->n_border; i++)
        *tri_link_at(r->mesh, f->border[i].inside) = CUT;
    for (int32_t i = 0; outcome == DONE && i < f->n_border; i++)
        outcome = note_inside(r, tri_of(f->border[i].inside), f->border[i].region) ? DONE : REFUSED;
    for (int32_t i = 0; outcome == DONE && i < f->n_numbers; i++)
        outcome = mark_neighbours(r, f->number[i]);
    if (outcome == DONE && f->n_numbers + 2 * f->n_new != f->n_cells) /* by Euler's formula, there are other vertices
                                                                         inside */
        outcome = REFUSED;
    if (outcome != DONE)
        revert_inside(r);
    return outcome;
}

/* --- cells */

/* Adds vertices at the sites that have none, and allocates two triangle numbers for each of them. There is room. */
static void place_vertices(struct tri_refiner *r)
{
    struct tri_fill *f = r->fill;
    struct tri_sites *s = &f->sites;
    for (int32_t row = 0; row < s->n_rows; row++)
        for (int32_t column = s->row[row].first; column <= s->row[row].last; column++) {
            const int32_t site = tri_site(s, row, column);
            if (s->at[site] != TRI_SITE_FREE)
                continue;
            const enum tri_status room = tri_make_room(r, 1);
            assert(room == TRI_OK);
            (void)room;
            s->at[site] = tri_add_vertex(r, tri_site_place(s, row, column), TRI_VERTEX_FREE, 0);
            r->mesh->feature[s->at[site]] = s->lattice.feature;
            for (int k = 0; k < 2; k++)
                f->number[f->n_numbers++] = r->mesh->n_triangles++;
        }
}

static void join(const struct tri_mesh *m, tri_halfedge a, tri_halfedge b)
{
    *tri_link_at(m, a) = b;
    *tri_link_at(m, b) = a;
}

/* Makes a cell and links it across the border and to the cells that already exist: across edge 1 the previous cell
 * in the row, and across edge 2 of a cell that stands on an edge the cell below, which `near` of the left site
 * holds. */
static enum tri_outcome make_cell(struct tri_refiner *r, const struct cell *c)
{
    struct tri_fill *f = r->fill;
    struct tri_sites *s = &f->sites;
    const tri_triangle_id before = f->n_cells > 0 ? f->number[f->n_cells - 1] : TRI_NONE;
    const tri_triangle_id own = f->number[f->n_cells];
    struct tri_triangle *t = &r->mesh->tri[own];
    const int32_t generation = f->n_cells++ < f->n_reused ? t->generation : 0; /* a new number has none yet */
    const bool at_border = s->at[c->across[1]] == TRI_SITE_OUT;
    assert(tri_owners_claim(r->hooks->owners, own) && (at_border || before != TRI_NONE));
    *t = (struct tri_triangle){{s->at[c->site[0]], s->at[c->site[1]], s->at[c->site[2]]}, {CUT, CUT, CUT},
                               at_border ? TRI_NONE : r->mesh->tri[before].region, generation + 1};
    for (int e = 0; e < 3; e++)
        if (s->at[c->across[e]] == TRI_SITE_OUT) {
            const struct border *border = &f->border[f->n_border++];
            join(r->mesh, tri_code(own, e), border->outside);
            t->region = border->region;
        }
    if (!at_border)
        join(r->mesh, tri_code(own, 1), tri_code(before, c->by_edge ? 2 : 0));
    if (c->by_edge && t->n[2] == CUT)
        join(r->mesh, tri_code(own, 2), tri_code(s->near[c->site[0]], 0));
    if (!c->by_edge)
        s->near[c->site[2]] = own;
    return DONE;
}

/* Replaces the triangles inside the border by the cells. */
static enum tri_outcome replace_by_cells(struct tri_refiner *r)
{
    struct tri_fill *f = r->fill;
    if (f->n_new == 0)
        return DONE;
    if (!tri_grow(&f->number, &f->number_capacity, f->n_cells, sizeof *f->number) || tri_make_room(r, f->n_new))
        return FAILED;
    const enum tri_outcome outcome = walk_inside(r);
    if (outcome != DONE)
        return outcome;
    f->n_reused = f->n_numbers;
    place_vertices(r);
    f->n_cells = f->n_border = 0;
    each_cell(r, NULL, make_cell);
    assert(f->n_cells == f->n_numbers);
    r->report->inserted_free += f->n_new;
    if (r->hooks->part)
        r->hooks->part->changed(r->hooks->part->user, f->number, f->n_numbers);
    return DONE;
}

/* --- one bound after another */

/* Returns twice the area bound of a triangle if it exceeds that bound; otherwise 0. Sets *area2 to twice its area if
 * the triangle exists and may be changed. */
static double broken_bound(const struct tri_refiner *r, tri_triangle_id t, double *area2)
{
    const struct tri_triangle *at = &r->mesh->tri[t];
    if (!tri_is_live(at) || !tri_fence_owns(r->hooks->fence, r->mesh, t))
        return 0;
    const double bound = tri_area2_bound(&r->criterion.asked, at->region);
    *area2 = tri_shape_of(r->mesh->xy, at->v).area2;
    return *area2 > bound ? bound : 0;
}

static int by_bound(const void *left, const void *right)
{
    const struct large *a = left, *b = right;
    if (a->area2 != b->area2)
        return a->area2 < b->area2 ? -1 : 1;
    return (a->place > b->place) - (a->place < b->place);
}

/* Lists a triangle if it is too large. Returns false if memory ran out. */
static bool list_large(struct tri_refiner *r, tri_triangle_id t, int32_t place)
{
    struct tri_fill *f = r->fill;
    double area2 = 0;
    const double bound = broken_bound(r, t, &area2);
    if (bound <= 0)
        return true;
    if (!tri_grow(&f->large, &f->large_capacity, f->n_large + 1, sizeof *f->large))
        return false;
    f->large[f->n_large++] = (struct large){bound, {t, r->mesh->tri[t].generation}, place};
    f->cells += area2 / bound;
    return true;
}

/* Lists the triangles of the worklist and of the queue that are too large. Returns false if memory ran out. */
static bool list_all_large(struct tri_refiner *r)
{
    struct tri_entry entry;
    int32_t place = 0;
    bool room = true;
    for (; room && place < r->n_worklist; place++)
        room = list_large(r, tri_worklist_triangle(r, place), place);
    while (room && tri_bad_queue_pop(&r->queue, r->mesh, &entry))
        room = entry.generation != r->mesh->tri[entry.t].generation || list_large(r, entry.t, place++);
    return room;
}

/* Puts the triangles that came from the queue back, if they are unchanged. Returns false if memory ran out. */
static bool requeue_large(struct tri_refiner *r)
{
    const struct tri_fill *f = r->fill;
    bool room = true;
    for (int32_t i = 0; room && i < f->n_large; i++) {
        const struct tri_entry entry = f->large[i].entry;
        if (f->large[i].place >= r->n_worklist)
            room = tri_bad_queue_push_size(&r->queue, entry, entry.generation == r->mesh->tri[entry.t].generation);
    }
    return room;
}

/* Starts a fill. If cells are not worthwhile, the fill has nothing to do. Returns false if memory ran out. */
static bool begin_fill(struct tri_refiner *r)
{
    assert(r->queue.n_angles == 0);
    r->fill = calloc(1, sizeof *r->fill);
    if (!r->fill || !list_all_large(r))
        return false;
    if (r->fill->cells >= TRI_LATTICE_LEAST)
        qsort(r->fill->large, (size_t)r->fill->n_large, sizeof *r->fill->large, by_bound);
    else
        r->fill->done = r->fill->n_large;
    return true;
}

/* Lists the sites at the rim of the cells, to be looked at. If there are too many of them, cells are not worthwhile
 * and all sites are dropped. Returns false if memory ran out. */
static bool check_all(struct tri_fill *f)
{
    struct tri_sites *s = &f->sites;
    int32_t n_in = 0;
    for (struct place at = {TRI_SITE_MARGIN, 0}; s->n > 0 && at.row < s->n_rows - TRI_SITE_MARGIN; at.row++) {
        const struct around to = around_row(s, at.row);
        for (at.column = s->row[at.row].first; at.column <= s->row[at.row].last; at.column++) {
            const int32_t site = site_at(f, at);
            n_in += s->at[site] != TRI_SITE_OUT;
            if (s->at[site] != TRI_SITE_OUT && neighbours_in(s, to, site) != ALL_IN && !check(f, at))
                return false;
        }
    }
    if (f->n_check > TRI_LATTICE_RIM * n_in)
        s->n = f->n_check = 0;
    return true;
}

/* Finds the sites for the next bound, and lists the rim. Returns false if memory ran out. */
static bool find_sites(struct tri_refiner *r)
{
    struct tri_fill *f = r->fill;
    const struct tri_lattice lattice = tri_lattice_for(f->large[f->done].area2);
    double area2 = 0, cells = 0;
    f->n_numbers = 0;
    for (int32_t i = f->done; i < f->n_large && f->large[i].area2 == f->large[f->done].area2; i++)
        if (broken_bound(r, f->large[i].entry.t, &area2) == f->large[i].area2) { /* the number may belong to another
                                                                                    triangle by now */
            if (!tri_grow(&f->number, &f->number_capacity, f->n_numbers + 1, sizeof *f->number))
                return false;
            f->number[f->n_numbers++] = f->large[i].entry.t;
            cells += area2 / f->large[i].area2;
        }
    const double most = cells < TRI_LATTICE_LEAST ? 0 : tri_lesser(TRI_LATTICE_SPARSE * cells, INT32_MAX / 4);
    if (!tri_sites_find(&f->sites, r->mesh, &lattice, f->number, f->n_numbers, (int32_t)most))
        return false;
    f->has_sites = true;
    return check_all(f);
}

static void finish_bound(struct tri_fill *f)
{
    const double area2 = f->large[f->done].area2;
    while (f->done < f->n_large && f->large[f->done].area2 == area2)
        f->done++;
    tri_sites_free(&f->sites);
    f->has_sites = false;
    f->n_check = 0;
}

bool tri_may_fill_lattice(const struct tri_refiner *r)
{
    return r->lattice && !r->hooks->urgent && !r->hooks->gate && r->quality->max_steiner < 0 &&
           tri_area_scale(r->quality) <= 1;
}

bool tri_fill_lattice(struct tri_refiner *r)
{
    if (!tri_may_fill_lattice(r))
        return true;
    if (!r->fill && !begin_fill(r))
        return false;
    while (r->fill->done < r->fill->n_large) {
        if (!r->fill->has_sites && !find_sites(r))
            return false;
        if (r->fill->sites.n > 0 && (settle_rim(r) == FAILED || replace_by_cells(r) == FAILED))
            return false;
        finish_bound(r->fill);
    }
    const bool room = requeue_large(r);
    tri_fill_free(r);
    return room;
}

void tri_fill_free(struct tri_refiner *r)
{
    struct tri_fill *f = r->fill;
    if (!f)
        return;
    tri_sites_free(&f->sites);
    free(f->large);
    free(f->check);
    free(f->border);
    free(f->number);
    free(f);
    r->fill = NULL;
}
