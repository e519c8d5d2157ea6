/*
 * Preloaded: call number NSD_FAIL_AT of those to the system that NSD_FAIL_CALL names (read, write, sync,
 * rename, close, resize, reserve, message, process, socket) fails with NSD_FAIL_WITH: EIO or EINTR once, ENOSPC from there on, or, as "short",
 * half of what was asked for is done. Parent and child count together. With NSD_COUNT the number of
 * such calls goes to that file. Standard error is left alone: it has to tell of the failure.
 *
 * Calls are caught by the kernel (seccomp), so that those which libc makes inside itself count too: all
 * that stdio writes. Ours are let through by a sixth argument that nobody else gives.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

#define OURS 0x6e736450UL

/* The calls of each name */
static const struct {
    const char *name;
    int call[5];
} groups[] = {
    { "read", { SYS_read, SYS_pread64, SYS_readv, SYS_preadv, -1 } },
    { "write", { SYS_write, SYS_pwrite64, SYS_writev, SYS_pwritev, -1 } },
    { "sync", { SYS_fsync, SYS_fdatasync, -1 } },
    { "rename",
      { SYS_renameat, SYS_renameat2,
#ifdef SYS_rename
        SYS_rename,
#endif
        -1 } },
    { "close", { SYS_close, -1 } },
    { "resize", { SYS_ftruncate, -1 } },
    { "reserve", { SYS_fallocate, -1 } },
    { "message", { SYS_sendto, SYS_recvfrom, SYS_wait4, -1 } },
    { "process",
      { SYS_clone,
#ifdef SYS_fork
        SYS_fork,
#endif
        -1 } },
    { "socket", { SYS_socketpair, -1 } },
};

static atomic_long *count; /* shared with children */
static long fail_at;
static int fail_with; /* 0: short */
static pid_t first;   /* the process that was started */

static long call(const long *a, long number)
{
    long e = syscall(number, a[0], a[1], a[2], a[3], a[4], OURS);
    return e < 0 ? -errno : e;
}

/* Half of what a reads or writes, if that can be halved */
static long half(long *a, long number)
{
    bool halves = number == SYS_read || number == SYS_write || number == SYS_pread64 ||
                  number == SYS_pwrite64;
    if (halves && a[2] > 1) a[2] /= 2;
    return call(a, number);
}

/* What the compiler adds at the end, gcov's counts, is not the tool's. */
static bool counts(long fd)
{
    char link[40], path[400];
    snprintf(link, sizeof link, "/proc/self/fd/%ld", fd);
    ssize_t n = readlink(link, path, sizeof path);
    return n > 5 && !memcmp(path + n - 5, ".gcda", 5);
}

static long decide(long *a, long number)
{
    if (a[0] == STDERR_FILENO && number != SYS_renameat2) return call(a, number);
    long k = atomic_fetch_add(count, 1) + 1;
    bool fails = fail_at && (fail_with == ENOSPC ? k >= fail_at : k == fail_at);
    if (!fails || counts(a[0])) return call(a, number);
    if (!fail_with) return half(a, number);
    if (number == SYS_close) call(a, number); // it is closed all the same
    return -fail_with;
}

static void caught(int signal, siginfo_t *info, void *context)
{
    (void)signal;
    ucontext_t *c = context;
    int before = errno;
#if defined __x86_64__
    greg_t *r = c->uc_mcontext.gregs;
    long a[] = { r[REG_RDI], r[REG_RSI], r[REG_RDX], r[REG_R10], r[REG_R8] };
    r[REG_RAX] = decide(a, info->si_syscall);
#elif defined __aarch64__
    unsigned long long *r = c->uc_mcontext.regs;
    long a[] = { (long)r[0], (long)r[1], (long)r[2], (long)r[3], (long)r[4] };
    r[0] = (unsigned long long)decide(a, info->si_syscall);
#else
#error "which registers hold a call's arguments here?"
#endif
    errno = before;
}

/* Has the kernel send us SIGSYS for these calls, unless they are our own. */
static int catch_calls(const int *calls)
{
    struct sock_filter f[16] = {
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, args[5])),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, OURS, 0, 1),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr)),
    };
    unsigned short n = 4;
    for (; *calls >= 0; calls++) {
        f[n++] = (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (unsigned)*calls, 0, 1);
        f[n++] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP);
    }
    f[n++] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
    struct sock_fprog program = { n, f };
    struct sigaction action = { .sa_sigaction = caught, .sa_flags = SA_SIGINFO | SA_NODEFER };
    if (sigaction(SIGSYS, &action, NULL) || prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0)) return -1;
    return prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program);
}

__attribute__((constructor)) static void start(void)
{
    const char *at = getenv("NSD_FAIL_AT"), *with = getenv("NSD_FAIL_WITH"),
               *which = getenv("NSD_FAIL_CALL");
    count = mmap(NULL, sizeof *count, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (count == MAP_FAILED || !which) _exit(99);
    first = getpid();
    fail_at = at ? atol(at) : 0;
    if (with && strcmp(with, "short") != 0)
        fail_with = !strcmp(with, "EINTR") ? EINTR : !strcmp(with, "ENOSPC") ? ENOSPC : EIO;
    unsetenv("LD_PRELOAD"); // what a tool runs is not meant
    for (size_t k = 0; k < sizeof groups / sizeof *groups; k++)
        if (!strcmp(groups[k].name, which) && catch_calls(groups[k].call)) _exit(99);
}

__attribute__((destructor)) static void tell(void)
{
    const char *path = getenv("NSD_COUNT");
    char text[32];
    if (!path || getpid() != first) return;
    long n = snprintf(text, sizeof text, "%ld\n", (long)*count);
    FILE *f = fopen(path, "w");
    if (!f) return;
    long a[] = { fileno(f), (long)text, n, 0, 0 };
    call(a, SYS_write);
    fclose(f);
}
