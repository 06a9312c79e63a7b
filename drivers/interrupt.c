/* Handlers and the program share atomic words, and one lock around the set of temporary files.
 *
 * THE LOCK is free, held by the program while it changes the set, or taken for good by whoever ends the program. A
 * handler never waits for it: where the program holds it, the handler leaves a note (`must_end`) and returns, and the
 * program ends itself when it lets go. Either the handler's second try for the lock comes after the release and
 * succeeds, or the note was there when the program looked for it behind the release: so no request is lost. Handlers
 * may run on any thread.
 *
 * INVARIANT: while the lock is free, every temporary file there is stands in the set.
 *
 * A handler calls write(), unlink(), timer_settime(), signal(), raise() and _exit(), which POSIX allows, and reads and
 * writes lock-free atomics, which C allows. */
#include "drivers/interrupt.h"

#include <errno.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

_Static_assert(ATOMIC_INT_LOCK_FREE == 2 && ATOMIC_POINTER_LOCK_FREE == 2, "handlers need lock-free atomics");

static const struct timespec GRACE = {0, 800000000};

enum { FREE, HELD, ENDING };  /* the lock */
enum { NOBODY = 0, TIME_UP = -1 }; /* who asked for the end, else the number of a signal */

static atomic_int lock, asked, must_end, late, going_on, told;
static _Atomic(const char *) stage;
static const char *name; /* these are set before the first handler can run */
static bool patience, has_timer;
static timer_t timer;
static const struct tri_output_set *guarded; /* under the lock */

static const struct kind {
    int number;
    const char *name;
} ends[] = {
    {SIGHUP, "SIGHUP"},   {SIGINT, "SIGINT"},   {SIGQUIT, "SIGQUIT"}, {SIGTERM, "SIGTERM"},
    {SIGALRM, "SIGALRM"}, {SIGUSR1, "SIGUSR1"}, {SIGUSR2, "SIGUSR2"}, {SIGXCPU, "SIGXCPU"},
    {SIGVTALRM, "SIGVTALRM"}, {SIGPROF, "SIGPROF"},
};
static const int crashes[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS};

enum { N_ENDS = sizeof ends / sizeof *ends, N_CRASHES = sizeof crashes / sizeof *crashes };

/* --- what a handler does */

static bool take_for_good(void)
{
    int expected = FREE;
    return atomic_compare_exchange_strong(&lock, &expected, ENDING);
}

static void remove_temporaries(void)
{
    for (int i = 0; guarded && i < guarded->n; i++)
        if (guarded->outputs[i].temporary)
            unlink(guarded->outputs[i].temporary);
}

static void say(const char *text) { (void)!write(STDERR_FILENO, text, strlen(text)); }

const char *interrupt_cause(void)
{
    int number = atomic_load(&asked);
    for (int i = 0; i < N_ENDS; i++)
        if (ends[i].number == number)
            return ends[i].name;
    return "the time limit";
}

int interrupt_code(void)
{
    int number = atomic_load(&asked);
    return number == NOBODY ? 0 : number == TIME_UP ? INTERRUPT_TIME_UP : 128 + number;
}

static void tell(void)
{
    say(name);
    say(": stopped by ");
    say(interrupt_cause());
    say(" while ");
    say(interrupt_stage_now());
    say("; nothing was written\n");
}

/* With the lock taken for good. */
static void end_now(void)
{
    remove_temporaries();
    if (!atomic_load(&told))
        tell();
    _exit(interrupt_code());
}

static void try_to_end(void)
{
    atomic_store(&must_end, 1);
    if (take_for_good())
        end_now();
}

static void arm(struct timespec delay)
{
    struct itimerspec once = {{0, 0}, delay};
    if (has_timer)
        timer_settime(timer, 0, &once, NULL);
    else
        atomic_store(&late, 1); /* a second signal ends the program in any case */
}

/* The first to ask gives the program its time to end. */
static void ask(int who)
{
    int nobody = NOBODY;
    if (atomic_compare_exchange_strong(&asked, &nobody, who))
        arm(GRACE);
    else if (atomic_load(&late))
        try_to_end();
}

/* Our own timer: the limit, or the end of the grace. */
static void time_is_up(void)
{
    if (atomic_load(&asked) == NOBODY) {
        ask(TIME_UP);
        return;
    }
    atomic_store(&late, 1);
    if (!patience)
        try_to_end();
}

