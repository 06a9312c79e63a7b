/* Handlers and the program share one word, the state, and the names of the temporary files. The state says who has
 * requested the end, whether the grace period is over (LATE), and whether the program is changing the set of files or
 * reporting its end (HELD). It also says whether the program must end after that (DUE), and whether a thread is ending
 * it (ENDING). Every transition is one compare-and-exchange of the word:
 *
 *     no request          -- first request -->          asked; the grace begins
 *     asked               -- grace is over -->          LATE; patience begins, if there is any
 *     LATE, HELD          -- a request or the clock --> DUE; the handler returns
 *     LATE, not HELD      -- a request or the clock --> ENDING, by the handler
 *     HELD                -- the set is changed -->     not HELD, or, if DUE, ENDING, by the program
 *     HELD                -- all have their names -->   DONE: from then on no request ends the program
 *
 * INVARIANT: while the state is not HELD, all temporary files are listed in `temporaries`. A handler never waits
 * (docs/theory.md, the end by a signal). It calls and reads only what C and triangle/base/system.h allow in a
 * handler. */
#include "drivers/interrupt.h"

#include <limits.h>
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>

#include "triangle/base/system.h"

_Static_assert(ATOMIC_INT_LOCK_FREE == 2 && ATOMIC_LONG_LOCK_FREE == 2 && ATOMIC_POINTER_LOCK_FREE == 2,
               "handlers need lock-free atomics");

static const double GRACE = 0.8;

enum {
    HELD = 1,
    ENDING = 2,
    LATE = 4,      /* a further request ends the program at once */
    DUE = 8,
    GOING_ON = 16, /* the remaining work is done in spite of a request */
    TOLD = 32,     /* the program has reported why it ends */
    DONE = 64,     /* all files have their names: the program ends by itself, with success */
    WHO = 256      /* the state is the sum of these bits and WHO times the request */
};
enum { NOBODY = 0, TIME_UP = 255 }; /* values of the request; all others are numbers of signals */

static atomic_uint state;
static _Atomic(const char *) stage, reached_what;
static atomic_long reached;
static atomic_long kept; /* number of triangles in a checkpoint */
static _Atomic(const char *) go_on; /* command that resumes the run; NULL: there is no checkpoint */
static _Atomic(const char *) temporaries[TRI_MAX_OUTPUTS];
static const char *name; /* set before the first handler can run */
static double patience; /* seconds after the grace period until the handler ends the program */
static bool has_alarm;

/* --- in handlers */

/* Sets bits, unless one of `against` is set. Returns the previous state. */
static unsigned set_unless(unsigned bits, unsigned against)
{
    unsigned before = atomic_load(&state);
    while (!(before & against) && !atomic_compare_exchange_weak(&state, &before, before | bits))
        ;
    return before;
}

static unsigned who_asked(void) { return atomic_load(&state) / WHO; }

/* Makes this thread the only one that ends the program. */
static bool take_for_good(void) { return !(set_unless(ENDING, HELD | ENDING) & (HELD | ENDING)); }

static void remove_temporaries(void)
{
    for (int i = 0; i < TRI_MAX_OUTPUTS; i++) {
        const char *path = atomic_load(&temporaries[i]);
        if (path)
            (void)tri_path_remove(path);
    }
}

const char *interrupt_cause(void)
{
    const int number = (int)who_asked();
    const char *of_system = tri_interrupt_name(number);
    return of_system ? of_system : number == NOBODY ? "another task" : "the time limit";
}

int interrupt_code(void)
{
    int number = (int)who_asked();
    return number == NOBODY ? 0 : number == TIME_UP ? INTERRUPT_TIME_UP : 128 + number;
}

static void say_number(long n)
{
    char digits[3 * sizeof n + 1], *first = digits + sizeof digits - 1;
    *first = '\0';
    do
        *--first = (char)('0' + n % 10);
    while ((n /= 10) > 0);
    tri_print_unbuffered(first);
}

