/* Small angles of the input, and the triangles that they explain. Private to the judge. */
#ifndef TRIANGLE_CHECK_APEX_H
#define TRIANGLE_CHECK_APEX_H

#include "triangle/check/internal.h"

#define TRI_CHECK_SLACK   1e-12 /* a bound counts as missed from there on */
#define TRI_CHECK_RADIANS (3.14159265358979323846 / 180)

struct apexes {
    struct checker *c;
    double apex_cosine; /* signed square of the cosine of the largest small input angle */
    uint8_t *is_apex;   /* [n_frame] */
    int32_t *apex_of;   /* [2 n_segments], for each fan entry: the apex that its chain reaches, NO_APEX, UNKNOWN.. */
};

enum tri_status tri_check_find_apexes(struct apexes *apexes, struct checker *c);
/* Marks in c->state the vertices in a triangle with an apex, in one pass over all triangles. */
enum tri_status tri_check_mark_near(struct apexes *apexes);
void tri_check_free_apexes(struct apexes *apexes);
/* Is a triangle with these corners? */
bool tri_check_is_explained(struct apexes *apexes, const int64_t *corners);

#endif
