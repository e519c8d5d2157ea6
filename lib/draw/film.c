/* draw/film.c: a pipe into ffmpeg [draw/film.h]. */
#include "draw/film.h"

#include "base/unfinished.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

struct film {
    char *path, *other; /* its name, and the one until it is whole */
    int rate, width, height;
    FILE *pipe; /* NULL until the first picture, whose size ffmpeg must know */
    pid_t child;
    struct unfinished unfinished; /* the other */
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

int film_open(struct film **film, const char *path, int rate, struct why *why)
{
    struct film *f = calloc(1, sizeof *f);
    size_t room = strlen(path) + 16;
    if (f) f->path = strdup(path), f->other = malloc(room), f->rate = rate;
    if (!f || !f->path || !f->other) {
        if (f) free(f->path), free(f->other);
        free(f);
        return why_set(why, EX_SOFTWARE, "no memory");
    }
    snprintf(f->other, room, "%.*s.part%s", (int)(ending(path) - path), path, ending(path));
    int fd =
        open(f->other, O_WRONLY | O_CREAT | O_CLOEXEC, 0666); // trouble is told before the work
    if (fd < 0) {
        why_set(why, EX_IOERR, "%s: %s", path, strerror(errno));
        free(f->path), free(f->other), free(f);
        return why->status;
    }
    unfinished_begin(&f->unfinished, f->other, fd);
    close(fd);
    *film = f;
    return 0;
}

/* Starts ffmpeg, which reads pixels from a pipe. Its own words go to stderr, errors only. */
static int start(struct film *f, struct why *why)
{
    char size[40], rate[16];
    bool webm = !strcmp(ending(f->path), ".webm");
    snprintf(size, sizeof size, "%dx%d", f->width, f->height);
    snprintf(rate, sizeof rate, "%d", f->rate);
    const char *const argument[] = { "ffmpeg",
                                     "-loglevel",
                                     "error",
                                     "-y",
                                     "-f",
                                     "rawvideo",
                                     "-pix_fmt",
                                     "rgb24",
                                     "-s",
                                     size,
                                     "-r",
                                     rate,
                                     "-i",
                                     "-",
                                     "-an",
                                     "-c:v",
                                     webm ? "libvpx-vp9" : "libx264",
                                     "-pix_fmt",
                                     "yuv420p",
                                     "-crf",
                                     webm ? "30" : "18",
                                     "-b:v",
                                     "0",
                                     "-vf",
                                     "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                                     f->other,
                                     NULL };
    int end[2];
    posix_spawn_file_actions_t actions;
    if (pipe(end)) return why_set(why, EX_IOERR, "%s: %s", f->path, strerror(errno));
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, end[0], STDIN_FILENO);
    posix_spawn_file_actions_addclose(&actions, end[1]);
    int e = posix_spawnp(&f->child, "ffmpeg", &actions, NULL, (char *const *)argument, environ);
    posix_spawn_file_actions_destroy(&actions);
    close(end[0]);
    if (e) {
        close(end[1]);
        return why_set(why, EX_IOERR, "%s: ffmpeg: %s", f->path, strerror(e));
    }
    f->pipe = fdopen(end[1], "w");
    return f->pipe ? 0 : why_set(why, EX_SOFTWARE, "no memory");
}

int film_add(struct film *f, const struct picture *p, struct why *why)
{
    if (!f->pipe) {
        f->width = p->width, f->height = p->height;
        signal(SIGPIPE, SIG_IGN); // ffmpeg that has failed is told from its status
        if (start(f, why)) return why->status;
    }
    size_t n = 3 * (size_t)p->width * (size_t)p->height;
    if (p->width != f->width || p->height != f->height)
        return why_set(why, EX_SOFTWARE, "%s: pictures of two sizes", f->path);
    if (fwrite(p->rgb, 1, n, f->pipe) != n)
        return why_set(why, EX_IOERR, "%s: ffmpeg failed", f->path);
    return 0;
}

int film_close(struct film *f, struct why *why)
{
    int status = 0;
    bool written = f->pipe != NULL;
    if (f->pipe && fclose(f->pipe)) why_set(why, EX_IOERR, "%s: ffmpeg failed", f->path);
    while (written && waitpid(f->child, &status, 0) < 0 && errno == EINTR) {
    }
    if (written && status) why_set(why, EX_IOERR, "%s: ffmpeg failed", f->path);
    if (written && !why->status && rename(f->other, f->path))
        why_set(why, EX_IOERR, "%s: %s", f->path, strerror(errno));
    if (why->status || !written) unlink(f->other);
    unfinished_done(&f->unfinished);
    free(f->path), free(f->other), free(f);
    return why->status;
}
