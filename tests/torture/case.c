/* Draws the figure, a transformation of the whole figure, and switches. */
#include "tests/torture/case.h"

#include "triangle/text/read.h"

/* --- figure */

static const struct family *draw_family(struct support_random *random, const struct torture_range *range)
{
    double sum = 0;
    for (int32_t i = 0; i < range->n_families; i++)
        sum += range->families[i]->weight;
    double at = support_unit(random) * sum;
    for (int32_t i = 0; i + 1 < range->n_families; i++) {
        at -= range->families[i]->weight;
        if (at < 0)
            return range->families[i];
    }
    return range->families[range->n_families - 1];
}

/* x, y become xx x + xy y + dx, yx x + yy y + dy. */
struct affine {
    double xx, xy, yx, yy, dx, dy;
};

static struct affine draw_map(struct figure *f)
{
    struct tri_point turn = figure_on_circle(figure_real(f, 0, 1));
    switch (figure_whole(f, 0, 4)) {
    case 0: return (struct affine){turn.x, -turn.y, turn.y, turn.x, 0, 0};
    case 1: return (struct affine){1, 0, 0, figure_power(f, -7, 5), 0, 0};
    case 2: {
        double x = figure_power(f, 0, 12), y = figure_power(f, 0, 12);
        return (struct affine){1, 0, 0, 1, x, y};
    }
    case 3: {
        double scale = figure_power(f, -40, 40);
        return (struct affine){scale, 0, 0, scale, 0, 0};
    }
    default: return (struct affine){1, figure_real(f, -5, 5), 0, 1, 0, 0};
    }
}

static void map_points(double *points, int32_t n, size_t stride, const struct affine *map)
{
    for (size_t i = 0; i < (size_t)n; i++) {
        double *p = points + i * stride, x = p[0], y = p[1];
        p[0] = map->xx * x + map->xy * y + map->dx;
        p[1] = map->yx * x + map->yy * y + map->dy;
    }
}

/* Sometimes transforms the whole figure: rotated, stretched, moved, scaled, slanted, or rounded to a grid. */
static void vary(struct figure *f)
{
    struct tri_pslg *p = &f->pslg;
    if (figure_chance(f, 0.3)) {
        struct affine map = draw_map(f);
        double grows = fabs(map.xx * map.yy - map.xy * map.yx);
        map_points(p->points, p->n_points, 2, &map);
        map_points(p->holes, p->n_holes, 2, &map);
        map_points(p->regions, p->n_regions, 4, &map);
        for (size_t i = 0; i < (size_t)p->n_regions; i++)
            p->regions[4 * i + 3] *= grows;
    } else if (figure_chance(f, 0.15)) {
        struct figure_bounds b = figure_bounds(p);
        double unit = figure_ten_to(figure_whole(f, -6, -1));
        for (size_t i = 0; b.largest < 1e6 && i < 2 * (size_t)p->n_points; i++)
            p->points[i] = figure_round(p->points[i], unit);
    }
}

/* Attributes that are linear in the plane. */
static void add_attributes(struct figure *f)
{
    struct tri_pslg *p = &f->pslg;
    p->n_attributes = 1;
    p->attributes = malloc((size_t)p->n_points * sizeof *p->attributes);
    for (size_t i = 0; p->attributes && i < (size_t)p->n_points; i++)
        p->attributes[i] = 1 + p->points[2 * i] / 2;
    p->n_attributes = p->attributes ? 1 : 0;
}

/* --- switches */

/* An area bound that limits the figure to a few thousand triangles and regions to some ten thousand. 0 if an area is
 * not a normal number. */
static double draw_area(struct figure *f)
{
    struct figure_bounds b = figure_bounds(&f->pslg);
    double whole = (b.high[0] - b.low[0]) * (b.high[1] - b.low[1]), area = whole / figure_power(f, 0, 3);
    for (size_t i = 0; i < (size_t)f->pslg.n_regions; i++) {
        double *own = f->pslg.regions + 4 * i + 3;
        *own = *own > 0 ? fmax(*own, whole / 1e4) : 0;
    }
    return area > 1e-30 && area < 1e30 ? area : 0;
}

static double draw_angle(struct figure *f)
{
    double chance = figure_real(f, 0, 1);
    return chance < 0.35 ? 20 : chance < 0.55 ? figure_whole(f, 20, 30) : chance < 0.8 ? figure_whole(f, 30, 34)
           : chance < 0.85 ? figure_real(f, 0, 20) : figure_whole(f, 35, 41);
}

static void append(struct torture_case *c, const char *text)
{
    size_t n = strlen(c->switches);
    snprintf(c->switches + n, sizeof c->switches - n, "%s", text);
}

static void append_number(struct torture_case *c, const char *letter, double value, int decimals)
{
    char text[96];
    snprintf(text, sizeof text, "%s%.*f", letter, decimals, value);
    append(c, text);
}

static void draw_sizes(struct torture_case *c)
{
    struct figure *f = &c->figure;
    double area = draw_area(f);
    if (area > 0 && figure_chance(f, 0.35))
        append_number(c, "a", area, area < 1e-3 ? 40 : 8);
    if (f->pslg.n_regions > 0 && figure_chance(f, 0.5))
        append(c, "a");
    if (f->pslg.n_regions > 0 && figure_chance(f, 0.5))
        append(c, "A");
    if (figure_chance(f, 0.04)) {
        append(c, "u");
        c->with_size_test = true;
    }
}

