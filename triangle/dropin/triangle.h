/* The C interface of Triangle 1.6, as a drop-in replacement. Code written for Triangle's header compiles with this
 * header. Programs linked to Triangle link to libtriangle.a. If they link to libptriangle.a and libtriangle.a, in
 * this order, they refine on all cores.
 *
 * The header includes nothing, so it may be included inside a namespace or extern "C". It works with C89 and later,
 * C++98 and later. The coordinate type is TRI_REAL, which is double. If the client defines REAL, as Triangle's own
 * header requires, it must be the same type; this header does not define it. A library built with PTRIANGLE_SINGLE
 * uses float; its clients must define SINGLE. Internally coordinates are always double. Rounding to float may
 * flatten or invert small triangles far from the origin, so keep coordinates near the origin.
 *
 * No function exits the process or keeps state, so any number of threads may call at the same time. The same input
 * and switches give the same output, bit for bit, for any number of threads, compiler or locale. The two libraries
 * make different meshes for the same bounds. In a forked child process, libptriangle refines on one thread. */
#ifndef TRIANGLE_TRIANGLE_H
#define TRIANGLE_TRIANGLE_H

/* ERRORS are returned as an enum triangulate_status; Triangle's own function returns nothing. After an error no
 * memory is allocated, no array has changed, and all counts in *out and *vorout are 0, so clients that ignore the
 * status see an empty mesh. The only exception: if out == in, *out is unchanged. options->message receives the text
 * of the error.
 *
 * Since old clients ignore the status, triangulate() prints this text as one line on standard error, even with the
 * switch Q. Without Q it prints a line in four more cases: a mesh is empty without an error ("the outline is open at
 * points 3 and 17"), segments are skipped, a number of a switch is misread (a1e-5 is a1 and e), or v is used without
 * vorout. Otherwise it prints nothing. triangulate_with() never prints.
 *
 * Some invalid inputs are accepted because Triangle's library accepts them, or crashes although the meaning is
 * clear: negative counts of holes, regions or triangle attributes (none), r with a bare `a` but without
 * trianglearealist (no bounds), v without vorout (no diagram). */

#ifndef TRI_REAL
#ifdef SINGLE
#define TRI_REAL float
#else
#define TRI_REAL double
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Compilation fails if SINGLE, TRI_REAL and REAL contradict each other. */
#ifdef SINGLE
typedef char triangulate_real_is_float[sizeof(TRI_REAL) == sizeof(float) ? 1 : -1];
#else
typedef char triangulate_real_is_double[sizeof(TRI_REAL) == sizeof(double) ? 1 : -1];
#endif
#ifdef REAL
typedef char triangulate_reals_agree[sizeof(REAL) == sizeof(TRI_REAL) ? 1 : -1];
#endif

/* Input and output. Arrays begin at index [0], but numbers of points, triangles and Voronoi points count from 1, or
 * from 0 with the switch z. In both cases -1 means no neighbour, or no second end.
 *
 * The comment of a field has the form "contents: switches for `in` | switches for `out`". The field is read from
 * `in`, or written to `out`, only with these switches; !X means without switch X. All other fields are neither read
 * nor written and may be uninitialised. The counts of `out` are always written, except that the counts of holes and
 * regions are written together with their lists.
 *
 * If an array of `out` is NULL, it is allocated by malloc, even if it is empty; free it with free or trifree.
 * Otherwise the given array is filled and must be large enough. `out` may use arrays of `in`. */
struct triangulateio {
    TRI_REAL *pointlist;        /* x, y: always | !N */
    TRI_REAL *pointattributelist; /* if there are attributes: always | !N */
    int *pointmarkerlist;       /* NULL: all 0: always | !N !B */
    int numberofpoints;         /* always */
    int numberofpointattributes;  /* always: attributes per point */

    int *trianglelist;          /* corners counter-clockwise; with o2, then the midside nodes opposite each corner: r
                                   | !E */
    TRI_REAL *triangleattributelist; /* if there are attributes: r | !E */
    TRI_REAL *trianglearealist; /* largest areas, <= 0: no bound; NULL: none: ra (a without a number) | never */
    int *neighborlist;          /* triangles opposite each corner: never | n */
    int numberoftriangles;      /* r */
    int numberofcorners;        /* r: 3 or 6; nodes after the first three are ignored */
    int numberoftriangleattributes; /* r */

