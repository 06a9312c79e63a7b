/* The C interface of Triangle 1.6, drop-in: what was compiled against Triangle's header compiles against this one,
 * and what was linked to Triangle links to libtriangle.a, or to libptriangle.a and libtriangle.a, in that order, and
 * then refines on all cores.
 *
 * Includes nothing, so that it may stand within a namespace or within extern "C"; C89 and later, C++98 and later.
 * The coordinate type is TRI_REAL, which is double. A REAL of the client's, which Triangle's own header asks for, must
 * be the same type; none is made. A library built with PTRIANGLE_SINGLE has float instead; its clients define SINGLE.
 * Inside, coordinates are double either way. Rounded to float, triangles may turn flat or over where a float is coarse
 * against them: keep the origin near.
 *
 * No call ends the process or keeps anything: any number of threads may call at the same time. The same input and
 * switches give the same output, bit for bit, for any number of threads, compiler or locale; the two libraries make
 * different meshes for the same bounds. In a forked child libptriangle refines on one thread. */
#ifndef TRIANGLE_TRIANGLE_H
#define TRIANGLE_TRIANGLE_H

/* ERRORS are returned, as an enum triangulate_status; Triangle's own function returns nothing. After an error nothing
 * is allocated, no array is changed, and all counts in *out and *vorout are 0, so that a client that does not ask sees
 * no mesh; only an *out that is *in stays as it was. options->message receives the text of the error. Old clients ask
 * for no status, so triangulate() prints this text as one line on standard error, also with the switch Q. Without Q it
 * prints a line in four more cases: a mesh is empty without an error ("the outline is open at points 3 and 17"),
 * segments are skipped, a number of a switch is misread (a1e-5 is a1 and e), v has no vorout. It prints nothing else;
 * triangulate_with() prints nothing.
 *
 * Input that Triangle's library accepts, or on which it crashes although the meaning is plain, is no error: negative
 * counts of holes, regions and attributes of triangles (none), r with a bare `a` but without trianglearealist (no
 * bounds), v without vorout (no diagram). */

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

/* Does not compile where SINGLE, TRI_REAL and REAL contradict each other. */
#ifdef SINGLE
typedef char triangulate_real_is_float[sizeof(TRI_REAL) == sizeof(float) ? 1 : -1];
#else
typedef char triangulate_real_is_double[sizeof(TRI_REAL) == sizeof(double) ? 1 : -1];
#endif
#ifdef REAL
typedef char triangulate_reals_agree[sizeof(REAL) == sizeof(TRI_REAL) ? 1 : -1];
#endif

/* What goes in and what comes out. Arrays begin at [0], but what they say counts from 1: points, triangles and Voronoi
 * points have numbers from 1, or from 0 with the switch z; -1 is no neighbour and no second end either way.
 *
 * The letters tell which switches have the field read in `in`, then which have it written in `out`; a ! stands for
 * "not with". What is not mentioned is neither read nor written, so it need not be set. The counts of `out` are always
 * written, those of holes and regions with their lists.
 *
 * An array of `out` that is NULL is allocated by malloc (also where it is empty), to be freed by free or trifree. One
 * that is not is filled: it must be large enough. `out` may name arrays of `in`. */
struct triangulateio {
    TRI_REAL *pointlist;        /* x, y: always | !N */
    TRI_REAL *pointattributelist; /* if there are attributes: always | !N */
    int *pointmarkerlist;       /* NULL: all 0: always | !N !B */
    int numberofpoints;
    int numberofpointattributes;

    int *trianglelist;          /* corners counter-clockwise; with o2 then the middles of the edges opposite to them:
                                   r | !E */
    TRI_REAL *triangleattributelist; /* if there are attributes: r | !E */
    TRI_REAL *trianglearealist; /* largest areas, <= 0: any; NULL: any: ra (a without number) | never */
    int *neighborlist;          /* triangles opposite the corners: never | n */
    int numberoftriangles;      /* r */
    int numberofcorners;        /* r: 3 or 6; others than the first three are left out */
    int numberoftriangleattributes; /* r */

