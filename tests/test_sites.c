/* Sites of a lattice in some triangles of a mesh. The reference compares each lattice point in the box around these
   triangles with every triangle, vertex and subsegment. */
#include "allocations.h"
#include "support.h"

#include "triangle/refine/sites.h"
#include "triangle/tunables.h"

static const double ROW = 0.86602540378443864676; /* sqrt(3) / 2, the height of an equilateral triangle with edge length
                                                     1 */

struct extent {
    struct tri_point low, high;
};

/* Some triangles of a mesh, and a lattice. */
struct trial {
    struct tri_mesh mesh;
    struct tri_lattice lattice;
    tri_triangle_id *triangle; /* [n] */
    int32_t n;
    struct extent *extent; /* [n_triangles] the rows and columns of each triangle, extended by two edges on each side */
    double doubt; /* in edges: if a distance is nearer than this to a limit, rounding decides */
};

/* Rows and columns of the lattice, as integers. */
struct box {
    double row[2], column[2];
};

enum verdict { OUT, IN, DOUBTFUL };

static struct extent extent_of(const struct tri_mesh *mesh, tri_triangle_id t, double more)
{
    struct extent e = {{HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL}};
    for (int k = 0; k < 3; k++) {
        const struct tri_point p = mesh->xy[mesh->tri[t].v[k]];
        e.low = (struct tri_point){fmin(e.low.x, p.x - more), fmin(e.low.y, p.y - more)};
        e.high = (struct tri_point){fmax(e.high.x, p.x + more), fmax(e.high.y, p.y + more)};
    }
    return e;
}

static struct tri_point lattice_point(const struct tri_lattice *lattice, double row, double column)
{
    const double shift = fmod(row, 2) != 0 ? 0.5 : 0;
    return (struct tri_point){(column + shift) * lattice->edge, row * lattice->rise};
}

/* The first and the last row and column of lattice points in the box around the triangles, and a few more on each
   side. */
static struct box box_around(const struct trial *trial)
{
    enum { MORE = 5 };
    struct box box = {{HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, -HUGE_VAL}};
    for (int32_t i = 0; i < trial->n; i++) {
        const struct extent e = extent_of(&trial->mesh, trial->triangle[i], 0);
        box.row[0] = fmin(box.row[0], floor(e.low.y / trial->lattice.rise) - MORE);
        box.row[1] = fmax(box.row[1], ceil(e.high.y / trial->lattice.rise) + MORE);
        box.column[0] = fmin(box.column[0], floor(e.low.x / trial->lattice.edge) - MORE);
        box.column[1] = fmax(box.column[1], ceil(e.high.x / trial->lattice.edge) + MORE);
    }
    return box;
}

static long double distance_to(struct tri_point p, struct tri_point a, struct tri_point b)
{
    const long double x = (long double)b.x - a.x, y = (long double)b.y - a.y;
    const long double u = (long double)p.x - a.x, v = (long double)p.y - a.y, l = x * x + y * y;
    const long double along = l > 0 ? fminl(1, fmaxl(0, (u * x + v * y) / l)) : 0;
    return hypotl(u - along * x, v - along * y);
}

/* Returns the distance of p from a triangle. 0 if p is inside. */
static long double distance_from(struct tri_point p, const struct tri_point corner[3])
{
    long double least = HUGE_VALL;
    bool inside = true;
    for (int k = 0; k < 3; k++) {
        inside = inside && tri_orient2d(corner[k], corner[(k + 1) % 3], p) >= 0;
        least = fminl(least, distance_to(p, corner[k], corner[(k + 1) % 3]));
    }
    return inside ? 0 : least;
}

/* In edges: is the distance less than a limit? */
static enum verdict is_nearer(const struct trial *trial, long double distance, double limit)
{
    const long double beyond = distance / trial->lattice.edge - limit;
    return fabsl(beyond) < trial->doubt ? DOUBTFUL : beyond < 0 ? IN : OUT;
}

static enum verdict either(enum verdict a, enum verdict b)
{
    return a == IN || b == IN ? IN : a == DOUBTFUL || b == DOUBTFUL ? DOUBTFUL : OUT;
}

