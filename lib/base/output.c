/* base/output.c: files that take the place of others when they are whole [base/output.h]. */
#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier): F_OFD_SETLK
#include "base/output.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
    NAME_KEPT = 200, /* bytes of a name that are in that of the new file: 255 are allowed */
    LINKS_MOST = 40  /* links that lead to one another, as the system has it */
};

static const off_t LOCKED = (off_t)1 << 62; /* the byte that a writer locks */

static struct output *list;
static pthread_mutex_t list_lock =
    PTHREAD_MUTEX_INITIALIZER; /* of the list, where there are several threads */
static pid_t owner;            /* of the list: not a child, which inherits it */

/* ---- what is left over ---- */

static bool is_at(const struct output *o)
{
    struct stat st, own;
    return !lstat(o->at, &st) && !fstat(o->fd, &own) && st.st_dev == own.st_dev &&
           st.st_ino == own.st_ino;
}

static void remove_one(const struct output *o)
{
    if (o->child > 0) kill(o->child, SIGKILL);
    if (o->borrowed && ftruncate(o->fd, 0)) return; // nothing more can be done
    if (o->at && is_at(o)) unlink(o->at);
}

static void remove_all(void)
{
    for (struct output *o = list; o && owner == getpid(); o = o->next) remove_one(o);
}

static void on_signal(int number)
{
    remove_all();
    signal(number, SIG_DFL);
    raise(number);
}

static void output_enlist(struct output *o)
{
    static const int signals[] = { SIGINT, SIGTERM, SIGHUP };
    pthread_mutex_lock(&list_lock);
    if (!owner && !embedded_is()) {
        atexit(remove_all);
        for (int k = 0; k < 3;
             k++) // those that the tool has not taken for itself, and that are not ignored
        {
            void (*was)(int) = signal(signals[k], on_signal);
            if (was != SIG_DFL) signal(signals[k], was);
        }
    }
    owner = getpid();
    o->listed = true, o->next = list, list = o;
    pthread_mutex_unlock(&list_lock);
}

static void output_unlist(struct output *o)
{
    pthread_mutex_lock(&list_lock);
    for (struct output **k = &list; o->listed && *k; k = &(*k)->next)
        if (*k == o) {
            *k = o->next;
            break;
        }
    o->listed = false;
    pthread_mutex_unlock(&list_lock);
}

/* ---- one writer ---- */

/*
 * The lock belongs to what was opened, so that { a; b; } > f is one writer. HDF5's own, of flock, is not
 * taken: it would keep readers out, too (h5py of a growing trajectory). Only a byte beyond all data is locked:
 * MPI-IO may lock the bytes that the processes of one run write together.
 */
int output_lock(int fd, int how, const char *name, struct failure *failure)
{
    struct flock lock = { .l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = LOCKED, .l_len = 1 };
    struct stat st;
    if (fstat(fd, &st) || !S_ISREG(st.st_mode)) return 0; // /dev/null has any number
    while (fcntl(fd, how, &lock)) {
        if (errno == EINTR) continue;
        if (errno == EACCES || errno == EAGAIN)
            return failure_set(failure, EX_IOERR, "%s: another program is writing it", name);
        return 0; // no file that can be locked
    }
    return 0;
}

void output_unlock(int fd)
{
    struct flock lock = { .l_type = F_UNLCK, .l_whence = SEEK_SET, .l_start = LOCKED, .l_len = 1 };
    fcntl(fd, F_OFD_SETLK, &lock);
}

bool output_removed(int fd)
{
    struct stat st;
    return !fstat(fd, &st) && S_ISREG(st.st_mode) && !st.st_nlink;
}

/* ---- the new file ---- */

static int output_failed(const struct output *o, struct failure *failure, int trouble)
{
    return failure_set(failure, EX_IOERR, "%s: %s", o->name, strerror(trouble));
}

/* Its rights are those of the file whose place it takes. */
static void take_rights(const struct output *o)
{
    struct stat st;
    if (o->old < 0 || fstat(o->old, &st)) return;
    if (fchown(o->fd, st.st_uid, st.st_gid)) errno = 0; // who is not root keeps it
    fchmod(o->fd, st.st_mode & 0777);
}

/* The target's folder and "/.NAME.nsd-new" */
static char *name_beside(const char *target)
{
    const char *slash = strrchr(target, '/'), *name = slash ? slash + 1 : target;
    size_t room = strlen(target) + 16;
    char *path = malloc(room);
    if (path)
        snprintf(path, room, "%.*s.%.*s.nsd-new", (int)(name - target), target, NAME_KEPT, name);
    return path;
}

