/* Rasterises the triangles row by row, then removes the sites that are too close to vertices and subsegments. */
#include "triangle/refine/sites.h"

#include <stdlib.h>

#include "triangle/tunables.h"

/* Tolerance in edge lengths: points this close to a triangle's border count as inside, so rounding loses no site
 * between two triangles. A site outside the mesh that passes is removed later, since it is too close to the
 * boundary. */
static const double SLACK = 1e-6;

/* The columns (or rows) from first to last, as whole numbers. */
struct span {
    double first, last; /* none if first > last */
};

/* Returns the columns of a row whose points have x coordinates between `from` and `to`. */
static struct span columns_between(const struct tri_lattice *lattice, double row, double from, double to)
{
    const double shift = tri_lattice_shift(row);
    return (struct span){ceil(from / lattice->edge - shift - SLACK), floor(to / lattice->edge - shift + SLACK)};
}

static double lowest(const struct tri_point p[3]) { return tri_lesser(p[0].y, tri_lesser(p[1].y, p[2].y)); }

static double highest(const struct tri_point p[3]) { return tri_larger(p[0].y, tri_larger(p[1].y, p[2].y)); }

/* Returns the columns of a row inside a triangle. The row must intersect the triangle, within SLACK. */
static struct span columns_in(const struct tri_lattice *lattice, const struct tri_point p[3], double row)
{
    const double y = tri_lesser(tri_larger(row * lattice->rise, lowest(p)), highest(p));
    double from = HUGE_VAL, to = -HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        const struct tri_point a = p[k], b = p[tri_next[k]];
        if (tri_lesser(a.y, b.y) > y || tri_larger(a.y, b.y) < y || a.y == b.y)
            continue;
        const double x = a.x + (y - a.y) * (b.x - a.x) / (b.y - a.y);
        from = tri_lesser(from, x);
        to = tri_larger(to, x);
    }
    return from <= to ? columns_between(lattice, row, from, to) : (struct span){1, 0};
}

static struct span rows_between(const struct tri_lattice *lattice, double from, double to)
{
    return (struct span){ceil(from / lattice->rise - SLACK), floor(to / lattice->rise + SLACK)};
}

static struct span rows_in(const struct tri_lattice *lattice, const struct tri_point p[3])
{
    return rows_between(lattice, lowest(p), highest(p));
}

static void corners_of(const struct tri_mesh *mesh, tri_triangle_id t, struct tri_point p[3])
{
    for (int k = 0; k < 3; k++)
        p[k] = mesh->xy[mesh->tri[t].v[k]];
}

/* Computes the range of rows and the leftmost column. *painted: receives the number of rows, summed over all triangles.
 * Returns false if there are more than `most` rows, if the triangles together cover more rows than that, or if
 * coordinates are too coarse for the lattice. */
static bool find_frame(struct tri_sites *s, const struct tri_mesh *mesh, const tri_triangle_id *triangle, int32_t n,
                       int32_t most, double *painted)
{
    struct span rows = {HUGE_VAL, -HUGE_VAL}, columns = rows;
    *painted = 0;
    for (int32_t i = 0; i < n; i++) {
        struct tri_point p[3];
        corners_of(mesh, triangle[i], p);
        const struct span own = rows_in(&s->lattice, p);
        rows.first = tri_lesser(rows.first, own.first);
        rows.last = tri_larger(rows.last, own.last);
        *painted += tri_larger(own.last - own.first + 1, 0);
        for (int k = 0; k < 3; k++) {
            columns.first = tri_lesser(columns.first, floor(p[k].x / s->lattice.edge) - 1);
            columns.last = tri_larger(columns.last, floor(p[k].x / s->lattice.edge) + 1);
        }
    }
    s->bottom = 2 * floor(0.5 * rows.first) - TRI_SITE_MARGIN;
    s->left = columns.first - TRI_SITE_MARGIN;
    const double farthest = tri_larger(tri_larger(fabs(rows.first), fabs(rows.last)),
                                       tri_larger(fabs(columns.first), fabs(columns.last)));
    if (!(farthest < TRI_LATTICE_FARTHEST) || !(rows.last - s->bottom < most) || !(*painted <= most) ||
        !(columns.last - columns.first < INT32_MAX / 2))
        return false;
    s->n_rows = rows.first <= rows.last ? (int32_t)(rows.last - s->bottom) + 1 + TRI_SITE_MARGIN : 0;
    return true;
}

