/* Cells of the lattice, its triangles, are made many at once, where many lie side by side away from all features.
 *
 * The sites that are free (sites.h) are found first. A cell stands where all its three sites are free or have a vertex.
 * The rim are the sites that some cells have and that not only cells are around. They are inserted one by one, as any
 * point, until the border of the cells is a chain of edges of the mesh; what is inside is taken out, and replaced by
 * cells, which are all good. All other triangles are the refinement loop's.
 *
 * THEOREM (docs/theory.md, the lattice). The result is the constrained Delaunay triangulation of its vertices. Inside
 * the border are sites alone; and across it no vertex lies in the circle of a cell, which is_delaunay tests.
 *
 * INVARIANT. The mesh is in order after each point of the rim. All that may fail comes before the first cell. */
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
    struct tri_entry entry;
    int32_t place;          /* in the worklist, and behind that in the queue */
};

struct place {
    int32_t row, column;
};

/* An edge of the border, as the triangles on both sides see it. */
struct border {
    tri_halfedge inside;
    tri_halfedge outside;
    tri_region_id region; /* inside */
};

struct tri_fill {
    struct large *large;   /* [n_large] by bound, then by place */
    int32_t n_large, large_capacity;
    int32_t done;          /* the sites at work are those of the bound of large[done] */
    double cells;          /* that all these triangles ask for */
    struct tri_sites sites;
    bool has_sites;        /* they have been found */
    struct place *check;   /* [n_check] sites to look at: what is around them has changed */
    int32_t n_check, check_capacity;
    struct border *border; /* [n_border] in the order of cells */
    int32_t n_border, border_capacity;
    int32_t n_new, n_cells;  /* sites without a vertex; cells */
    tri_triangle_id *number; /* [n_numbers] of triangles, for cells: first those that are taken out */
    int32_t n_numbers, number_capacity;
};

/* The link of a triangle inside across the border, while the inside is walked through: no subsegment has this id. */
static const tri_link CUT = TRI_BEYOND + 1;

/* --- sites and cells */

/* The neighbours of a site, counter-clockwise from the one on the right. Above and below they are one column farther
 * where the row is odd. */
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

/* Bit k: the neighbour k is in. */
static unsigned neighbours_in(const struct tri_fill *f, struct place at)
{
    unsigned in = 0;
    for (int k = 0; k < AROUND; k++)
        in |= is_in(f, next_to(at, k)) ? 1u << k : 0;
    return in;
}

enum { ALL_IN = (1 << AROUND) - 1 };

/* Is one of the cells around a site there? */
static bool has_cell(unsigned in) { return in & (in >> 1 | in << (AROUND - 1)); }

/* A cell: its sites counter-clockwise, and the third ones of the cells across its edges; edge k is opposite site k. */
struct cell {
    struct place at[3];
    int32_t site[3], across[3];
};

/* Finds the cell that stands on a site by its edge to the right, or else by its lowest corner. False: it is not
 * there. */
static bool find_cell(const struct tri_fill *f, struct place at, bool by_edge, struct cell *c)
{
    const struct place right = next_to(at, RIGHT), up_right = next_to(at, UP_RIGHT), up_left = next_to(at, UP_LEFT);
    if (!is_in(f, up_right) || !is_in(f, by_edge ? right : up_left))
        return false;
    *c = by_edge ? (struct cell){{at, right, up_right}, {0}, {0}} : (struct cell){{at, up_right, up_left}, {0}, {0}};
    for (int k = 0; k < 3; k++) {
        const int across = ((by_edge ? UP_RIGHT : UP_LEFT) + 2 * k) % AROUND;
        c->site[k] = site_at(f, c->at[k]);
        c->across[k] = site_at(f, next_to(c->at[tri_next[k]], across));
    }
    return true;
}

