/* A random planar straight line graph under construction, and the functions that its generators share.
 *
 * All values are drawn from one seed, with + - * / and sqrt alone, so a seed gives the same figure on every machine.
 * The process ends if memory runs out, since this is a test program. */
#ifndef TESTS_TORTURE_FIGURE_H
#define TESTS_TORTURE_FIGURE_H

#include "tests/support.h"
#include "triangle/mesh/pslg.h"

struct figure {
    struct tri_pslg pslg; /* owns its arrays; all points and segments have markers */
    int32_t room[4];      /* capacity for points, segments, holes, regions */
    struct support_random random;
    bool with_markers;    /* true: points and segments get random markers; false: all are 0 */
};

struct figure figure_new(uint64_t seed);
void figure_free(struct figure *figure);

/* --- random numbers */

bool figure_chance(struct figure *figure, double probability);
double figure_real(struct figure *figure, double low, double high);
int32_t figure_whole(struct figure *figure, int32_t low, int32_t high); /* low .. high, both included */
int32_t figure_size(struct figure *figure, int32_t low, int32_t high);  /* the same, small numbers more often */
double figure_power(struct figure *figure, int32_t low, int32_t high);  /* a power of ten times 1 .. 10 */

/* Values are drawn in the order x, y; a, b. (C evaluates arguments of a call in any order, so at most one argument may
 * draw.) */
struct tri_point figure_draw(struct figure *figure, double low, double high); /* both coordinates in low .. high */
int32_t figure_draw_point(struct figure *figure, double low, double high);
void figure_draw_segment(struct figure *figure, int32_t first, int32_t last); /* between two points of first .. last */

/* --- numbers */

double figure_ten_to(int32_t exponent);
struct tri_point figure_on_circle(double turns); /* a point on the unit circle around the origin */
double figure_round(double x, double unit);      /* to the nearest multiple of unit; 1 / n for decimals */
double figure_ulps(double x, int32_t ulps);      /* moves x up by this many floating-point numbers */

/* --- building */

int32_t figure_point(struct figure *figure, double x, double y);
void figure_segment(struct figure *figure, int32_t a, int32_t b);
void figure_path(struct figure *figure, int32_t first, int32_t n); /* n points joined by segments */
void figure_loop(struct figure *figure, int32_t first, int32_t n); /* the same, closed */
void figure_hole(struct figure *figure, double x, double y);
void figure_region(struct figure *figure, double x, double y, double attribute, double max_area);

int32_t figure_box(struct figure *figure, double x, double y, double width, double height); /* first of 4 points */
int32_t figure_ring(struct figure *figure, double x, double y, double radius, int32_t n);   /* first of n points */
struct tri_point figure_at(const struct figure *figure, int32_t point);
/* The rounded point at this fraction of the way from a to b. */
struct tri_point figure_along(const struct figure *figure, int32_t a, int32_t b, double fraction);

struct figure_bounds {
    double low[2], high[2], largest; /* largest absolute coordinate */
};
struct figure_bounds figure_bounds(const struct tri_pslg *pslg);

#endif