    int *segmentlist;           /* ends: p | p or c, !P */
    int *segmentmarkerlist;     /* NULL: all 0: p | p or c, !P !B */
    int numberofsegments;       /* p; without p and c, the number of boundary segments */

    TRI_REAL *holelist;         /* x, y: p !r | p or c, !P: the same pointer and count; NULL and 0 without p */
    int numberofholes;          /* with holelist */
    TRI_REAL *regionlist;       /* x, y, attribute, largest area: p !r, with A or a | like holelist */
    int numberofregions;        /* with regionlist */

    int *edgelist;              /* ends: never | e; in vorout with v: Voronoi points, -1 for the infinite end of a
                                   ray */
    int *edgemarkerlist;        /* never | e !B */
    TRI_REAL *normlist;         /* in vorout with v: direction of a ray; 0 0 for an edge with two ends */
    int numberofedges;          /* Delaunay or Voronoi edges; edge i of one is dual to edge i of the other */
};

enum triangulate_status {
    TRIANGULATE_OK = 0,
    TRIANGULATE_NO_MEMORY = 1,
    TRIANGULATE_TOO_LARGE = 2, /* more than 2^28 points or 2^29 triangles */
    TRIANGULATE_BAD_INPUT = 3, /* invalid switches or input; the message says what is wrong */
    TRIANGULATE_INTERNAL = 7,  /* an internal error of the library */
    TRIANGULATE_STOPPED = 8    /* options->stop requested a stop */
};

/* Triangulates `in` according to the switches. vorout receives the Voronoi diagram (v) and may be NULL; otherwise
 * its counts are always written, even without v. */
int triangulate(const char *switches, struct triangulateio *in, struct triangulateio *out,
                struct triangulateio *vorout);

/* The size test for the switch u, defined by the client with C linkage. Using u without it is an error. Returns
 * non-zero if the triangle must be refined. Called for triangles that satisfy all other size bounds, many times for
 * each final triangle, by one thread at a time. The corners are counter-clockwise and have x and y only. */
#ifdef EXTERNAL_TEST
int triunsuitable(TRI_REAL *origin, TRI_REAL *destination, TRI_REAL *apex, TRI_REAL area);
#endif

/* Frees an array of `out` or `vorout`. */
void trifree(void *array);

/* Options that Triangle's switches do not cover. If all members are 0, triangulate_with behaves like triangulate
 * without printing. */
struct triangulate_options {
    /* The size test for the switch u, used instead of triunsuitable. Returns non-zero if the triangle a, b, c must
     * be refined. */
    int (*unsuitable)(void *user, const TRI_REAL *a, const TRI_REAL *b, const TRI_REAL *c, TRI_REAL area);
    void *unsuitable_user;      /* passed to unsuitable */
    int unsuitable_in_parallel; /* non-zero: several threads may call the size test (this one or triunsuitable) at
                                   once. Its result must not depend on the order of calls, and it is also called for
                                   temporary triangles. 0: u uses one thread */
    int threads;                /* threads of libptriangle; <= 0: OMP_NUM_THREADS, or if that is not set one per core */
    /* Called on the calling thread with one sentence, without a newline: the error if is_error is non-zero,
     * otherwise a remark on the input. With the switch Q only three remarks remain: why a mesh is empty, which
     * number of a switch is misread, and that v has no vorout. */
    void (*message)(void *user, int is_error, const char *text);
    void *message_user; /* passed to message */
    /* Return non-zero to stop. The call then soon returns TRIANGULATE_STOPPED. Called every few thousand steps, by
     * several threads at once. After it has returned non-zero it must keep returning non-zero. */
    int (*stop)(void *user);
    void *stop_user; /* passed to stop */
    /* Non-zero: new points are placed as by Triangle. 0: with an area bound and an angle bound up to 30 degrees they
     * lie in a hexagonal lattice, which needs a third fewer triangles; not with the switches r and u. */
    int classic;
};

/* Like triangulate, with options; NULL: none. Never prints. */
int triangulate_with(const char *switches, const struct triangulateio *in, struct triangulateio *out,
                     struct triangulateio *vorout, const struct triangulate_options *options);

#ifdef __cplusplus
}
#endif

#endif
