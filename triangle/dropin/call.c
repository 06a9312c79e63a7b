/* Runs the stages of triangulate() and reports messages. */
#include "triangle/dropin/call.h"

#include <stdio.h>

#include "triangle/base/system.h"
#include "triangle/dropin/io.h"

/* The client's size test for switch u; NULL if the linker finds none. On macOS no linked function may be missing. */
#ifdef __APPLE__
#define triunsuitable ((int (*)(REAL *, REAL *, REAL *, REAL))tri_find_function("triunsuitable"))
#else
extern __attribute__((weak)) int triunsuitable(REAL *origin, REAL *destination, REAL *apex, REAL area);
#endif

struct io_run {
    const struct tri_switches *switches; /* the parsed switches */
    const struct triangulate_options *options; /* the caller's options, not NULL */
    bool aloud;                                /* true: print messages on standard error */
    struct tri_io_input input;                 /* the converted input */
    struct tri_options how;                    /* options of the stages */
    struct tri_mesh mesh;                      /* the result */
    struct tri_report report;                  /* counts and notes of the stages */
    struct tri_error *error;                   /* description of a failure */
};

/* --- size test */

static int ask_options(void *user, const double a[2], const double b[2], const double c[2], double area)
{
    const struct triangulate_options *options = user;
    const REAL corners[3][2] = {{(REAL)a[0], (REAL)a[1]}, {(REAL)b[0], (REAL)b[1]}, {(REAL)c[0], (REAL)c[1]}};
    return options->unsuitable(options->unsuitable_user, corners[0], corners[1], corners[2], (REAL)area);
}

static int ask_client(void *user, const double a[2], const double b[2], const double c[2], double area)
{
    REAL corners[3][2] = {{(REAL)a[0], (REAL)a[1]}, {(REAL)b[0], (REAL)b[1]}, {(REAL)c[0], (REAL)c[1]}};
    (void)user;
    return triunsuitable(corners[0], corners[1], corners[2], (REAL)area);
}

static enum tri_status add_size_test(struct io_run *run)
{
    struct tri_quality *quality = &run->how.quality;
    if (!run->switches->user_test)
        return TRI_OK;
    if (!run->options->unsuitable && !triunsuitable)
        return tri_fail(run->error, TRI_BAD_INPUT, NULL, 0,
                        "switch u: there is no size test, neither in the options nor as triunsuitable");
    quality->unsuitable = run->options->unsuitable ? ask_options : ask_client;
    quality->unsuitable_user = (void *)run->options; /* it is only read */
    return TRI_OK;
}

/* --- stop */

static bool is_stopped(void *user)
{
    const struct triangulate_options *options = user;
    return options->stop(options->stop_user) != 0;
}

/* --- messages */

/* Reports errors, and remarks on probable mistakes in the input. With Q, remarks are not printed on standard error. */
static void message_client(const struct io_run *run, bool is_error, const char *text)
{
    if (run->options->message)
        run->options->message(run->options->message_user, is_error, text);
    if (run->aloud && (is_error || !run->switches->quiet))
        tri_io_print(text);
}

static void warn_client(const struct io_run *run, const char *text)
{
    if (run->options->message && !run->switches->quiet)
        run->options->message(run->options->message_user, 0, text);
}

static void tell_notes(const struct io_run *run)
{
    const struct tri_notes *notes = &run->report.notes;
    if (notes->skipped[0] && !run->switches->quiet)
        message_client(run, false, notes->skipped);
    if (notes->empty[0])
        message_client(run, false, notes->empty);
}

static void warn_number(const struct io_run *run, int n, const char *one, const char *several)
{
    char text[160];
    if (n <= 0)
        return;
    snprintf(text, sizeof text, "%d %s", n, n == 1 ? one : several);
    warn_client(run, text);
}

static void warn_of_switch(void *user, const char *text, bool misread)
{
    if (misread)
        message_client(user, false, text);
    else
        warn_client(user, text);
}

