/* draw/film.c: a pipe into ffmpeg [draw/film.h]. */
#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier): pipe2
#include "draw/film.h"

#include "base/output.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

struct film {
    char *path,
        *url; /* its name; and what ffmpeg calls the new file: with a colon a name is a protocol */
    int rate, width, height;
    FILE *pipe;           /* NULL until the first picture, whose size ffmpeg must know */
    struct output output; /* its child is ffmpeg */
};

static const char *ending(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot ? dot : "";
}

bool film_name(const char *path)
{
    return !strcmp(ending(path), ".mp4") || !strcmp(ending(path), ".webm");
}

bool film_possible(void)
{
    const char *path = getenv("PATH");
    char name[4096];
    for (; path && *path; path += strcspn(path, ":"), path += *path == ':') {
        int n = (int)strcspn(path, ":");
        snprintf(name, sizeof name, "%.*s/ffmpeg", n, path);
        if (!access(name, X_OK)) return true;
    }
    return false;
}

static void film_free(struct film *f)
{
    if (f) free(f->path), free(f->url);
    free(f);
}

int film_open(struct film **film, const char *path, int rate, struct failure *failure)
{
    struct film *f = calloc(1, sizeof *f);
    if (f) f->path = strdup(path), f->rate = rate;
    if (!f || !f->path) return film_free(f), failure_set(failure, EX_SOFTWARE, "no memory");
    if (output_open(&f->output, f->path, failure)) return film_free(f), failure->status;
    if (!f->output.at) // a film is written back and forth
        failure_set(failure, EX_IOERR, "%s: not a regular file", path);
    else if (!(f->url = malloc(strlen(f->output.at) + 16)))
        failure_set(failure, EX_SOFTWARE, "no memory");
    if (failure->status) return output_drop(&f->output), film_free(f), failure->status;
    sprintf(f->url, "file:%s", f->output.at);
    *film = f;
    return 0;
}

/* Starts ffmpeg, which reads pixels from a pipe. Its own words go to stderr, errors only; without -xerror it ends with 0 where
   the disk is full. */
static int film_start(struct film *f, struct failure *failure)
{
    char size[40], rate[16];
    bool webm = !strcmp(ending(f->path), ".webm");
    snprintf(size, sizeof size, "%dx%d", f->width, f->height);
    snprintf(rate, sizeof rate, "%d", f->rate);
    const char *const argument[] = { "ffmpeg",   "-loglevel",
                                     "error",    "-xerror",
                                     "-y",       "-f",
                                     "rawvideo", "-pix_fmt",
                                     "rgb24",    "-s",
                                     size,       "-r",
                                     rate,       "-i",
                                     "-",        "-an",
                                     "-c:v",     webm ? "libvpx-vp9" : "libx264",
                                     "-pix_fmt", "yuv420p",
                                     "-crf",     webm ? "30" : "18",
                                     "-b:v",     "0",
                                     "-vf",      "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                                     "-f",       webm ? "webm" : "mp4",
                                     f->url,     NULL };
    int end[2];
    posix_spawn_file_actions_t actions;
    if (pipe2(end, O_CLOEXEC))
        return failure_set(failure, EX_IOERR, "%s: %s", f->path, strerror(errno));
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, end[0], STDIN_FILENO);
    pid_t child;
    int e = posix_spawnp(&child, "ffmpeg", &actions, NULL, (char *const *)argument, environ);
    posix_spawn_file_actions_destroy(&actions);
    close(end[0]);
    if (e) {
        close(end[1]);
        return failure_set(failure, EX_IOERR, "%s: ffmpeg: %s", f->path, strerror(e));
    }
    f->output.child = child;
    f->pipe = fdopen(end[1], "w");
    return f->pipe ? 0 : failure_set(failure, EX_SOFTWARE, "no memory");
}

int film_add(struct film *f, const struct picture *p, struct failure *failure)
{
    if (!f->pipe) {
        f->width = p->width, f->height = p->height;
        signal(SIGPIPE, SIG_IGN); // ffmpeg that has failed is told from its status
        if (film_start(f, failure)) return failure->status;
    }
    size_t n = 3 * (size_t)p->width * (size_t)p->height;
    if (p->width != f->width || p->height != f->height)
        return failure_set(failure, EX_SOFTWARE, "%s: pictures of two sizes", f->path);
    if (fwrite(p->rgb, 1, n, f->pipe) != n)
        return failure_set(failure, EX_IOERR, "%s: ffmpeg failed", f->path);
    return 0;
}

/* Waits for ffmpeg; has it written something, and well? */
static bool has_ended_well(struct film *f)
{
    int status = 0;
    struct stat st;
    while (waitpid(f->output.child, &status, 0) < 0 && errno == EINTR) continue;
    f->output.child = 0;
    return !status && !fstat(f->output.fd, &st) && st.st_size > 0;
}

int film_close(struct film *f, struct failure *failure)
{
    bool written = f->pipe != NULL;
    bool good = !written || !fclose(f->pipe);
    if (f->output.child > 0 && !has_ended_well(f)) good = false;
    if (!good) failure_set(failure, EX_IOERR, "%s: ffmpeg failed", f->path);
    if (written)
        output_close(&f->output, failure);
    else
        output_drop(&f->output);
    film_free(f);
    return failure->status;
}