const char *interrupt_written(void)
{
    if (!atomic_load(&go_on))
        return "nothing was written";
    return atomic_load(&kept) > 0 ? "no file was written" : "nothing was written, and nothing is kept";
}

void interrupt_print_kept(void)
{
    const long n = atomic_load(&kept);
    if (n == 0)
        return;
    tri_print_unbuffered(name);
    tri_print_unbuffered(": ");
    say_number(n);
    tri_print_unbuffered(" triangles are kept; to go on: ");
    tri_print_unbuffered(atomic_load(&go_on));
    tri_print_unbuffered("\n");
}

static void print_end(void)
{
    tri_print_unbuffered(name);
    tri_print_unbuffered(": stopped by ");
    tri_print_unbuffered(interrupt_cause());
    tri_print_unbuffered(" while ");
    tri_print_unbuffered(interrupt_stage_now());
    const long n = atomic_load(&reached);
    if (n > 0) {
        tri_print_unbuffered(": about ");
        say_number(n);
        tri_print_unbuffered(atomic_load(&reached_what));
    }
    tri_print_unbuffered("; ");
    tri_print_unbuffered(interrupt_written());
    tri_print_unbuffered("\n");
    interrupt_print_kept();
}

/* Removes the files and ends the program, after the change to ENDING. */
static void end_now(void)
{
    remove_temporaries();
    if (!(atomic_load(&state) & TOLD))
        print_end();
    _Exit(interrupt_code());
}

/* Ends the program, or lets the main thread end it. */
static void end_when_free(void)
{
    unsigned before = atomic_load(&state), after;
    do
        after = before | (before & DONE ? 0 : before & HELD ? DUE : ENDING);
    while (!atomic_compare_exchange_weak(&state, &before, after));
    if (!(before & (HELD | ENDING | DONE)))
        end_now();
}

static void arm(double seconds)
{
    if (has_alarm)
        tri_alarm(seconds);
    else
        set_unless(LATE, 0); /* a second signal ends the program in any case */
}

/* Records the first request and starts the grace period. */
static void request_end(unsigned who)
{
    unsigned before = set_unless(who * WHO, ~0u / WHO * WHO);
    if (before / WHO == NOBODY)
        arm(GRACE);
    else if (before & LATE)
        end_when_free();
}

/* Handles our timer: the end of the limit, of the grace period, or of the patience. */
static void time_is_up(void)
{
    if (who_asked() == NOBODY)
        request_end(TIME_UP);
    else if (patience == 0 || (set_unless(LATE, 0) & LATE))
        end_when_free();
    else if (patience < HUGE_VAL)
        arm(patience);
}

static void handle(int number) { request_end((unsigned)number); }

static void remove_at_crash(void)
{
    if (take_for_good())
        remove_temporaries();
}

/* --- in the program */

static void hold(void)
{
    while (set_unless(HELD, ENDING) & ENDING)
        (void)tri_pause(1); /* another thread's handler is ending the program */
}

static bool is_due(unsigned now) { return (now & (DUE | DONE)) == DUE; }

static void release(void)
{
    unsigned before = atomic_load(&state), after;
    do
        after = (before & ~(unsigned)HELD) | (is_due(before) ? ENDING : 0);
    while (!atomic_compare_exchange_weak(&state, &before, after));
    if (is_due(before))
        end_now();
}

/* Publishes the names of temporary files for the handlers, while the state is HELD. */
static void publish_names(const struct tri_output_set *set)
{
    for (int i = 0; i < TRI_MAX_OUTPUTS; i++)
        atomic_store(&temporaries[i], i < set->n ? set->outputs[i].temporary : NULL);
}

