/* A random planar straight line graph in the making, and the tools its makers share.
 *
 * Everything is drawn from one seed by + - * / and sqrt alone, so that a seed names the same figure on every machine.
 * Running out of memory ends the process: this is a test program. */
#ifndef TESTS_TORTURE_FIGURE_H
#define TESTS_TORTURE_FIGURE_H

#include "tests/support.h"
#include "triangle/mesh/pslg.h"

struct figure {
    struct tri_pslg pslg; /* owns its arrays; markers are there for all points and segments */
    int32_t room[4];      /* for points, segments, holes, regions */
    struct support_random random;
    bool with_markers; /* segments and points draw markers; else all are 0 */
};

struct figure figure_new(uint64_t seed);
void figure_free(struct figure *figure);

/* --- chance */

bool figure_chance(struct figure *figure, double probability);
double figure_real(struct figure *figure, double low, double high);
int32_t figure_whole(struct figure *figure, int32_t low, int32_t high); /* low .. high, both included */
int32_t figure_size(struct figure *figure, int32_t low, int32_t high);  /* the same, small ones more often */
double figure_power(struct figure *figure, int32_t low, int32_t high);  /* a power of ten times 1 .. 10 */

/* What is drawn is drawn in this order: x, y; a, b. (Arguments of a call are evaluated in any order, so that no two of
 * them may draw.) */
struct tri_point figure_draw(struct figure *figure, double low, double high); /* both coordinates in low .. high */
int32_t figure_draw_point(struct figure *figure, double low, double high);
void figure_draw_segment(struct figure *figure, int32_t first, int32_t last); /* between two points of first .. last */

/* --- numbers */

double figure_ten_to(int32_t exponent);
struct tri_point figure_on_circle(double turns); /* of radius 1 around the origin */
double figure_round(double x, double unit);      /* to the nearest multiple of unit; unit 1 / n for decimals */
double figure_ulps(double x, int32_t ulps);      /* so many floating point numbers further up */

/* --- building */

int32_t figure_point(struct figure *figure, double x, double y);
void figure_segment(struct figure *figure, int32_t a, int32_t b);
void figure_path(struct figure *figure, int32_t first, int32_t n); /* n points in a row, one segment between each two */
void figure_loop(struct figure *figure, int32_t first, int32_t n); /* closed */
void figure_hole(struct figure *figure, double x, double y);
void figure_region(struct figure *figure, double x, double y, double attribute, double max_area);

int32_t figure_box(struct figure *figure, double x, double y, double width, double height); /* first of 4 points */
int32_t figure_ring(struct figure *figure, double x, double y, double radius, int32_t n);   /* first of n points */
struct tri_point figure_at(const struct figure *figure, int32_t point);
/* The point at this fraction of the way from a to b, as rounding has it. */
struct tri_point figure_along(const struct figure *figure, int32_t a, int32_t b, double fraction);

struct figure_bounds {
    double low[2], high[2], largest; /* coordinate, absolute */
};
struct figure_bounds figure_bounds(const struct tri_pslg *pslg);

#endif
