#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier): pipe2, close_range
#include "run/partner.h"

#include "run/cli.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <poll.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum {
    PIECE = 1 << 16, /* bytes read at a time: what a pipe holds */
    NAP = 10,        /* ms between looks whether it has ended */
    LOOK = 100       /* ms between looks whether a signal has come, which poll() may miss */
};

/* s: in which a program may end by itself at the end of its input: when its run has failed, and when it was stopped */
static const double GRACE = 0.2, LAST_WORK = 1;

struct partner {
    pid_t pid, guard;
    int life;                          /* the guard's end of it hangs up when this process ends */
    int to, from;                      /* pipes */
    const volatile sig_atomic_t *stop; /* other than 0: nothing is waited for */
    char *text;                        /* what it has said */
    size_t n, room;                    /* bytes of it */
    size_t taken;                      /* of them those that were given */
    double seconds;                    /* that an answer may take, */
    double left;                       /* and of them those that are left */
};

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int partner_failed(struct failure *failure, const char *what)
{
    return failure_set(failure, EX_UNAVAILABLE, "%s: %s", what, strerror(errno));
}

/* The program: a group of processes of its own, so that a signal from the terminal is for us, who end it */
static void be_program(int in, int out, const char *command)
{
    setpgid(0, 0);
    signal(SIGPIPE, SIG_DFL);
    if (dup2(in, STDIN_FILENO) < 0 || dup2(out, STDOUT_FILENO) < 0) _exit(126);
    execl("/bin/sh", "sh", "-c", command, (char *)NULL);
    _exit(127);
}

/* A process that waits for the end of this one, however it ends, and then kills the program's group. It has no other
   file open: nobody waits for it. */
static void be_guard(int life, pid_t group)
{
    char none;
    setpgid(0, 0);
    if (dup2(life, STDIN_FILENO) < 0) _exit(126);
    close_range(STDIN_FILENO + 1, UINT_MAX, 0);
    while (read(STDIN_FILENO, &none, 1) < 0 && errno == EINTR) continue;
    usleep((useconds_t)(1e6 * GRACE));
    kill(-group, SIGKILL);
    _exit(0);
}

static int start_guard(struct partner *p, struct failure *failure)
{
    int life[2];
    if (pipe2(life, O_CLOEXEC)) return partner_failed(failure, "no pipe to the program's guard");
    p->guard = fork();
    if (p->guard == 0) close(life[1]), be_guard(life[0], p->pid);
    close(life[0]), p->life = life[1];
    return p->guard < 0 ? partner_failed(failure, "the program's guard cannot be started") : 0;
}

int partner_start(struct partner **out, const char *command, const volatile sig_atomic_t *stop,
                  struct failure *failure)
{
    int to[2], from[2];
    struct partner *p = *out = calloc(1, sizeof *p);
    if (!p) return failure_set(failure, EX_SOFTWARE, "no memory for a program");
    p->to = p->from = p->life = -1, p->stop = stop;
    if (pipe2(to, O_CLOEXEC)) return partner_failed(failure, "no pipe to the program");
    p->to = to[1];
    if (pipe2(from, O_CLOEXEC))
        return close(to[0]), partner_failed(failure, "no pipe from the program");
    p->from = from[0];
    p->pid = fork();
    if (p->pid == 0) be_program(to[0], from[1], command);
    close(to[0]), close(from[1]);
    if (p->pid < 0) return partner_failed(failure, "the program cannot be started");
    setpgid(p->pid, p->pid); // whoever of both comes first
    fcntl(p->to, F_SETFL, O_NONBLOCK), fcntl(p->from, F_SETFL, O_NONBLOCK);
    return start_guard(p, failure);
}

/* Takes the time since *then off *left, but for a time in which this process was stopped: then the program may have been, too. */
static void spend(double *left, double *then)
{
    const double before = *then;
    *then = now();
    *left -= fmin(*then - before, 2e-3 * LOOK);
}