/* Is the point in a triangle, or barely outside? */
static enum verdict is_inside(const struct trial *trial, struct tri_point p, const struct tri_point corner[3])
{
    const long double distance = distance_from(p, corner) / trial->lattice.edge;
    return distance <= 1e-12L ? IN : distance < 1.5e-6L + trial->doubt ? DOUBTFUL : OUT;
}

/* Must the point be rejected because a corner of the triangle or a subsegment beside it is near? *vertex: the corner at
   this point. */
static enum verdict is_too_close(const struct trial *trial, struct tri_point p, tri_triangle_id t,
                                 tri_vertex_id *vertex)
{
    const struct tri_triangle *tri = &trial->mesh.tri[t];
    enum verdict gone = OUT;
    for (int k = 0; k < 3; k++) {
        const struct tri_point a = trial->mesh.xy[tri->v[k]], b = trial->mesh.xy[tri->v[(k + 1) % 3]];
        if (a.x == p.x && a.y == p.y)
            *vertex = tri->v[k];
        else
            gone = either(gone, is_nearer(trial, distance_to(p, a, a), TRI_LATTICE_APART));
        if (tri->n[(k + 2) % 3] < 0 && tri->n[(k + 2) % 3] != TRI_BEYOND)
            gone = either(gone, is_nearer(trial, distance_to(p, a, b), TRI_LATTICE_OFF_WALLS));
    }
    return gone;
}

/* Classifies a lattice point. IN: the point is free or, if *vertex is set, occupied by that vertex. */
static enum verdict judge(const struct trial *trial, struct tri_point p, tri_vertex_id *vertex)
{
    enum verdict inside = OUT, gone = OUT;
    *vertex = TRI_NONE;
    for (int32_t i = 0; i < trial->n; i++) {
        const tri_triangle_id t = trial->triangle[i];
        const struct extent *extent = &trial->extent[t];
        struct tri_point corner[3];
        if (p.x < extent->low.x || p.x > extent->high.x || p.y < extent->low.y || p.y > extent->high.y)
            continue;
        for (int k = 0; k < 3; k++)
            corner[k] = trial->mesh.xy[trial->mesh.tri[t].v[k]];
        inside = either(inside, is_inside(trial, p, corner));
        gone = either(gone, is_too_close(trial, p, t, vertex));
    }
    return inside == OUT || gone == IN ? OUT : inside == IN && gone == OUT ? IN : DOUBTFUL;
}

/* The index of the site in a row and column of the lattice, as the header defines it. */
static int32_t site_in(const struct tri_sites *sites, double row, double column)
{
    const double r = row - sites->bottom, c = column - sites->left;
    if (r < 0 || r >= sites->n_rows || c < sites->row[(int32_t)r].first || c > sites->row[(int32_t)r].last)
        return TRI_NONE;
    return sites->row[(int32_t)r].base + (int32_t)c;
}

static bool is_listed(const struct trial *trial, tri_triangle_id t)
{
    for (int32_t i = 0; i < trial->n; i++)
        if (trial->triangle[i] == t)
            return true;
    return false;
}

/* The triangle of a site contains it or has its vertex as a corner. */
static void check_near(const struct trial *trial, const struct tri_sites *sites, int32_t site, struct tri_point p)
{
    const tri_triangle_id t = sites->near[site];
    const tri_vertex_id *v = trial->mesh.tri[t].v;
    assert_true(is_listed(trial, t));
    const struct tri_point corner[3] = {trial->mesh.xy[v[0]], trial->mesh.xy[v[1]], trial->mesh.xy[v[2]]};
    if (sites->at[site] >= 0)
        assert_true(v[0] == sites->at[site] || v[1] == sites->at[site] || v[2] == sites->at[site]);
    else
        assert_true(is_inside(trial, p, corner) != OUT);
}