/* A row of a triangle: the columns inside it. */
struct stripe {
    int32_t row, first, last; /* the row; its first and last column */
    tri_triangle_id t;        /* the triangle */
};

/* Lists the stripes of all triangles. Returns their number. stripe: has room for all. */
static int32_t list_stripes(const struct tri_sites *s, const struct tri_mesh *mesh, const tri_triangle_id *triangle,
                            int32_t n, struct stripe *stripe)
{
    int32_t count = 0;
    for (int32_t i = 0; i < n; i++) {
        struct tri_point p[3];
        corners_of(mesh, triangle[i], p);
        const struct span rows = rows_in(&s->lattice, p);
        for (double row = rows.first; row <= rows.last; row++) {
            const struct span columns = columns_in(&s->lattice, p, row);
            if (columns.first <= columns.last)
                stripe[count++] = (struct stripe){(int32_t)(row - s->bottom), (int32_t)(columns.first - s->left),
                                                  (int32_t)(columns.last - s->left), triangle[i]};
        }
    }
    return count;
}

static void widen_rows(struct tri_sites *s, struct stripe stripe)
{
    for (int32_t k = stripe.row - TRI_SITE_MARGIN; k <= stripe.row + TRI_SITE_MARGIN; k++) {
        struct tri_site_row *row = &s->row[k];
        row->first = row->first < stripe.first - TRI_SITE_MARGIN ? row->first : stripe.first - TRI_SITE_MARGIN;
        row->last = row->last > stripe.last + TRI_SITE_MARGIN ? row->last : stripe.last + TRI_SITE_MARGIN;
    }
}

static void paint(struct tri_sites *s, struct stripe stripe)
{
    const int32_t base = s->row[stripe.row].base;
    for (int32_t c = stripe.first; c <= stripe.last; c++) {
        s->at[base + c] = TRI_SITE_FREE;
        s->near[base + c] = stripe.t;
    }
}

/* Computes the index at which each row starts. s->n stays 0 if there are more than `most` sites. */
static void index_rows(struct tri_sites *s, int32_t most)
{
    int64_t n = 0;
    for (int32_t row = 0; row < s->n_rows && n <= most; row++) {
        struct tri_site_row *r = &s->row[row];
        r->base = (int32_t)n - r->first;
        n += r->first <= r->last ? (int64_t)r->last - r->first + 1 : 0;
    }
    s->n = n <= most ? (int32_t)n : 0;
}

/* Returns the index of the site in a row and column, or TRI_NONE. */
static int32_t find_site(const struct tri_sites *s, double row, double column)
{
    if (!(row >= 0 && row < s->n_rows))
        return TRI_NONE;
    const struct tri_site_row *r = &s->row[(int32_t)row];
    return column >= r->first && column <= r->last ? r->base + (int32_t)column : TRI_NONE;
}

struct segment {
    struct tri_point a, b; /* ends, may be equal */
};

/* Returns columns of a row that contain all sites closer than `distance` to a segment. */
static struct span columns_near(const struct tri_lattice *lattice, const struct segment *s, double row, double distance)
{
    const double x = s->b.x - s->a.x, y = s->b.y - s->a.y, height = row * lattice->rise - s->a.y;
    double from = 0, to = 1; /* range of the segment that is close enough to the row, as fractions of its length */
    if (y != 0) {
        from = tri_larger(0, tri_lesser((height - distance) / y, (height + distance) / y));
        to = tri_lesser(1, tri_larger((height - distance) / y, (height + distance) / y));
    }
    const double left = tri_lesser(s->a.x + x * from, s->a.x + x * to);
    const double right = tri_larger(s->a.x + x * from, s->a.x + x * to);
    return columns_between(lattice, row, left - distance, right + distance);
}

