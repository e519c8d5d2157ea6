#include "base/unfinished.h"

#include <stdbool.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static struct unfinished *files;

static void remove_one(const struct unfinished *f)
{
    struct stat st;
    if (!lstat(f->path, &st) && st.st_dev == f->device && st.st_ino == f->inode) unlink(f->path);
}

static void remove_all(void)
{
    for (struct unfinished *f = files; f; f = f->next) remove_one(f);
}

void unfinished_begin(struct unfinished *f, const char *path, int fd)
{
    static bool registered;
    struct stat st;
    *f = (struct unfinished){ 0 };
    if (fstat(fd, &st) || !S_ISREG(st.st_mode)) return;
    if (!registered && atexit(remove_all)) return;
    registered = true;
    *f = (struct unfinished){ path, st.st_dev, st.st_ino, files };
    files = f;
}

void unfinished_done(struct unfinished *f)
{
    for (struct unfinished **k = &files; *k; k = &(*k)->next)
        if (*k == f) {
            *k = f->next;
            break;
        }
    f->path = NULL;
}

void unfinished_drop(struct unfinished *f)
{
    if (f->path) remove_one(f);
    unfinished_done(f);
}