/* Opens it, locked, and empty: one that a killed program has left is used again. */
static int open_beside(struct output *o, struct failure *failure)
{
    o->at = name_beside(o->target);
    if (!o->at) return failure_set(failure, EX_SOFTWARE, "no memory");
    do {
        if (o->fd >= 0) close(o->fd); // the other writer was done with it in between
        o->fd = open(o->at, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
        if (o->fd < 0) return output_failed(o, failure, errno);
        if (output_lock(o->fd, F_OFD_SETLK, o->name, failure)) return failure->status;
    } while (!is_at(o));
    if (ftruncate(o->fd, 0)) return output_failed(o, failure, errno);
    take_rights(o);
    output_enlist(o);
    return 0;
}

/* Where a file of this name would be made: a link that leads nowhere is followed, too. To be freed; NULL: no
   memory */
static char *output_follow(const char *path)
{
    char *at = strdup(path), link[PATH_MAX];
    for (int k = 0; at && k < LINKS_MOST; k++) {
        ssize_t n = readlink(at, link, sizeof link - 1);
        if (n < 0) break;
        link[n] = 0;
        const char *slash = *link == '/' ? NULL : strrchr(at, '/');
        int folder = slash ? (int)(slash - at) + 1 : 0;
        char *next = malloc((size_t)folder + (size_t)n + 1);
        if (next) sprintf(next, "%.*s%s", folder, at, link);
        free(at);
        at = next;
    }
    return at;
}

/* Is this the name of something that is open already, whatever that is? */
static bool is_open_already(const char *path)
{
    return !strncmp(path, "/dev/std", 8) || !strncmp(path, "/dev/fd/", 8) ||
           !strncmp(path, "/proc/", 6);
}

static int open_new(struct output *o, const char *path, struct failure *failure)
{
    struct stat st;
    *o = (struct output){ .name = path, .fd = -1, .old = -1 };
    o->target = realpath(path, NULL);
    bool there = o->target && !stat(o->target, &st);
    if (there && S_ISDIR(st.st_mode)) return output_failed(o, failure, EISDIR);
    if (is_open_already(path) || (there && !S_ISREG(st.st_mode))) {
        free(o->target);
        o->target = NULL;
        bool regular = there && S_ISREG(st.st_mode);
        o->fd = open(path, (regular ? O_RDWR | O_TRUNC : O_WRONLY) | O_CLOEXEC);
        if (o->fd < 0) return output_failed(o, failure, errno);
        o->nameless = output_removed(o->fd);
        return 0;
    }
    if (there) o->old = open(o->target, O_RDWR | O_CLOEXEC);
    if (there && o->old < 0) return output_failed(o, failure, errno);
    if (there && output_lock(o->old, F_OFD_SETLK, o->name, failure)) return failure->status;
    if (!there && !(o->target = output_follow(path)))
        return failure_set(failure, EX_SOFTWARE, "no memory");
    return open_beside(o, failure);
}

/* A child of fork() that has not run yet still has the file open: what is locked there is unlocked, not only closed. */
static void unlock_and_close(int fd)
{
    if (fd < 0) return;
    output_unlock(fd);
    close(fd);
}

static void output_forget(struct output *o)
{
    output_unlist(o);
    if (!o->borrowed) unlock_and_close(o->fd);
    unlock_and_close(o->old);
    if (o->at != o->target) free(o->at);
    free(o->target);
    *o = (struct output){ .name = o->name, .fd = -1, .old = -1 };
}

int output_open(struct output *o, const char *path, struct failure *failure)
{
    if (open_new(o, path, failure)) output_forget(o);
    return failure->status;
}

static int output_put_in_place(struct output *o, struct failure *failure)
{
    if (o->placed || !o->target) return 0;
    if (!is_at(o))
        return failure_set(failure, EX_IOERR, "%s: another program has removed %s", o->name, o->at);
    if (rename(o->at, o->target)) return output_failed(o, failure, errno);
    free(o->at);
    o->at = o->target, o->placed = true;
    unlock_and_close(o->old);
    o->old = -1;
    return 0;
}

int output_place_for_now(struct output *o, struct failure *failure)
{
    return output_put_in_place(o, failure);
}

int output_place(struct output *o, struct failure *failure)
{
    if (!output_put_in_place(o, failure)) output_unlist(o);
    return failure->status;
}

/* Asks the file system what it says of the data when a file is closed, while the lock is kept. */
static bool closes(int fd)
{
    int copy = fcntl(fd, F_DUPFD_CLOEXEC, 0);
    return copy >= 0 && !close(copy);
}

int output_close(struct output *o, struct failure *failure)
{
    if (!o->nameless && output_removed(o->fd))
        failure_set(failure, EX_IOERR, "%s: another program has removed it", o->name);
    else if (!failure->status && !closes(o->fd))
        output_failed(o, failure, errno);
    if (failure->status || output_place(o, failure)) return output_drop(o), failure->status;
    output_forget(o);
    return failure->status;
}

void output_drop(struct output *o)
{
    if (o->listed) remove_one(o);
    output_forget(o);
}

void output_borrow(struct output *o, int fd, const char *name)
{
    *o = (struct output){ .name = name, .fd = fd, .old = -1, .borrowed = true };
    output_enlist(o);
}

void output_keep(struct output *o)
{
    output_forget(o);
}

/* ---- as a stream ---- */

FILE *output_stream(struct output *o, const char *path, struct failure *failure)
{
    if (output_open(o, path, failure)) return NULL;
    int fd = fcntl(o->fd, F_DUPFD_CLOEXEC, 0); // the stream's own
    FILE *stream = fd < 0 ? NULL : fdopen(fd, "w");
    if (stream) return stream;
    if (fd >= 0) close(fd);
    output_failed(o, failure, errno);
    output_drop(o);
    return NULL;
}

int output_stream_close(struct output *o, FILE *stream, struct failure *failure)
{
    bool bad = ferror(stream);
    if (fclose(stream)) output_failed(o, failure, errno);
    if (bad) failure_set(failure, EX_IOERR, "%s: not written (disk full?)", o->name);
    return output_close(o, failure);
}

/* ---- whose process it is ---- */

static atomic_bool embedded;

void embedded_set(void)
{
    atomic_store(&embedded, true);
}

bool embedded_is(void)
{
    return atomic_load(&embedded);
}