/* Removes the sites closer than `distance` to a segment. */
static void remove_sites_near(struct tri_sites *s, struct segment segment, double distance)
{
    const struct tri_lattice *lattice = &s->lattice;
    const struct span rows = rows_between(lattice, tri_lesser(segment.a.y, segment.b.y) - distance,
                                          tri_larger(segment.a.y, segment.b.y) + distance);
    for (double row = rows.first; row <= rows.last; row++) {
        const struct span columns = columns_near(lattice, &segment, row, distance);
        for (double column = columns.first; column <= columns.last; column++) {
            const int32_t site = find_site(s, row - s->bottom, column - s->left);
            const struct tri_point at = tri_lattice_at(lattice, row, column);
            if (site != TRI_NONE && tri_segment_distance2(segment.a, segment.b, at) < distance * distance)
                s->at[site] = TRI_SITE_OUT;
        }
    }
}

int32_t tri_site_of(const struct tri_sites *s, struct tri_point p)
{
    double row, column;
    tri_lattice_near(&s->lattice, p, &row, &column);
    const struct tri_point at = tri_lattice_at(&s->lattice, row, column);
    return at.x == p.x && at.y == p.y ? find_site(s, row - s->bottom, column - s->left) : TRI_NONE;
}

/* If the vertex is exactly on a site, records it there. Otherwise removes the sites close to the vertex. */
static void note_vertex(struct tri_sites *s, const struct tri_mesh *mesh, tri_vertex_id v, tri_triangle_id t)
{
    const struct tri_point p = mesh->xy[v];
    const int32_t site = tri_site_of(s, p);
    if (site == TRI_NONE) {
        remove_sites_near(s, (struct segment){p, p}, TRI_LATTICE_APART * s->lattice.edge);
    } else if (s->at[site] != TRI_SITE_OUT) {
        s->at[site] = v;
        s->near[site] = t;
    }
}

static void note_features(struct tri_sites *s, const struct tri_mesh *mesh, tri_triangle_id triangle)
{
    const struct tri_triangle *t = &mesh->tri[triangle];
    for (int k = 0; k < 3; k++) {
        note_vertex(s, mesh, t->v[k], triangle);
        if (t->n[k] < 0 && t->n[k] != TRI_BEYOND)
            remove_sites_near(s, (struct segment){mesh->xy[t->v[tri_next[k]]], mesh->xy[t->v[tri_prev[k]]]},
                     TRI_LATTICE_OFF_WALLS * s->lattice.edge);
    }
}

/* Finds the sites inside the stripes. Returns false if memory ran out. */
static bool paint_all(struct tri_sites *s, const struct stripe *stripe, int32_t n, int32_t most)
{
    s->row = malloc(((size_t)s->n_rows + 1) * sizeof *s->row);
    if (!s->row)
        return false;
    for (int32_t row = 0; row < s->n_rows; row++)
        s->row[row] = (struct tri_site_row){INT32_MAX / 2, -1, 0};
    for (int32_t i = 0; i < n; i++)
        widen_rows(s, stripe[i]);
    index_rows(s, most);
    s->at = malloc(((size_t)s->n + 1) * sizeof *s->at);
    s->near = malloc(((size_t)s->n + 1) * sizeof *s->near);
    if (!s->at || !s->near)
        return false;
    for (int32_t i = 0; i < s->n; i++)
        s->at[i] = TRI_SITE_OUT;
    for (int32_t i = 0; s->n > 0 && i < n; i++)
        paint(s, stripe[i]);
    return true;
}

bool tri_sites_find(struct tri_sites *s, const struct tri_mesh *mesh, const struct tri_lattice *lattice,
                    const tri_triangle_id *triangle, int32_t n, int32_t most)
{
    double painted;
    *s = (struct tri_sites){.lattice = *lattice};
    if (!find_frame(s, mesh, triangle, n, most, &painted))
        return true;
    struct stripe *stripe = malloc(((size_t)painted + 1) * sizeof *stripe);
    const bool memory = stripe && paint_all(s, stripe, list_stripes(s, mesh, triangle, n, stripe), most);
    free(stripe);
    for (int32_t i = 0; memory && s->n > 0 && i < n; i++)
        note_features(s, mesh, triangle[i]);
    return memory;
}

void tri_sites_free(struct tri_sites *s)
{
    free(s->row);
    free(s->at);
    free(s->near);
    *s = (struct tri_sites){0};
}