static void warn_of_input(const struct io_run *run)
{
    const struct tri_report *report = &run->report;
    warn_number(run, report->loose,
                "segment is not an edge of the mesh: it is copied to the output, but the mesh may not contain it",
                "segments are not edges of the mesh: they are copied to the output, but the mesh may not contain them");
    warn_number(run, report->duplicates, "point coincides with a point of lower number and is not used",
                "points coincide with points of lower number and are not used");
    tell_notes(run);
    warn_number(run, report->carve.between, "hole point lies on a segment and has no effect",
                "hole points lie on segments and have no effect");
    if (report->quality.hit_limit && run->how.quality.conforming)
        warn_client(run, "the limit of S was reached before the mesh was conforming");
}

/* --- stages */

static enum tri_status run_stages(struct io_run *run, const struct triangulateio *in)
{
    enum tri_status status = add_size_test(run);
    status = status ? status : tri_io_input_make(&run->input, in, run->switches, run->error);
    if (!status && tri_pslg_is_one_place(&run->input.pslg))
        status = tri_fail(run->error, TRI_BAD_INPUT, NULL, 0, "all points are at the same place");
    if (status)
        return status;
    run->how.elements = run->switches->mesh ? &run->input.elements : NULL;
    run->how.is_edge = run->input.is_edge;
    run->how.base = !run->switches->from_zero;
    status = tri_generate(&run->mesh, &run->input.pslg, &run->how, &run->report, run->error);
    if (status)
        return status;
    tri_switches_warn(run->switches, warn_of_switch, run);
    warn_of_input(run);
    return TRI_OK;
}

static enum tri_status run_all(struct io_run *run, const struct triangulateio *in, struct triangulateio *out,
                               struct triangulateio *vorout)
{
    enum tri_status status = tri_switches_check(run->switches, run->error);
    status = status ? status : run_stages(run, in);
    if (!status)
        status = tri_io_output(&run->mesh, &run->input, run->switches, in, out, vorout, run->error);
    tri_io_input_free(&run->input);
    tri_mesh_free(&run->mesh);
    return status;
}

/* Sets all counts to 0, for clients that do not check the status. */
static void zero_counts(struct triangulateio *io)
{
    io->numberofpoints = io->numberofpointattributes = io->numberofedges = 0;
    io->numberoftriangles = io->numberofcorners = io->numberoftriangleattributes = 0;
    io->numberofsegments = io->numberofholes = io->numberofregions = 0;
}

int tri_io_triangulate(const char *switches, const struct triangulateio *in, struct triangulateio *out,
                       struct triangulateio *vorout, const struct triangulate_options *options, bool aloud,
                       tri_refine_call *refine, const struct tri_executor *executor)
{
    static const struct triangulate_options none;
    struct tri_error error = {0};
    struct tri_switches s = tri_switches_none();
    enum tri_status status;
    options = options ? options : &none;
    tri_switches_add(&s, switches ? switches : "");
    const bool no_diagram = s.voronoi && !vorout;
    s.voronoi = s.voronoi && vorout;
    s.placement = options->classic ? TRI_PLACEMENT_CLASSIC : s.placement;
    struct io_run run = {.switches = &s, .options = options, .aloud = aloud, .how = tri_switches_options(&s),
                         .error = &error};
    const struct tri_stop stop = {is_stopped, (void *)options}; /* it is only read */
    run.how.executor = executor;
    run.how.refine_call = refine;
    run.how.refine_user = (void *)options; /* it is only read */
    run.how.stop = options->stop ? &stop : NULL;
    if (switches && in && out)
        status = run_all(&run, in, out, vorout);
    else
        status = tri_fail(&error, TRI_BAD_INPUT, NULL, 0, "switches, in and out must not be NULL");
    if (status && out && out != in)
        zero_counts(out);
    if (status && vorout && vorout != in)
        zero_counts(vorout);
    if (status)
        message_client(&run, true, error.text);
    else if (no_diagram)
        message_client(&run, false, "switch v: vorout is NULL, so there is no Voronoi diagram");
    return (int)status;
}
