#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier): memfd_create
#include "base/bounded.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

/* ---- limits of the system ---- */

enum { SLOWER = SANITIZED ? 10 : 1 };

/* Bytes of addresses that the process has */
static rlim_t address_space(void)
{
    unsigned long long pages = 0;
    FILE *f = fopen("/proc/self/statm", "r");
    if (!f || fscanf(f, "%llu", &pages) != 1) pages = 0;
    if (f) fclose(f);
    return (rlim_t)pages * (rlim_t)sysconf(_SC_PAGESIZE);
}

static void set_limit(int which, rlim_t most)
{
    struct rlimit r;
    if (getrlimit(which, &r)) return;
    r.rlim_cur = most < r.rlim_max ? most : r.rlim_max;
    setrlimit(which, &r);
}

void limits_memory(uint64_t bytes)
{
    if (!SANITIZED) set_limit(RLIMIT_AS, address_space() + (rlim_t)bytes);
}

void limits_processor(uint64_t seconds)
{
    struct rusage used;
    if (getrusage(RUSAGE_SELF, &used)) return;
    rlim_t now = (rlim_t)(used.ru_utime.tv_sec + used.ru_stime.tv_sec);
    set_limit(RLIMIT_CPU, now + SLOWER * (rlim_t)seconds);
}

double limits_room(void)
{
    struct rlimit r;
    double room = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    if (!SANITIZED && !getrlimit(RLIMIT_AS, &r) && r.rlim_cur != RLIM_INFINITY &&
        (double)r.rlim_cur < room)
        room = (double)r.rlim_cur;
    return room;
}

void limits_lift(void)
{
    set_limit(RLIMIT_AS, RLIM_INFINITY), set_limit(RLIMIT_CPU, RLIM_INFINITY);
}

void limits_no_core(void)
{
    set_limit(RLIMIT_CORE, 0);
}

int limits_reason(int signal, const char *name, struct failure *failure)
{
    if (signal == SIGXCPU)
        return failure_set(failure, EX_DATAERR,
                           "%.250s: takes too long to read: damaged, or made to", name);
    if (signal == SIGKILL)
        return failure_set(failure, EX_SOFTWARE, "%.250s: reading it was killed (no memory?)",
                           name);
    return 0;
}

enum {
    SPARE_MEMORY = 1 << 28, /* bytes */
    MEMORY_RATIO = 8,       /* and so many times the file: a grain is 200 bytes, and 30 of text */
    SPARE_SECONDS = 4,      /* of the processor, */
    RATE = 10000000         /* and bytes a second: a third of what reading text takes */
};

struct bounded {
    int fd;
};

int bounded_put(struct bounded *to, const void *bytes, size_t size, struct failure *failure)
{
    for (size_t done = 0; done < size;) {
        ssize_t n = write(to->fd, (const char *)bytes + done, size - done);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0)
            return failure_set(failure, EX_SOFTWARE, "no memory for the input: %s",
                               strerror(errno));
        done += (size_t)n;
    }
    return 0;
}

static void bound(uint64_t size)
{
    limits_no_core();
    limits_memory(SPARE_MEMORY + MEMORY_RATIO * size);
    limits_processor(SPARE_SECONDS + size / RATE);
}

/* The process has ended: with an answer, a reason, or broken down */
static int bounded_judge(int status, const char *name, const struct failure *said,
                         struct failure *failure)
{
    if (WIFEXITED(status) && !WEXITSTATUS(status)) return 0;
    if (WIFEXITED(status) && said->status)
        return failure_set(failure, said->status, "%s", said->text);
    int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (limits_reason(signal, name, failure)) return failure->status;
    return failure_set(failure, EX_DATAERR,
                       "%.250s: reading it breaks down (%s): damaged, or made to", name,
                       signal ? strsignal(signal) : "it ended");
}

static int bounded_take(int fd, void **answer, size_t *n, struct failure *failure)
{
    struct stat st;
    *answer = NULL, *n = 0;
    if (fstat(fd, &st))
        return failure_set(failure, EX_SOFTWARE, "the input is lost: %s", strerror(errno));
    if (!st.st_size) return 0;
    void *map = mmap(NULL, (size_t)st.st_size, PROT_READ, MAP_PRIVATE, fd, 0);
    if (map == MAP_FAILED)
        return failure_set(failure, EX_SOFTWARE, "no memory for the input: %s", strerror(errno));
    *answer = map, *n = (size_t)st.st_size;
    return 0;
}

int bounded_run(const struct bounded_task *task, void **answer, size_t *n, struct failure *failure)
{
    struct bounded to = { memfd_create("answer", MFD_CLOEXEC) };
    struct failure *said =
        mmap(NULL, sizeof *said, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    pid_t parent = getpid(), pid = to.fd < 0 || said == MAP_FAILED ? -1 : fork();
    if (!pid) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (getppid() != parent) _exit(0);
        bound(task->size);
        _exit(task->work(task->with, &to, said) ? 1 : 0);
    }
    int status = 0;
    if (pid < 0)
        failure_set(failure, EX_SOFTWARE, "no process to read with: %s", strerror(errno));
    else {
        while (waitpid(pid, &status, 0) < 0 && errno == EINTR) continue;
        said->text[sizeof said->text - 1] = 0;
        if (!bounded_judge(status, task->name, said, failure))
            bounded_take(to.fd, answer, n, failure);
    }
    if (said != MAP_FAILED) munmap(said, sizeof *said);
    if (to.fd >= 0) close(to.fd);
    return failure->status;
}

void bounded_free(void *answer, size_t n)
{
    if (answer) munmap(answer, n);
}