bool interrupt_start(const char *program, double seconds, double patient)
{
    static const struct tri_interrupts handlers = {handle, time_is_up, remove_at_crash};
    name = program;
    patience = fmax(patient - GRACE, 0);
    has_alarm = tri_interrupts_catch(&handlers);
    if (atexit(remove_at_crash) != 0 || (seconds > 0 && !has_alarm)) /* some libraries call exit, such as OpenMP */
        return false;
    if (seconds > 0)
        arm(seconds);
    return true;
}

/* --- other tasks */

static int (*pass_on)(void *user, int who);
static void *pass_on_user;
static _Thread_local bool may_pass_on;

void interrupt_pass_on(int (*function)(void *user, int who), void *user)
{
    pass_on = function;
    pass_on_user = user;
    may_pass_on = function != NULL;
}

/* Passes requests between the tasks. It uses the network, so it does so at most every 5 ms. */
static void exchange_requests(void)
{
    static const double PAUSE = 0.005;
    static double next;
    const double now = tri_seconds();
    if (now < next)
        return;
    next = now + PAUSE;
    const int who = pass_on(pass_on_user, (int)who_asked());
    if (who != NOBODY && who_asked() == NOBODY) /* otherwise it is our own request, which has come back */
        request_end((unsigned)who);
}

static bool is_asked(void *user)
{
    (void)user;
    if (may_pass_on)
        exchange_requests();
    const unsigned now = atomic_load_explicit(&state, memory_order_relaxed);
    return now / WHO != NOBODY && !(now & GOING_ON);
}

const struct tri_stop *interrupt_stop(void)
{
    static const struct tri_stop stop = {is_asked, NULL};
    return &stop;
}

static bool is_end_due(void *user)
{
    (void)user;
    return is_due(atomic_load(&state));
}

const struct tri_stop *interrupt_end(void)
{
    static const struct tri_stop end = {is_end_due, NULL};
    return &end;
}

void interrupt_stage(const char *what)
{
    atomic_store(&reached, 0);
    atomic_store(&stage, what);
}

void interrupt_reached(int64_t n, const char *what)
{
    if (n <= atomic_load(&reached))
        return;
    atomic_store(&reached_what, what);
    atomic_store(&reached, n < LONG_MAX ? (long)n : LONG_MAX);
}

int64_t interrupt_reached_now(const char **what)
{
    *what = atomic_load(&reached_what);
    return atomic_load(&reached);
}

const char *interrupt_stage_now(void)
{
    const char *what = atomic_load(&stage);
    return what ? what : "starting";
}

void interrupt_kept(int64_t triangles, const char *command)
{
    atomic_store(&kept, triangles < LONG_MAX ? (long)triangles : LONG_MAX);
    atomic_store(&go_on, command);
}

void interrupt_time_up(void)
{
    if (who_asked() == NOBODY)
        request_end(TIME_UP);
}

void interrupt_tell(void) { hold(); }

void interrupt_told(void)
{
    set_unless(TOLD, 0);
    release();
}

void interrupt_go_on(void) { set_unless(GOING_ON, 0); }

void interrupt_begin(struct tri_output_set *set)
{
    hold();
    tri_outputs_begin(set);
    set->stop = interrupt_stop();
    publish_names(set);
    release();
}

enum tri_status interrupt_open(struct tri_output_set *set, const char *path, struct tri_output **output,
                               struct tri_error *error)
{
    hold();
    enum tri_status status = tri_output_open(set, path, output, error);
    publish_names(set);
    release();
    return status;
}

enum tri_status interrupt_commit(struct tri_output_set *set, bool sync, struct tri_error *error)
{
    enum tri_status status = sync ? tri_outputs_sync(set, error) : TRI_OK; /* handlers do not wait for a slow disk */
    hold();
    status = status ? status : tri_outputs_commit(set, error);
    tri_outputs_abort(set);
    publish_names(set);
    if (!status)
        set_unless(DONE, 0);
    release();
    return status;
}

void interrupt_drop(struct tri_output_set *set)
{
    hold();
    tri_outputs_abort(set);
    publish_names(set);
    release();
}