static void check_margin(const struct tri_sites *sites, double row, double column)
{
    for (int j = -TRI_SITE_MARGIN; j <= TRI_SITE_MARGIN; j++)
        for (int i = -TRI_SITE_MARGIN; i <= TRI_SITE_MARGIN; i++)
            assert_true(site_in(sites, row + j, column + i) != TRI_NONE);
}

/* A query for a position returns the site exactly there. */
static void check_search(const struct tri_sites *sites, struct tri_point p, int32_t site)
{
    assert_int_equal(tri_site_of(sites, p), site);
    assert_int_equal(tri_site_of(sites, (struct tri_point){nextafter(p.x, HUGE_VAL), p.y}), TRI_NONE);
    assert_int_equal(tri_site_of(sites, (struct tri_point){p.x, nextafter(p.y, -HUGE_VAL)}), TRI_NONE);
    assert_int_equal(tri_site_of(sites, (struct tri_point){p.x + 0.5 * sites->lattice.edge, p.y}), TRI_NONE);
}

/* Counts the free lattice points and those with a vertex. */
struct count {
    int32_t free, vertices, sites;
};

static struct count compare_with(const struct trial *trial, const struct tri_sites *sites)
{
    const struct box box = box_around(trial);
    struct count count = {0, 0, 0};
    assert_true(fmod(sites->bottom, 2) == 0);
    for (double row = box.row[0]; row <= box.row[1]; row++)
        for (double column = box.column[0]; column <= box.column[1]; column++) {
            const struct tri_point p = lattice_point(&trial->lattice, row, column);
            const int32_t site = site_in(sites, row, column);
            tri_vertex_id vertex;
            const enum verdict verdict = judge(trial, p, &vertex);
            check_search(sites, p, site);
            const int32_t at = site == TRI_NONE ? TRI_SITE_OUT : sites->at[site];
            const int32_t expected = verdict == OUT ? TRI_SITE_OUT : vertex != TRI_NONE ? vertex : TRI_SITE_FREE;
            if (verdict != DOUBTFUL && at != expected)
                fail_msg("row %g, column %g: %d instead of %d", row, column, at, expected);
            if (at != TRI_SITE_OUT) {
                check_near(trial, sites, site, p);
                check_margin(sites, row, column);
            }
            count.free += at == TRI_SITE_FREE;
            count.vertices += at >= 0;
            count.sites += site != TRI_NONE;
        }
    assert_int_equal(count.sites, sites->n); /* no site lies outside the box */
    for (int32_t row = 0; row < sites->n_rows; row++)
        for (int32_t column = sites->row[row].first; column <= sites->row[row].last; column++) {
            const struct tri_point p = lattice_point(&trial->lattice, sites->bottom + row, sites->left + column);
            const struct tri_point place = tri_site_place(sites, row, column);
            assert_true(p.x == place.x && p.y == place.y);
            assert_int_equal(tri_site(sites, row, column), tri_site_of(sites, p));
        }
    return count;
}

/* Finds the sites and compares them. If there are more sites or rows than the limit allows, none are returned. */
static struct count check_sites(const struct trial *trial)
{
    struct tri_sites sites;
    assert_true(tri_sites_find(&sites, &trial->mesh, &trial->lattice, trial->triangle, trial->n, INT32_MAX / 4));
    const struct count count = compare_with(trial, &sites);
    const int32_t n = sites.n, n_rows = sites.n_rows;
    tri_sites_free(&sites);
    assert_true(n > 0);
    for (int32_t most = 0; most <= n; most += most == 0 && n > 1 ? n - 1 : 1) {
        assert_true(tri_sites_find(&sites, &trial->mesh, &trial->lattice, trial->triangle, trial->n, most));
        assert_true(sites.n == 0 || (sites.n == n && most >= n && most >= n_rows - 2 * TRI_SITE_MARGIN));
        tri_sites_free(&sites);
    }
    return count;
}

/* --- inputs */