/* Waits until something can be read or written; false: too long, or a signal has come. */
static bool ready(const struct partner *p, int fd, short what, double *left)
{
    struct pollfd f = { .fd = fd, .events = what };
    for (double then = now(); !*p->stop && *left > 0; spend(left, &then))
        if (poll(&f, 1, (int)fmin(1e3 * *left + 1, LOOK)) > 0) return spend(left, &then), true;
    return false;
}

/* write(), but for SIGPIPE where nobody reads */
static ssize_t write_quietly(int fd, const char *bytes, size_t n)
{
    sigset_t pipe, was;
    const struct timespec at_once = { 0, 0 };
    sigemptyset(&pipe), sigaddset(&pipe, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &pipe, &was);
    ssize_t done = write(fd, bytes, n);
    int trouble = errno;
    if (done < 0 && trouble == EPIPE)
        while (sigtimedwait(&pipe, NULL, &at_once) < 0 && errno == EINTR) continue;
    pthread_sigmask(SIG_SETMASK, &was, NULL);
    errno = trouble;
    return done;
}

/* Waits up to so many seconds for its end; false: it lives on. */
static bool has_ended(struct partner *p, int *status, double seconds)
{
    for (const double end = now() + seconds; !waitpid(p->pid, status, WNOHANG);
         usleep(1000 * NAP)) {
        if (now() > end) return false;
    }
    p->pid = 0;
    return true;
}

/* A pipe is closed, so that it ends now, or lives on without: how it has ended */
static int ended(struct partner *p, const char *pipe, struct failure *failure)
{
    int status = 0;
    const char *where = p->n > p->taken ? ", within an answer" : "";
    if (!has_ended(p, &status, 1))
        return failure_set(failure, EX_UNAVAILABLE, "the program has closed its %s%s", pipe, where);
    if (WIFSIGNALED(status))
        return failure_set(failure, EX_UNAVAILABLE, "the program was killed: %s%s",
                           strsignal(WTERMSIG(status)), where);
    return failure_set(failure, EX_UNAVAILABLE, "the program has ended, with status %d%s",
                       WEXITSTATUS(status), where);
}

/* Nothing could be written or read: why */
static int waited(const struct partner *p, const char *what, double seconds,
                  struct failure *failure)
{
    if (*p->stop) return failure_set(failure, EX_UNAVAILABLE, "a signal has come");
    return failure_set(failure, EX_UNAVAILABLE, "the program has %s for %g s (--with-timeout)",
                       what, seconds);
}

int partner_write(struct partner *p, const void *bytes, size_t n, double seconds,
                  struct failure *failure)
{
    double left = seconds;
    const char *at = bytes;
    while (n > 0) {
        ssize_t done = write_quietly(p->to, at, n);
        if (done > 0) at += done, n -= (size_t)done;
        if (done >= 0 || errno == EINTR) continue;
        if (errno == EPIPE) return ended(p, "input", failure);
        if (errno != EAGAIN) return partner_failed(failure, "the program");
        if (!ready(p, p->to, POLLOUT, &left)) return waited(p, "read nothing", seconds, failure);
    }
    return 0;
}

/* Room for one more piece */
static bool partner_grow(struct partner *p)
{
    if (p->room - p->n > PIECE) return true;
    size_t room = p->room + p->room / 2 + 4 * PIECE;
    char *more = realloc(p->text, room);
    if (!more) return false;
    p->text = more, p->room = room;
    return true;
}

void partner_expect(struct partner *p, double seconds)
{
    p->seconds = p->left = seconds;
}

/* What was given leaves the memory. */
static void partner_forget(struct partner *p)
{
    if (p->taken) memmove(p->text, p->text + p->taken, p->n - p->taken);
    p->n -= p->taken, p->taken = 0;
}