static void draw_switches(struct torture_case *c)
{
    struct figure *f = &c->figure;
    static const struct {
        const char *letters;
        double probability;
    } flags[] = {{"D", 0.1}, {"Y", 0.08}, {"YY", 0.05}, {"O", 0.08}, {"s", 0.02}, {"i", 0.02}, {"F", 0.02}};
    double angle = draw_angle(f);
    if (figure_chance(f, 0.9))
        append_number(c, "q", angle, 1);
    draw_sizes(c);
    for (size_t i = 0; i < sizeof flags / sizeof *flags; i++)
        if (figure_chance(f, flags[i].probability))
            append(c, flags[i].letters);
    if (figure_chance(f, 0.05))
        append_number(c, "S", figure_size(f, 0, 400), 0);
    c->again = figure_chance(f, 0.15);
    if (figure_chance(f, 0.5)) {
        static const int32_t blocks[] = {60, 250, 1000, 4000};
        c->block = blocks[figure_whole(f, 0, 3)];
    }
}

struct torture_case case_draw(uint64_t seed, const struct torture_range *range)
{
    struct torture_case c = {.seed = seed, .figure = figure_new(seed)};
    struct figure *f = &c.figure;
    const struct family *family = draw_family(&f->random, range);
    c.family = family->name;
    family->make(f);
    if (!family->keeps_its_size)
        vary(f);
    if (figure_chance(f, 0.2))
        add_attributes(f);
    append(&c, f->pslg.n_segments > 0 && !figure_chance(f, 0.03) ? "p" : "");
    if (figure_chance(f, 0.4))
        append(&c, "c");
    if (!range->only_triangulate && figure_chance(f, family->is_near ? 0.7 : 0.9))
        draw_switches(&c);
    return c;
}

bool case_is_refined(const struct torture_case *c)
{
    struct tri_switches switches = tri_switches_none();
    tri_switches_add(&switches, c->switches);
    return tri_switches_refine(&switches);
}

void case_free(struct torture_case *c)
{
    figure_free(&c->figure);
    *c = (struct torture_case){0};
}

/* --- files */

void case_command(const struct torture_case *c, const char *file, char *text, size_t n)
{
    const char *note = c->again ? " (then -r of the result)" : c->with_size_test ? " (with a size test)" : "";
    if (c->block > 0)
        snprintf(text, n, "PTRIANGLE_TEST_BLOCK=%d ptriangle --threads 3 -%s %s%s", (int)c->block, c->switches, file,
                 note);
    else
        snprintf(text, n, "triangle -%s %s%s", c->switches, file, note);
}

static void write_sections(const struct tri_pslg *p, FILE *out)
{
    fprintf(out, "%d 2 %d 1\n", (int)p->n_points, (int)p->n_attributes);
    for (size_t i = 0; i < (size_t)p->n_points; i++) {
        fprintf(out, "%zu %.17g %.17g", i + 1, p->points[2 * i], p->points[2 * i + 1]);
        for (size_t k = 0; k < (size_t)p->n_attributes; k++)
            fprintf(out, " %.17g", p->attributes[i * (size_t)p->n_attributes + k]);
        fprintf(out, " %d\n", p->markers ? (int)p->markers[i] : 0);
    }
    fprintf(out, "%d 1\n", (int)p->n_segments);
    for (size_t i = 0; i < (size_t)p->n_segments; i++)
        fprintf(out, "%zu %d %d %d\n", i + 1, (int)p->segments[2 * i] + 1, (int)p->segments[2 * i + 1] + 1,
                p->segment_markers ? (int)p->segment_markers[i] : 0);
    fprintf(out, "%d\n", (int)p->n_holes);
    for (size_t i = 0; i < (size_t)p->n_holes; i++)
        fprintf(out, "%zu %.17g %.17g\n", i + 1, p->holes[2 * i], p->holes[2 * i + 1]);
    fprintf(out, "%d\n", (int)p->n_regions);
    for (size_t i = 0; i < (size_t)p->n_regions; i++) {
        const double *r = p->regions + 4 * i;
        fprintf(out, "%zu %.17g %.17g %.17g %.17g\n", i + 1, r[0], r[1], r[2], r[3]);
    }
}

bool case_write(const struct torture_case *c, const char *path, const char *fault)
{
    char command[512];
    FILE *out = fopen(path, "w");
    if (!out)
        return false;
    case_command(c, path, command, sizeof command);
    fprintf(out, "# seed %llu, family %s: %s\n# %s\n", (unsigned long long)c->seed, c->family, fault, command);
    write_sections(&c->figure.pslg, out);
    return fclose(out) == 0;
}

/* The reader's arrays as a figure, which owns them and may shrink them. */
bool case_read(struct torture_case *c, const char *path)
{
    struct tri_read_options options = {.default_base = 1, .want_regions = true};
    struct tri_error error = {0};
    char node[1024];
    int32_t base;
    bool points_in_poly;
    size_t n = strlen(path);
    bool is_node = n > 5 && strcmp(path + n - 5, ".node") == 0;
    snprintf(node, sizeof node, "%.*s.node", (int)(n > 5 ? n - 5 : n), path);
    enum tri_status status =
        is_node ? tri_read_node(path, &options, &c->figure.pslg, &base, &error)
                : tri_read_poly(path, node, &options, &c->figure.pslg, &base, &points_in_poly, &error);
    if (status)
        fprintf(stderr, "torture: %s:%ld: %s\n", error.file, (long)error.line, error.text);
    c->family = path;
    return !status;
}