/* A strip that rises to the right, much thinner than long. */
static struct tri_pslg thin_strip(void)
{
    static const double corner[4][2] = {{0, 0}, {3, 2}, {2.95, 2.0625}, {-0.05, 0.0625}};
    struct tri_pslg pslg = support_pslg(4, 4, 0, 0);
    for (int32_t i = 0; i < 4; i++)
        support_add_point(&pslg, corner[i][0], corner[i][1]);
    for (int32_t i = 0; i < 4; i++)
        support_add_segment(&pslg, i, (i + 1) % 4);
    return pslg;
}

enum figure { LETTER, SQUARE, STRIP, FIGURES };

static struct tri_pslg draw(enum figure figure)
{
    struct tri_pslg pslg;
    if (figure == LETTER)
        assert_true(support_read("letter.poly", &pslg));
    return figure == LETTER ? pslg : figure == SQUARE ? support_square(1, 60, 7) : thin_strip();
}

/* A triangulation of the figure, scaled, then moved. refined: with vertices on the lattice. */
static struct trial begin(enum figure figure, double scale, double move, bool refined)
{
    static const double edge[] = {0.3, 0.06, 0.025}; /* edge lengths of the lattice */
    struct trial trial = {0};
    struct tri_pslg pslg = draw(figure);
    for (int32_t i = 0; i < 2 * pslg.n_points; i++)
        pslg.points[i] = pslg.points[i] * scale + move;
    for (int32_t i = 0; i < 2 * pslg.n_holes; i++)
        pslg.holes[i] = pslg.holes[i] * scale + move;
    const double bound = scale * scale * 0.5 * ROW * edge[figure] * edge[figure] / TRI_LATTICE_SHARE;
    struct tri_options options = support_quality(refined ? 25 : 0, refined ? bound : 0);
    options.refine = refined;
    options.quality.lattice = refined;
    trial.mesh = support_generate(&pslg, &options, NULL);
    tri_pslg_free(&pslg);
    trial.lattice = tri_lattice_for(2 * (bound / trial.mesh.unit / trial.mesh.unit));
    assert_true(fabs(trial.lattice.edge * trial.mesh.unit / (edge[figure] * scale) - 1) < 1e-9);
    assert_true(fabs(trial.lattice.rise / trial.lattice.edge - ROW) < 1e-15);
    trial.triangle = calloc((size_t)trial.mesh.n_triangles, sizeof *trial.triangle);
    trial.n = trial.mesh.n_triangles;
    trial.extent = calloc((size_t)trial.mesh.n_triangles, sizeof *trial.extent);
    for (int32_t t = 0; t < trial.n; t++) {
        trial.triangle[t] = t;
        trial.extent[t] = extent_of(&trial.mesh, t, 2 * trial.lattice.edge);
    }
    trial.doubt = 1e-9 + 1e-15 * (move / scale + 10) / edge[figure];
    return trial;
}

static void end(struct trial *trial)
{
    free(trial->triangle);
    free(trial->extent);
    tri_mesh_free(&trial->mesh);
}

/* Keeps each triangle in the list with this probability, and shuffles the list. */
static void choose(struct trial *trial, double chance, uint64_t seed)
{
    struct support_random random = {seed};
    int32_t n = 0;
    for (int32_t i = 0; i < trial->n; i++)
        if (support_unit(&random) < chance) {
            const int32_t other = support_below(&random, n + 1);
            trial->triangle[n] = trial->triangle[other];
            trial->triangle[other] = trial->mesh.n_triangles - 1 - i;
            n++;
        }
    trial->n = n;
}

/* As in a part of a mesh: triangles that are not listed have undefined content. */
static void clear_unlisted(const struct trial *trial)
{
    for (int32_t i = 0; i < trial->n; i++)
        for (int e = 0; e < 3; e++) {
            tri_link *link = &trial->mesh.tri[trial->triangle[i]].n[e];
            if (*link >= 0 && !is_listed(trial, tri_of(*link)))
                *link = TRI_BEYOND;
        }
}

static void test_sites_in_all_triangles(void **state)
{
    (void)state;
    for (enum figure figure = 0; figure < FIGURES; figure++) {
        struct trial trial = begin(figure, 1, 0, false);
        const struct count count = check_sites(&trial);
        print_message("  %d: %d triangles, %d sites, %d free\n", (int)figure, trial.n, count.sites, count.free);
        assert_true(count.free > 100 && count.vertices == 0); /* corners lie on subsegments */
        end(&trial);
    }
}

