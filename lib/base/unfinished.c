#include "base/unfinished.h"

#include <stdbool.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static struct unfinished *files;

static void remove_all(void)
{
    struct stat st;
    for (struct unfinished *f = files; f; f = f->next)
        if (!lstat(f->path, &st) && st.st_dev == f->device && st.st_ino == f->inode)
            unlink(f->path);
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
