/* Finds the free sites: lattice points inside some triangles of a mesh, far enough from vertices and subsegments. */
#ifndef TRIANGLE_REFINE_SITES_H
#define TRIANGLE_REFINE_SITES_H

#include "triangle/refine/lattice.h"

enum { TRI_SITE_OUT = -1, TRI_SITE_FREE = -2 };

/* A row of sites. */
struct tri_site_row {
    int32_t first, last; /* first and last column; the row is empty if first > last */
    int32_t base;        /* index that a site in column 0 has or would have */
};

/* A part of a lattice, stored row by row. Row 0 is below all sites and column 0 is left of all sites. Around each
 * site that is not TRI_SITE_OUT, all positions within TRI_SITE_MARGIN rows and columns are also stored. */
enum { TRI_SITE_MARGIN = 2 };

struct tri_sites {
    struct tri_lattice lattice; /* the lattice of which this is a part */
    double bottom, left;      /* lattice row of row 0 (an even number); lattice column of column 0 */
    int32_t n_rows;           /* number of rows */
    int32_t n;                /* number of sites; 0: none */
    struct tri_site_row *row; /* [n_rows] */
    int32_t *at;              /* [n] vertex at the site, or TRI_SITE_FREE or TRI_SITE_OUT */
    tri_triangle_id *near;    /* [n] a triangle at the vertex, or close to the site */
};

/* Finds the sites in n triangles with the same area bound. Finds none if there would be more than `most` sites, or
 * more than `most` rows summed over the triangles. Returns false if memory ran out. O(n + rows of all triangles +
 * sites). */
bool tri_sites_find(struct tri_sites *sites, const struct tri_mesh *mesh, const struct tri_lattice *lattice,
                    const tri_triangle_id *triangle, int32_t n, int32_t most);
void tri_sites_free(struct tri_sites *sites);

/* Returns the index of a site. */
static inline int32_t tri_site(const struct tri_sites *sites, int32_t row, int32_t column)
{
    assert(row >= 0 && row < sites->n_rows && column >= sites->row[row].first && column <= sites->row[row].last);
    return sites->row[row].base + column;
}

static inline struct tri_point tri_site_place(const struct tri_sites *sites, int32_t row, int32_t column)
{
    return tri_lattice_at(&sites->lattice, sites->bottom + row, sites->left + column);
}

/* Returns the site whose coordinates equal p exactly, or TRI_NONE. */
int32_t tri_site_of(const struct tri_sites *sites, struct tri_point p);

#endif
