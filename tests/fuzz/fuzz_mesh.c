/* Fuzz target: makes a mesh of a planar straight line graph and checks it as in tests/torture. It is compiled a second
 * time with FUZZ_SCHEDULE, which refines by the schedule with tiny cells, on one thread and on three. The environment
 * variable PTRIANGLE_FUZZ_IGNORE lists kinds of faults to ignore, separated by commas. */
#include <stdio.h>
#include <stdlib.h>

#include "tests/fuzz/bytes.h"
#include "tests/torture/judge.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#ifdef FUZZ_SCHEDULE
enum { SCHEDULE = 1 };
#else
enum { SCHEDULE = 0 };
#endif

static void take_point(struct bytes *b, struct figure *f, int32_t mode)
{
    double x = bytes_finite(b, mode), y = bytes_finite(b, mode);
    figure_point(f, x, y);
}

static void take_figure(struct bytes *b, struct figure *f)
{
    int32_t mode = bytes_below(b, 4), points = 3 + bytes_below(b, 40), segments = bytes_below(b, 40);
    int32_t holes = bytes_below(b, 4), regions = bytes_below(b, 4);
    for (int32_t i = 0; i < points; i++)
        take_point(b, f, mode);
    for (int32_t i = 0; i < segments; i++) {
        int32_t from = bytes_below(b, points + 1) - 1, to = bytes_below(b, points); /* -1 refers to no point */
        figure_segment(f, from, to);
    }
    for (int32_t i = 0; i < holes; i++) {
        double x = bytes_finite(b, mode), y = bytes_finite(b, mode);
        figure_hole(f, x, y);
    }
    for (int32_t i = 0; i < regions; i++) {
        double x = bytes_finite(b, mode), y = bytes_finite(b, mode);
        figure_region(f, x, y, i + 1, 0);
    }
}

static void take_switches(struct bytes *b, struct torture_case *c)
{
    uint8_t choice = bytes_one(b), angle = bytes_one(b), more = bytes_one(b);
    struct figure_bounds bounds = figure_bounds(&c->figure.pslg);
    double area = (bounds.high[0] - bounds.low[0]) * (bounds.high[1] - bounds.low[1]) / (1 + more % 64 * 8);
    char *at = c->switches, *end = c->switches + sizeof c->switches;
    at += snprintf(at, (size_t)(end - at), "p%s%s%s", choice & 1 ? "c" : "", choice & 2 ? "O" : "",
                   choice & 4 ? "A" : "");
    if (choice & 8 || SCHEDULE)
        at += snprintf(at, (size_t)(end - at), "q%d", angle % 34);
    if ((choice & 16 || SCHEDULE) && area > 1e-9 && area < 1e9)
        at += snprintf(at, (size_t)(end - at), "a%.12f", area);
    if (choice & 32)
        at += snprintf(at, (size_t)(end - at), "%s", more & 64 ? "Y" : "YY");
    if (choice & 64)
        at += snprintf(at, (size_t)(end - at), "D");
    if (choice & 128 && !SCHEDULE)
        snprintf(at, (size_t)(end - at), "S%d", angle);
    c->again = more & 128;
    c->block = SCHEDULE ? 20 << (angle / 34) : 0;
}

/* Figures whose coordinates are all subnormal are refused. */
static bool is_refused(const struct tri_pslg *pslg)
{
    struct tri_mesh mesh;
    struct tri_error error;
    bool is = tri_mesh_init(&mesh, &error) || tri_mesh_take_points(&mesh, pslg, NULL, &error);
    tri_mesh_free(&mesh);
    return is;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct bytes b = {data, data + size};
    struct torture_case c = {.family = "fuzz", .figure = figure_new(1)};
    struct verdict verdict = {.fault = ""};
    take_figure(&b, &c.figure);
    take_switches(&b, &c);
    if (!is_refused(&c.figure.pslg))
        judge_case(&c, &verdict);
    if (verdict.fault[0] && !judge_names(getenv("PTRIANGLE_FUZZ_IGNORE"), verdict.fault)) {
        const char *path = getenv("PTRIANGLE_FUZZ_POLY");
        fprintf(stderr, "fuzz_mesh: %s: %s: %s; -%s, blocks of %d%s\n", verdict.stage, verdict.fault, verdict.detail,
                c.switches, (int)c.block, c.again ? ", again" : "");
        if (path)
            case_write(&c, path, verdict.fault);
        abort();
    }
    case_free(&c);
    return 0;
}
