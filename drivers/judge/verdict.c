/* What a report says, in lines or in JSON. */
#include "drivers/judge/verdict.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

static void print_items(const struct tri_check_report *r, bool quiet)
{
    for (int k = 0; k < TRI_N_CHECKS; k++) {
        const struct tri_check_item *item = &r->item[k];
        const char *name = tri_check_name((enum tri_check_kind)k);
        if (item->state == TRI_CHECK_FAILED) {
            printf("FAIL  %s: %" PRId64 ", first: %s\n", name, item->count, item->text);
        } else if (!quiet) {
            printf("%s  %s\n", item->state == TRI_CHECK_OK ? "ok  " : "-   ", name);
        }
    }
}

static void print_summary(const struct verdict_style *s, const struct judged_files *f, const struct tri_check_report *r)
{
    printf("vertices %" PRId64 " (%" PRId64 " used), triangles %" PRId64 ", edges %" PRId64 ", boundary edges %" PRId64
           ", subsegments %" PRId64 "\n",
           f->n_nodes, r->n_used_points, f->source.n_triangles, r->n_edges, r->n_boundary_edges, f->source.n_segments);
    if (f->source.n_triangles == 0)
        return;
    printf("angles: smallest %.10g (triangle %" PRId64 "), largest %.10g (triangle %" PRId64 ")\n", r->smallest_angle,
           r->smallest_angle_at + f->base, r->largest_angle, r->largest_angle_at + f->base);
    printf("areas: smallest %.10g (triangle %" PRId64 "), largest %.10g (triangle %" PRId64 "), total %.17g\n",
           r->smallest_area, r->smallest_area_at + f->base, r->largest_area, r->largest_area_at + f->base,
           r->total_area);
    if (s->min_angle <= 0)
        return;
    printf("angles below %g: %" PRId64, s->min_angle, r->n_small);
    if (r->n_small == 0) {
        puts("");
    } else if (r->n_small == r->n_small_explained) {
        puts(", all at small input angles");
    } else {
        printf(", %" PRId64 " of them at small input angles\n", r->n_small_explained);
    }
}

/* Points that no triangle uses, which make a solver's matrix singular. 0 without triangles. */
static int64_t unused_points(const struct judged_files *f, const struct tri_check_report *r)
{
    return r->n_used_points > 0 ? f->source.n_points - r->n_used_points : 0;
}

void verdict_print_lines(const struct verdict_style *s, const struct judged_files *f, const struct tri_check_report *r)
{
    print_items(r, s->quiet);
    if (!s->quiet) {
        if (unused_points(f, r) > 0)
            printf("warn  vertices in no triangle: %" PRId64 " (-j of ptriangle leaves them out)\n",
                   unused_points(f, r));
        print_summary(s, f, r);
        puts(tri_check_passed(r) ? "no fault" : "FAULTS");
    }
}

static void print_json_string(const char *text)
{
    putchar('"');
    for (; *text != '\0'; text++) {
        if (*text == '"' || *text == '\\')
            putchar('\\');
        if ((unsigned char)*text >= ' ')
            putchar(*text);
    }
    putchar('"');
}

/* JSON has no infinities. */
static void print_json_real(const char *key, double value)
{
    printf(isfinite(value) ? ", \"%s\": %.17g" : ", \"%s\": null", key, value);
}

void verdict_print_json(const struct verdict_style *s, const struct judged_files *f, const struct tri_check_report *r)
{
    static const char *const states[] = {"skipped", "ok", "failed"};
    printf("{\"passed\": %s, \"base\": ", tri_check_passed(r) ? "true" : "false");
    print_json_string(s->base);
    printf(", \"vertices\": %" PRId64 ", \"used_vertices\": %" PRId64 ", \"unused_vertices\": %" PRId64
           ", \"triangles\": %" PRId64 ", \"edges\": %" PRId64 ", \"boundary_edges\": %" PRId64
           ", \"subsegments\": %" PRId64,
           f->n_nodes, r->n_used_points, unused_points(f, r), f->source.n_triangles, r->n_edges,
           r->n_boundary_edges, f->source.n_segments);
    print_json_real("smallest_angle", r->smallest_angle);
    print_json_real("largest_angle", r->largest_angle);
    print_json_real("smallest_area", r->smallest_area);
    print_json_real("largest_area", r->largest_area);
    print_json_real("total_area", r->total_area);
    printf(", \"below_min_angle\": %" PRId64 ", \"below_min_angle_explained\": %" PRId64 ", \"checks\": [", r->n_small,
           r->n_small_explained);
    for (int k = 0; k < TRI_N_CHECKS; k++) {
        printf("%s{\"name\": \"%s\", \"state\": \"%s\", \"count\": %" PRId64 ", \"first\": ", k > 0 ? ", " : "",
               tri_check_name((enum tri_check_kind)k), states[r->item[k].state], r->item[k].count);
        print_json_string(r->item[k].text);
        putchar('}');
    }
    puts("]}");
}
