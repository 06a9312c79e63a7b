/* Which points of a lattice are free, in some of the triangles of a mesh: inside them, and far enough from their
 * vertices and subsegments. */
#ifndef TRIANGLE_REFINE_SITES_H
#define TRIANGLE_REFINE_SITES_H

#include "triangle/refine/lattice.h"

enum { TRI_SITE_OUT = -1, TRI_SITE_FREE = -2 };

/* A row of sites. */
struct tri_site_row {
    int32_t first, last; /* columns; none if first is above last */
    int32_t base;        /* index of the site in column 0, if there were one */
};

/* A part of a lattice, row by row. Rows and columns are counted from a row below and a column on the left of all. Where
 * a site is not out, those within TRI_SITE_MARGIN rows and columns are sites, too. */
enum { TRI_SITE_MARGIN = 2 };

struct tri_sites {
    struct tri_lattice lattice;
    double bottom, left;      /* row and column of the lattice for row 0 and column 0; bottom is even */
    int32_t n_rows;
    int32_t n;                /* sites; 0: none */
    struct tri_site_row *row; /* [n_rows] */
    int32_t *at;              /* [n] a vertex that is there; or TRI_SITE_FREE, TRI_SITE_OUT */
    tri_triangle_id *near;    /* [n] a triangle: one at the vertex, or near to the site */
};

/* Finds the sites in n triangles of one bound on areas. most: if there are more sites than this, or more rows of all
 * triangles, none are found. False: no memory. O(n + rows of all triangles + sites). */
bool tri_sites_find(struct tri_sites *sites, const struct tri_mesh *mesh, const struct tri_lattice *lattice,
                    const tri_triangle_id *triangle, int32_t n, int32_t most);
void tri_sites_free(struct tri_sites *sites);

/* The index of a site. */
static inline int32_t tri_site(const struct tri_sites *sites, int32_t row, int32_t column)
{
    assert(row >= 0 && row < sites->n_rows && column >= sites->row[row].first && column <= sites->row[row].last);
    return sites->row[row].base + column;
}

static inline struct tri_point tri_site_place(const struct tri_sites *sites, int32_t row, int32_t column)
{
    return tri_lattice_at(&sites->lattice, sites->bottom + row, sites->left + column);
}

/* The site that is exactly at p; TRI_NONE: none is. */
int32_t tri_site_of(const struct tri_sites *sites, struct tri_point p);

#endif
