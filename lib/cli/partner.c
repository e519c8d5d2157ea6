#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier): pipe2
#include "cli/partner.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum {
    PIECE = 1 << 16, /* bytes read at a time: what a pipe holds */
    NAP = 10         /* ms between looks whether it has ended */
};

struct partner {
    pid_t pid;
    int to, from;   /* pipes */
    char *text;     /* what it has said */
    size_t n, room; /* bytes of it */
    size_t taken;   /* of them those that were given */
    double seconds; /* that an answer may take, */
    double end;     /* and until when */
};

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int failed(struct why *why, const char *what)
{
    return why_set(why, EX_UNAVAILABLE, "%s: %s", what, strerror(errno));
}

int partner_start(struct partner **out, const char *command, struct why *why)
{
    int to[2], from[2];
    struct partner *p = *out = calloc(1, sizeof *p);
    if (!p) return why_set(why, EX_SOFTWARE, "no memory for a program");
    p->to = p->from = -1;
    if (pipe2(to, O_CLOEXEC)) return failed(why, "no pipe to the program");
    p->to = to[1];
    if (pipe2(from, O_CLOEXEC)) return close(to[0]), failed(why, "no pipe from the program");
    p->from = from[0];
    p->pid = fork();
    if (p->pid == 0) {
        setpgid(0, 0); // a signal from the terminal is for us, who end it
        signal(SIGPIPE, SIG_DFL), signal(SIGINT, SIG_DFL), signal(SIGTERM, SIG_DFL);
        signal(SIGHUP, SIG_DFL);
        if (dup2(to[0], STDIN_FILENO) < 0 || dup2(from[1], STDOUT_FILENO) < 0) _exit(126);
        execl("/bin/sh", "sh", "-c", command, (char *)NULL);
        _exit(127);
    }
    close(to[0]), close(from[1]);
    if (p->pid < 0) return failed(why, "the program cannot be started");
    setpgid(p->pid, p->pid); // whoever of both comes first
    fcntl(p->to, F_SETFL, O_NONBLOCK), fcntl(p->from, F_SETFL, O_NONBLOCK);
    return 0;
}

/* Waits until something can be read or written; 0: too long */
static int ready(int fd, short what, double end)
{
    struct pollfd p = { .fd = fd, .events = what };
    for (;;) {
        double left = end - now();
        int n = poll(&p, 1, left > 0 ? (int)(left < 1e6 ? 1e3 * left + 1 : 1e9) : 0);
        if (n >= 0 || errno != EINTR) return n;
    }
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

/* How it has ended */
static int ended(struct partner *p, struct why *why)
{
    int status = 0;
    pid_t got = 0;
    for (int k = 0; k < 100 && !got;
         k++) // its pipe is closed, so that it ends now, or lives on without
        if (!(got = waitpid(p->pid, &status, WNOHANG))) usleep(1000 * NAP);
    if (got <= 0) return why_set(why, EX_UNAVAILABLE, "the program has closed its output");
    p->pid = 0;
    if (WIFSIGNALED(status))
        return why_set(why, EX_UNAVAILABLE, "the program was killed: %s",
                       strsignal(WTERMSIG(status)));
    return why_set(why, EX_UNAVAILABLE, "the program has ended, with status %d",
                   WEXITSTATUS(status));
}

int partner_write(struct partner *p, const void *bytes, size_t n, double seconds, struct why *why)
{
    const double end = now() + seconds;
    const char *at = bytes;
    while (n > 0) {
        ssize_t done = write_quietly(p->to, at, n);
        if (done > 0) at += done, n -= (size_t)done;
        if (done >= 0 || errno == EINTR) continue;
        if (errno == EPIPE) return ended(p, why);
        if (errno != EAGAIN) return failed(why, "the program");
        if (!ready(p->to, POLLOUT, end))
            return why_set(why, EX_UNAVAILABLE,
                           "the program has read nothing for %g s (--with-timeout)", seconds);
    }
    return 0;
}

/* Room for one more piece */
static bool grow(struct partner *p)
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
    p->seconds = seconds, p->end = now() + seconds;
}

/* What was given leaves the memory. */
static void forget(struct partner *p)
{
    if (p->taken) memmove(p->text, p->text + p->taken, p->n - p->taken);
    p->n -= p->taken, p->taken = 0;
}

/* Reads what there is, or waits for it. */
static int read_more(struct partner *p, struct why *why)
{
    if (now() > p->end)
        return why_set(why, EX_UNAVAILABLE,
                       "the program has not answered for %g s (--with-timeout)", p->seconds);
    if (!grow(p)) return why_set(why, EX_SOFTWARE, "no memory for an answer");
    ssize_t got = read(p->from, p->text + p->n, PIECE);
    if (got > 0) p->n += (size_t)got;
    if (got == 0) return ended(p, why);
    if (got > 0 || errno == EINTR) return 0;
    if (errno != EAGAIN) return failed(why, "the program");
    ready(p->from, POLLIN, p->end);
    return 0;
}

int partner_peek(struct partner *p, char **bytes, size_t n, struct why *why)
{
    forget(p);
    while (p->n < n)
        if (read_more(p, why)) return why->status;
    *bytes = p->text;
    return 0;
}

int partner_bytes(struct partner *p, char **bytes, size_t n, struct why *why)
{
    if (partner_peek(p, bytes, n, why)) return why->status;
    p->taken = n;
    return 0;
}

int partner_line(struct partner *p, char **line, size_t *n, size_t most, struct why *why)
{
    forget(p);
    for (size_t looked = 0;;) {
        char *stop = p->n > looked ? memchr(p->text + looked, '\n', p->n - looked) : NULL;
        if ((stop ? (size_t)(stop - p->text) : p->n) > most)
            return why_set(why, EX_UNAVAILABLE, "the program's answer has more than %zu bytes",
                           most);
        if (stop) {
            *stop = 0, *line = p->text, *n = (size_t)(stop - p->text), p->taken = *n + 1;
            return 0;
        }
        looked = p->n;
        if (read_more(p, why)) return why->status;
    }
}

void partner_end(struct partner *p, double seconds)
{
    if (!p) return;
    if (p->to >= 0) close(p->to);
    const double end = now() + seconds;
    while (p->pid > 0 && !waitpid(p->pid, NULL, WNOHANG)) {
        if (now() > end) {
            kill(-p->pid, SIGKILL);
            waitpid(p->pid, NULL, 0);
            break;
        }
        char rest[256];
        ssize_t unread = read(p->from, rest, sizeof rest); // lest it waits to be read
        if (unread <= 0) usleep(1000 * NAP);
    }
    if (p->from >= 0) close(p->from);
    free(p->text);
    free(p);
}