/* Calls `visit` for each cell, row by row, from left to right, as long as it says DONE. */
static enum tri_outcome each_cell(struct tri_refiner *r,
                                  enum tri_outcome (*visit)(struct tri_refiner *r, const struct cell *c, bool by_edge))
{
    const struct tri_fill *f = r->fill;
    struct cell c;
    for (struct place at = {0, 0}; at.row < f->sites.n_rows; at.row++)
        for (at.column = f->sites.row[at.row].first; at.column <= f->sites.row[at.row].last; at.column++)
            for (int by_edge = 0; by_edge < 2 && is_in(f, at); by_edge++)
                if (find_cell(f, at, by_edge, &c)) {
                    const enum tri_outcome outcome = visit(r, &c, by_edge);
                    if (outcome != DONE)
                        return outcome;
                }
    return DONE;
}

/* --- the rim, point by point */

static bool check(struct tri_fill *f, struct place at)
{
    if (!tri_grow(&f->check, &f->check_capacity, f->n_check + 1, sizeof *f->check))
        return false;
    f->check[f->n_check++] = at;
    return true;
}

/* What is around a site has changed. FAILED: no memory. */
static enum tri_outcome check_around(struct tri_fill *f, struct place at)
{
    for (int k = 0; k < AROUND; k++)
        if (is_in(f, next_to(at, k)) && !check(f, next_to(at, k)))
            return FAILED;
    return DONE;
}

static enum tri_outcome leave_out(struct tri_fill *f, struct place at)
{
    f->sites.at[site_at(f, at)] = TRI_SITE_OUT;
    return check_around(f, at);
}

/* Sites whose vertex is a corner of the last fan learn a triangle that they have now. */
static void note_fan(const struct tri_refiner *r)
{
    const struct tri_sites *s = &r->fill->sites;
    for (int32_t i = 0; i < r->cavity.n_edges; i++)
        for (int k = 1; k < 3; k++) { /* corner 0 is new */
            const tri_vertex_id v = r->mesh->tri[r->cavity.tri[i]].v[k];
            const int32_t site = tri_site_of(s, r->mesh->xy[v]);
            if (site != TRI_NONE && s->at[site] == v)
                s->near[site] = r->cavity.tri[i];
        }
}

/* Walks to the triangle that holds p, *t. REFUSED: a subsegment or the fence is in the way. */
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
            return tri_wait_for(r, (tri_vertex_id[]){at->v[tri_next[e]], at->v[tri_prev[e]]});
        if (at->n[e] < 0 || !tri_fence_owns(r->hooks->fence, m, tri_of(at->n[e])))
            return REFUSED;
        *t = tri_of(at->n[e]);
    }
    return REFUSED;
}