    int *segmentlist;           /* ends: p | p or c, !P */
    int *segmentmarkerlist;     /* NULL: all 0: p | p or c, !P !B */
    int numberofsegments;       /* p; of the boundary where neither p nor c is said */

    TRI_REAL *holelist;         /* x, y: p !r | p or c, !P: the pointer itself and the count; NULL and 0 without p */
    int numberofholes;
    TRI_REAL *regionlist;       /* x, y, attribute, largest area: p !r, with A or a | as holelist */
    int numberofregions;

    int *edgelist;              /* ends: never | e; of vorout v: Voronoi points, -1 for the far end of a ray */
    int *edgemarkerlist;        /* never | e !B */
    TRI_REAL *normlist;         /* of vorout v: direction of a ray, 0 0 for an edge with two ends */
    int numberofedges;          /* of Delaunay and of Voronoi edges: edge i is dual to edge i */
};

enum triangulate_status {
    TRIANGULATE_OK = 0,
    TRIANGULATE_NO_MEMORY = 1,
    TRIANGULATE_TOO_LARGE = 2, /* more than 2^28 points or 2^29 triangles */
    TRIANGULATE_BAD_INPUT = 3, /* switches or input have no meaning: the message tells which and where */
    TRIANGULATE_INTERNAL = 7,  /* a defect of the library */
    TRIANGULATE_STOPPED = 8    /* options->stop said so */
};

/* Triangulates `in` as the string of switches says. vorout receives the Voronoi diagram (v). It may be NULL: then there
 * is no diagram. Otherwise its counts are written, also without v. */
int triangulate(const char *switches, struct triangulateio *in, struct triangulateio *out,
                struct triangulateio *vorout);

/* The size test for the switch u, which the client has in its own code, with C linkage; u without it is an error. Not
 * 0: the triangle must be refined. Called for triangles that keep all other bounds of size, many times for each that
 * remains, from one thread at a time; corners counter-clockwise, x and y alone. */
#ifdef EXTERNAL_TEST
int triunsuitable(TRI_REAL *origin, TRI_REAL *destination, TRI_REAL *apex, TRI_REAL area);
#endif

/* Frees an array of `out` or `vorout`. */
void trifree(void *array);

/* Beyond Triangle: what a call of triangulate cannot be told by switches. All zero: as triangulate. */
struct triangulate_options {
    /* The size test for the switch u, instead of triunsuitable. Not 0: the triangle a, b, c must be refined. */
    int (*unsuitable)(void *user, const TRI_REAL *a, const TRI_REAL *b, const TRI_REAL *c, TRI_REAL area);
    void *unsuitable_user;
    int unsuitable_in_parallel; /* not 0: the size test, either, may be called by several threads at once. What it
                                   answers must not depend on order; it is then also asked about triangles that are
                                   never made. Else u means one thread */
    int threads;                /* of libptriangle; <= 0: OMP_NUM_THREADS, else one for each core */
    /* Called on the calling thread with one sentence, without newline. With is_error it is the error. Otherwise it is
     * a remark on the input. With the switch Q only these remarks remain: why a mesh is empty, which number of a switch
     * is misread, that v has no vorout. */
    void (*message)(void *user, int is_error, const char *text);
    void *message_user;
    /* Not 0: the call ends soon, with TRIANGULATE_STOPPED. Asked every few thousand steps, by several threads at once;
     * once it has said so, it must go on saying so. */
    int (*stop)(void *user);
    void *stop_user;
};

/* options may be NULL. */
int triangulate_with(const char *switches, const struct triangulateio *in, struct triangulateio *out,
                     struct triangulateio *vorout, const struct triangulate_options *options);

#ifdef __cplusplus
}
#endif

#endif