static void handle(int number, siginfo_t *info, void *context)
{
    int reason = errno;
    (void)context;
    if (number == SIGALRM && info->si_code == SI_TIMER)
        time_is_up();
    else
        ask(number);
    errno = reason;
}

static void crash(int number)
{
    if (take_for_good())
        remove_temporaries();
    signal(number, SIG_DFL);
    raise(number);
}

/* --- what the program does */

static void hold(void)
{
    int expected = FREE;
    while (!atomic_compare_exchange_strong(&lock, &expected, HELD)) {
        pause(); /* another thread's handler is ending the program */
        expected = FREE;
    }
}

static void release(void)
{
    atomic_store(&lock, FREE);
    if (atomic_load(&must_end) && take_for_good())
        end_now();
}

/* Some library calls exit: OpenMP's, where it gets no memory. */
static void at_exit(void)
{
    if (take_for_good())
        remove_temporaries();
}

static void catch_end(int number)
{
    struct sigaction action = {.sa_sigaction = handle, .sa_flags = SA_SIGINFO}, old;
    sigfillset(&action.sa_mask);
    if (sigaction(number, NULL, &old) == 0 && (number == SIGALRM || old.sa_handler != SIG_IGN))
        sigaction(number, &action, NULL); /* no SA_RESTART: opening a pipe that nobody reads must end */
}

/* Handlers of others, such as those of sanitizers, stay. */
static void catch_crash(int number)
{
    struct sigaction action = {.sa_handler = crash}, old;
    sigfillset(&action.sa_mask);
    if (sigaction(number, NULL, &old) == 0 && !(old.sa_flags & SA_SIGINFO) && old.sa_handler == SIG_DFL)
        sigaction(number, &action, NULL);
}

static struct timespec after(double seconds)
{
    struct timespec time = {(time_t)seconds, 0};
    time.tv_nsec = (long)(1e9 * (seconds - (double)time.tv_sec));
    return time;
}

bool interrupt_start(const char *program, double seconds, bool patient)
{
    sigset_t alarm;
    name = program;
    patience = patient;
    has_timer = timer_create(CLOCK_MONOTONIC, NULL, &timer) == 0; /* sends SIGALRM */
    signal(SIGXFSZ, SIG_IGN);
    signal(SIGPIPE, SIG_IGN);
    for (int i = 0; i < N_ENDS; i++)
        catch_end(ends[i].number);
    for (int i = 0; i < N_CRASHES; i++)
        catch_crash(crashes[i]);
    sigemptyset(&alarm);
    sigaddset(&alarm, SIGALRM);
    sigprocmask(SIG_UNBLOCK, &alarm, NULL); /* a caller's mask is inherited */
    if (atexit(at_exit) != 0 || (seconds > 0 && !has_timer))
        return false;
    if (seconds > 0)
        arm(after(seconds));
    return true;
}

static bool is_asked(void *user)
{
    (void)user;
    return atomic_load_explicit(&asked, memory_order_relaxed) != NOBODY &&
           !atomic_load_explicit(&going_on, memory_order_relaxed);
}

const struct tri_stop *interrupt_stop(void)
{
    static const struct tri_stop stop = {is_asked, NULL};
    return &stop;
}

void interrupt_stage(const char *what) { atomic_store(&stage, what); }

const char *interrupt_stage_now(void)
{
    const char *what = atomic_load(&stage);
    return what ? what : "starting";
}

void interrupt_told(void) { atomic_store(&told, 1); }

void interrupt_go_on(void) { atomic_store(&going_on, 1); }

void interrupt_begin(struct tri_output_set *set)
{
    hold();
    tri_outputs_begin(set);
    set->stop = interrupt_stop();
    guarded = set;
    release();
}

enum tri_status interrupt_open(struct tri_output_set *set, const char *path, struct tri_output **output,
                               struct tri_error *error)
{
    hold();
    enum tri_status status = tri_output_open(set, path, output, error);
    release();
    return status;
}

enum tri_status interrupt_commit(struct tri_output_set *set, struct tri_error *error)
{
    hold();
    enum tri_status status = tri_outputs_commit(set, error);
    release();
    return status;
}

void interrupt_drop(struct tri_output_set *set)
{
    hold();
    tri_outputs_abort(set);
    release();
}