/* Inserts the point of a site of the rim. */
static enum tri_outcome insert(struct tri_refiner *r, struct place at)
{
    struct tri_sites *s = &r->fill->sites;
    const int32_t site = site_at(r->fill, at);
    const struct tri_point p = tri_site_place(s, at.row, at.column);
    for (;;) {
        tri_triangle_id t = s->near[site]; /* found anew after a split: the same whether or not there was a pause */
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

/* Looks at a site. One with cells all around waits for them; one with some cells is of the rim, and is inserted; one
 * without cells is left out. */
static enum tri_outcome look_at(struct tri_refiner *r, struct place at)
{
    struct tri_fill *f = r->fill;
    if (!is_in(f, at))
        return DONE;
    const unsigned in = neighbours_in(f, at);
    if (in == ALL_IN)
        return DONE;
    if (!has_cell(in))
        return leave_out(f, at);
    if (f->sites.at[site_at(f, at)] != TRI_SITE_FREE)
        return DONE;
    const enum tri_outcome outcome = insert(r, at);
    if (outcome == FAILED)
        return FAILED;
    return outcome == DONE ? check_around(f, at) : leave_out(f, at);
}

/* FAILED: the site that could not be looked at is still to be checked. */
static enum tri_outcome look_at_all(struct tri_refiner *r)
{
    struct tri_fill *f = r->fill;
    while (f->n_check > 0) {
        if (tri_refiner_must_stop(r))
            return FAILED;
        const struct place at = f->check[--f->n_check];
        if (look_at(r, at) == FAILED) {
            check(f, at); /* there is room: it has just been there, or there is no memory at all */
            return FAILED;
        }
    }
    return DONE;
}

/* --- the border */

/* Finds edge ab as the triangle on its left sees it; TRI_NONE in *edge: it is no edge of the mesh, or a subsegment. t:
 * a triangle at a. */
static enum tri_outcome find_edge(struct tri_refiner *r, tri_triangle_id t, tri_vertex_id a, tri_vertex_id b,
                                  tri_halfedge *edge)
{
    const struct tri_triangle *tri = r->mesh->tri;
    *edge = TRI_NONE;
    for (int turn = 0; turn < 2; turn++) { /* about a, counter-clockwise; where something is in the way, clockwise */
        const int *side = turn == 0 ? tri_next : tri_prev;
        for (tri_triangle_id at = t;;) {
            const int k = tri_corner_of(&tri[at], a);
            if (tri[at].v[tri_next[k]] == b) {
                *edge = tri_code(at, tri_prev[k]);
                return DONE;
            }
            const tri_link link = tri[at].n[side[k]];
            if (link == TRI_BEYOND)
                return tri_wait_for(r, (tri_vertex_id[]){a, tri[at].v[turn == 0 ? tri_prev[k] : tri_next[k]]});
            if (link < 0)
                break;
            at = tri_of(link);
            if (at == t)
                return DONE;
        }
    }
    return DONE;
}

/* Is the corner across the border out of the circle of the cell? */
static bool is_delaunay(const struct tri_refiner *r, const struct cell *c, tri_halfedge outside)
{
    const struct tri_sites *s = &r->fill->sites;
    struct tri_point p[3];
    for (int k = 0; k < 3; k++)
        p[k] = tri_site_place(s, c->at[k].row, c->at[k].column);
    return tri_incircle(p[0], p[1], p[2], r->mesh->xy[tri_apex(r->mesh, outside)]) <= 0;
}

/* Lists the edges of a cell that are of the border. Where one is not to be had, its sites are left out. */
static enum tri_outcome list_border(struct tri_refiner *r, const struct cell *c, bool by_edge)
{
    struct tri_fill *f = r->fill;
    const struct tri_sites *s = &f->sites;
    const tri_vertex_id v[3] = {s->at[c->site[0]], s->at[c->site[1]], s->at[c->site[2]]};
    (void)by_edge; /* as make_cell has it */
    f->n_cells++;
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
            return tri_wait_for(r, (tri_vertex_id[]){v[a], v[b]});
        if (border.outside < 0 || !is_delaunay(r, c, border.outside)) {
            if (leave_out(f, c->at[a]) == FAILED || leave_out(f, c->at[b]) == FAILED)
                return FAILED;
            continue;
        }
        if (!tri_grow(&f->border, &f->border_capacity, f->n_border + 1, sizeof *f->border))
            return FAILED;
        f->border[f->n_border++] = border;
    }
    return DONE;
}

/* Inserts the rim, and lists the border of the cells and the sites that have no vertex. */
static enum tri_outcome settle(struct tri_refiner *r)
{
    struct tri_fill *f = r->fill;
    do {
        f->n_border = f->n_cells = f->n_new = 0;
        if (look_at_all(r) == FAILED || each_cell(r, list_border) == FAILED)
            return FAILED;
    } while (f->n_check > 0);
    for (int32_t i = 0; i < f->sites.n; i++)
        f->n_new += f->sites.at[i] == TRI_SITE_FREE;
    return DONE;
}

/* --- the inside is taken out */

/* Puts back what walk_inside has changed. */
static void put_back(const struct tri_refiner *r)
{
    const struct tri_fill *f = r->fill;
    for (int32_t i = 0; i < f->n_numbers; i++)
        r->mesh->tri[f->number[i]].region = ~r->mesh->tri[f->number[i]].region;
    for (int32_t i = 0; i < f->n_border; i++)
        *tri_link_at(r->mesh, f->border[i].inside) = f->border[i].outside;
}

/* Notes the number of a triangle inside, and marks the triangle; false: there are too many, or regions meet. */
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

/* Notes what is beyond the edges of a triangle inside. */
static enum tri_outcome walk_on(struct tri_refiner *r, tri_triangle_id inside)
{
    const struct tri_triangle *t = &r->mesh->tri[inside];
    for (int e = 0; e < 3; e++) {
        if (t->n[e] == TRI_BEYOND)
            return tri_wait_for(r, (tri_vertex_id[]){t->v[tri_next[e]], t->v[tri_prev[e]]});
        if (t->n[e] != CUT && (t->n[e] < 0 || !note_inside(r, tri_of(t->n[e]), ~t->region)))
            return REFUSED;
    }
    return DONE;
}

/* Lists the triangles inside the border, which are marked by their regions, and cuts them off. REFUSED: inside is
 * something else than sites, and nothing has changed. */
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
        outcome = walk_on(r, f->number[i]);
    if (outcome == DONE && f->n_numbers + 2 * f->n_new != f->n_cells) /* Euler: there are other vertices inside */
        outcome = REFUSED;
    if (outcome != DONE)
        put_back(r);
    return outcome;
}