/* Reads what there is; got: bytes, 0 at the end, -1 where there is nothing yet */
static int read_piece(struct partner *p, ssize_t *got, struct failure *failure)
{
    if (!partner_grow(p)) return failure_set(failure, EX_SOFTWARE, "no memory for an answer");
    do *got = read(p->from, p->text + p->n, PIECE);
    while (*got < 0 && errno == EINTR);
    if (*got < 0 && errno != EAGAIN) return partner_failed(failure, "the program");
    if (*got > 0) p->n += (size_t)*got;
    return 0;
}

/* The same, or waits for it. */
static int read_more(struct partner *p, struct failure *failure)
{
    ssize_t got;
    if (*p->stop) return waited(p, "not answered", p->seconds, failure);
    if (read_piece(p, &got, failure)) return failure->status;
    if (got == 0) return ended(p, "output", failure);
    if (got < 0 && !ready(p, p->from, POLLIN, &p->left))
        return waited(p, "not answered", p->seconds, failure);
    return 0;
}

int partner_check_silent(struct partner *p, struct failure *failure)
{
    ssize_t got = 0;
    partner_forget(p);
    if (!p->n && read_piece(p, &got, failure)) return failure->status;
    if (!p->n) return 0;
    return failure_set(
        failure, EX_UNAVAILABLE,
        "the program has written more than its answer: one line for each line that it reads");
}

int partner_line(struct partner *p, char **line, size_t *n, size_t most, struct failure *failure)
{
    partner_forget(p);
    for (size_t looked = 0;;) {
        char *stop = p->n > looked ? memchr(p->text + looked, '\n', p->n - looked) : NULL;
        if ((stop ? (size_t)(stop - p->text) : p->n) > most)
            return failure_set(failure, EX_UNAVAILABLE,
                               "the program's answer has more than %zu bytes", most);
        if (stop) {
            *stop = 0, *line = p->text, *n = (size_t)(stop - p->text), p->taken = *n + 1;
            return 0;
        }
        looked = p->n;
        if (read_more(p, failure)) return failure->status;
    }
}

/* Says how it has ended after the run, where that is no good end; killed: by us, after so many seconds */
static void say_end(const struct partner *p, int status, bool killed, double seconds)
{
    if (*p->stop) return;
    if (killed)
        warn("--with: the program had not ended %g s after the end of its input, and was killed",
             seconds);
    else if (WIFSIGNALED(status))
        warn("--with: the program was killed after the run: %s", strsignal(WTERMSIG(status)));
    else if (WEXITSTATUS(status))
        warn("--with: the program has ended after the run, with status %d", WEXITSTATUS(status));
}

/* It ends, or is killed after so many seconds; what it writes until then counts as unread. */
static void wait_for_end(struct partner *p, double seconds)
{
    int status = 0;
    bool killed = false;
    if (p->pid <= 0) return;
    double left = seconds, then = now();
    for (; !has_ended(p, &status, 0); spend(&left, &then)) {
        if (*p->stop) left = fmin(left, LAST_WORK);
        if (left < 0) {
            killed = !kill(-p->pid, SIGKILL);
            has_ended(p, &status, INFINITY);
            break;
        }
        ssize_t got = 0;
        p->n = p->n > 0, p->taken = 0; // lest it waits to be read
        if (read_piece(p, &got, &(struct failure){ 0 }) || got <= 0) usleep(1000 * NAP);
    }
    if (seconds > GRACE) say_end(p, status, killed, seconds);
}

int partner_end(struct partner *p, double seconds, struct failure *failure)
{
    if (!p) return 0;
    bool silent = p->from < 0 || !partner_check_silent(p, failure);
    if (p->to >= 0) close(p->to);
    p->to = -1;
    wait_for_end(p, fmax(seconds, GRACE));
    if (silent && p->from >= 0) partner_check_silent(p, failure);
    if (p->guard > 0) kill(p->guard, SIGKILL), waitpid(p->guard, NULL, 0);
    if (p->life >= 0) close(p->life);
    if (p->from >= 0) close(p->from);
    free(p->text);
    free(p);
    return failure->status;
}