static void test_sites_of_scaled_and_moved_figures(void **state)
{
    (void)state;
    static const double scales[] = {0x1p-40, 0x1p60, 4, 1}, moves[] = {0, 0, 1e6, -1e6};
    for (enum figure figure = 0; figure < FIGURES; figure++)
        for (int i = 0; i < 4; i++) {
            struct trial trial = begin(figure, scales[i], moves[i], false);
            assert_true(check_sites(&trial).free > 100);
            end(&trial);
        }
}

/* Vertices lie on sites. In the interior, every site has one. */
static void test_vertices_on_sites(void **state)
{
    (void)state;
    for (enum figure figure = 0; figure < FIGURES; figure++) {
        struct trial trial = begin(figure, 1, figure == LETTER ? 3 : 0, true);
        const struct count count = check_sites(&trial);
        print_message("  %d: %d triangles, %d sites, %d free, %d vertices\n", (int)figure, trial.n, count.sites,
                      count.free, count.vertices);
        assert_true(count.vertices > 10);
        end(&trial);
    }
}

static void test_sites_in_some_triangles(void **state)
{
    (void)state;
    for (enum figure figure = 0; figure < FIGURES; figure++)
        for (uint64_t seed = 0; seed < 6; seed++) {
            struct trial trial = begin(figure, 1, seed % 2 ? -2 : 0, seed >= 4);
            choose(&trial, seed % 2 ? 0.5 : 0.1, seed);
            if (seed % 3 == 0)
                clear_unlisted(&trial);
            if (trial.n > 0)
                check_sites(&trial);
            end(&trial);
        }
}

static void test_an_empty_list_has_no_sites(void **state)
{
    (void)state;
    struct tri_sites sites;
    struct trial trial = begin(SQUARE, 1, 0, false);
    assert_true(tri_sites_find(&sites, &trial.mesh, &trial.lattice, trial.triangle, 0, INT32_MAX / 4));
    assert_int_equal(sites.n, 0);
    tri_sites_free(&sites);
    end(&trial);
}

/* If rounding would move rows and columns, there are no sites. */
static void test_coarse_coordinates_have_no_sites(void **state)
{
    (void)state;
    for (int power = 30; power < 50; power++) {
        struct tri_sites sites;
        struct trial trial = begin(SQUARE, 1, ldexp(1, power), false);
        assert_true(tri_sites_find(&sites, &trial.mesh, &trial.lattice, trial.triangle, trial.n, INT32_MAX / 4));
        assert_int_equal(sites.n > 0, ldexp(1, power) / trial.lattice.rise < TRI_LATTICE_FARTHEST);
        tri_sites_free(&sites);
        end(&trial);
    }
}

static void test_lack_of_memory_is_reported(void **state)
{
    (void)state;
    struct trial trial = begin(SQUARE, 1, 0, false);
    bool found = false;
    int failures = 0;
    for (int k = 1; !found; k++) {
        struct tri_sites sites;
        const int64_t before = support_held;
        support_calls = 0;
        support_fail_at = k;
        found = tri_sites_find(&sites, &trial.mesh, &trial.lattice, trial.triangle, trial.n, INT32_MAX / 4);
        support_fail_at = INT64_MAX;
        assert_int_equal(found, support_calls < k);
        failures += !found;
        tri_sites_free(&sites);
        assert_int_equal(support_held, before);
    }
    assert_true(failures > 0);
    end(&trial);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sites_in_all_triangles),     cmocka_unit_test(test_sites_of_scaled_and_moved_figures),
        cmocka_unit_test(test_vertices_on_sites),          cmocka_unit_test(test_sites_in_some_triangles),
        cmocka_unit_test(test_an_empty_list_has_no_sites), cmocka_unit_test(test_coarse_coordinates_have_no_sites),
        cmocka_unit_test(test_lack_of_memory_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