/* --- cells */

/* Vertices for the sites that have none, and numbers for all cells: each point makes two triangles. There is room. */
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
            for (int k = 0; k < 2; k++) {
                r->mesh->tri[r->mesh->n_triangles].life = 0;
                f->number[f->n_numbers++] = r->mesh->n_triangles++;
            }
        }
}

static void join(const struct tri_mesh *m, tri_halfedge a, tri_halfedge b)
{
    *tri_link_at(m, a) = b;
    *tri_link_at(m, b) = a;
}

/* Makes a cell, with links to what is across the border and to cells that have been made: one before it in the row at
 * edge 1; one below at edge 2 if it stands on an edge, which is found by the site on the left. */
static enum tri_outcome make_cell(struct tri_refiner *r, const struct cell *c, bool by_edge)
{
    struct tri_fill *f = r->fill;
    struct tri_sites *s = &f->sites;
    const tri_triangle_id before = f->n_cells > 0 ? f->number[f->n_cells - 1] : TRI_NONE;
    const tri_triangle_id own = f->number[f->n_cells++];
    struct tri_triangle *t = &r->mesh->tri[own];
    const bool at_border = s->at[c->across[1]] == TRI_SITE_OUT;
    assert(tri_owners_claim(r->hooks->owners, own) && (at_border || before != TRI_NONE));
    *t = (struct tri_triangle){{s->at[c->site[0]], s->at[c->site[1]], s->at[c->site[2]]}, {CUT, CUT, CUT},
                               at_border ? TRI_NONE : r->mesh->tri[before].region, t->life + 1};
    for (int e = 0; e < 3; e++)
        if (s->at[c->across[e]] == TRI_SITE_OUT) {
            const struct border *border = &f->border[f->n_border++];
            join(r->mesh, tri_code(own, e), border->outside);
            t->region = border->region;
        }
    if (!at_border)
        join(r->mesh, tri_code(own, 1), tri_code(before, by_edge ? 2 : 0));
    if (by_edge && t->n[2] == CUT)
        join(r->mesh, tri_code(own, 2), tri_code(s->near[c->site[0]], 0));
    if (!by_edge)
        s->near[c->site[2]] = own;
    return DONE;
}

/* Puts the cells in the place of what is inside their border. */
static enum tri_outcome put_cells(struct tri_refiner *r)
{
    struct tri_fill *f = r->fill;
    if (f->n_new == 0)
        return DONE;
    if (!tri_grow(&f->number, &f->number_capacity, f->n_cells, sizeof *f->number) || tri_make_room(r, f->n_new))
        return FAILED;
    const enum tri_outcome outcome = walk_inside(r);
    if (outcome != DONE)
        return outcome;
    place_vertices(r);
    f->n_cells = f->n_border = 0;
    each_cell(r, make_cell);
    assert(f->n_cells == f->n_numbers);
    r->report->inserted_free += f->n_new;
    if (r->hooks->part)
        r->hooks->part->changed(r->hooks->part->user, f->number, f->n_numbers);
    return DONE;
}

/* --- bounds, one after the other */

/* Twice the bound on the area of a triangle if it breaks that, which sets *area2; else 0. */
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

/* Lists a triangle if it is too large. False: no memory. */
static bool list_large(struct tri_refiner *r, tri_triangle_id t, int32_t place)
{
    struct tri_fill *f = r->fill;
    double area2 = 0;
    const double bound = broken_bound(r, t, &area2);
    if (bound <= 0)
        return true;
    if (!tri_grow(&f->large, &f->large_capacity, f->n_large + 1, sizeof *f->large))
        return false;
    f->large[f->n_large++] = (struct large){bound, {t, r->mesh->tri[t].life}, place};
    f->cells += area2 / bound;
    return true;
}

/* Lists the triangles of the worklist and of the queue that are too large. False: no memory. */
static bool list_all_large(struct tri_refiner *r)
{
    struct tri_entry entry;
    int32_t place = 0;
    bool room = true;
    for (; room && place < r->n_worklist; place++)
        room = list_large(r, tri_listed(r, place), place);
    while (room && tri_bad_queue_pop(&r->queue, r->mesh, &entry))
        room = entry.life != r->mesh->tri[entry.t].life || list_large(r, entry.t, place++);
    return room;
}

/* Puts back into the queue what has been taken from it, and is too large still. False: no memory. */
static bool queue_again(struct tri_refiner *r)
{
    const struct tri_fill *f = r->fill;
    bool room = true;
    for (int32_t i = 0; room && i < f->n_large; i++) {
        const struct tri_entry entry = f->large[i].entry;
        if (f->large[i].place >= r->n_worklist)
            room = tri_bad_queue_push_size(&r->queue, entry, entry.life == r->mesh->tri[entry.t].life);
    }
    return room;
}

/* Where cells are not worth it, there are none to be made. False: no memory. */
static bool begin(struct tri_refiner *r)
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

/* Checks the sites that are not inside cells. Where these are many, cells are not worth it. False: no memory. */
static bool check_all(struct tri_fill *f)
{
    struct tri_sites *s = &f->sites;
    int32_t n_in = 0;
    for (struct place at = {0, 0}; s->n > 0 && at.row < s->n_rows; at.row++)
        for (at.column = s->row[at.row].first; at.column <= s->row[at.row].last; at.column++) {
            n_in += is_in(f, at);
            if (is_in(f, at) && neighbours_in(f, at) != ALL_IN && !check(f, at))
                return false;
        }
    if (f->n_check > TRI_LATTICE_RIM * n_in)
        s->n = f->n_check = 0;
    return true;
}

/* Finds the sites of the next bound, and those that are not inside cells. False: no memory. */
static bool find_sites(struct tri_refiner *r)
{
    struct tri_fill *f = r->fill;
    const struct tri_lattice lattice = tri_lattice_for(f->large[f->done].area2);
    double area2 = 0, cells = 0;
    f->n_numbers = 0;
    for (int32_t i = f->done; i < f->n_large && f->large[i].area2 == f->large[f->done].area2; i++)
        if (broken_bound(r, f->large[i].entry.t, &area2) == f->large[i].area2) { /* it may have become another one */
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

static void end_bound(struct tri_fill *f)
{
    const double area2 = f->large[f->done].area2;
    while (f->done < f->n_large && f->large[f->done].area2 == area2)
        f->done++;
    tri_sites_free(&f->sites);
    f->has_sites = false;
    f->n_check = 0;
}

bool tri_wants_cells(const struct tri_refiner *r)
{
    return r->lattice && !r->hooks->urgent && !r->hooks->gate && r->quality->max_steiner < 0 &&
           tri_area_scale(r->quality) <= 1;
}

bool tri_fill_lattice(struct tri_refiner *r)
{
    if (!tri_wants_cells(r))
        return true;
    if (!r->fill && !begin(r))
        return false;
    while (r->fill->done < r->fill->n_large) {
        if (!r->fill->has_sites && !find_sites(r))
            return false;
        if (r->fill->sites.n > 0 && (settle(r) == FAILED || put_cells(r) == FAILED))
            return false;
        end_bound(r->fill);
    }
    const bool room = queue_again(r);
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
