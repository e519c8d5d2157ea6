/* scene/mesh_file.c: a file opened, and given to the reader of its format [scene/mesh_file.h]. */
#include "scene/mesh_file.h"

#include "base/json.h"
#include "base/text.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- text taken apart ---- */

enum {
    NUMBER_MOST = 400, /* bytes of a number */
    SHOWN = 40         /* of a word in a message */
};

struct words words_of(struct soup *soup, const char *bytes, int64_t n)
{
    soup->unit = "line", soup->at = 1;
    return (struct words){ soup, bytes + mark_length(bytes, (size_t)n), bytes + n, false, false };
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

/* Is this the backslash before the end of a line? */
static bool mesh_file_goes_on(const struct words *w)
{
    const char *s = w->at + 1;
    return w->joined && *w->at == '\\' && (*s == '\n' || (*s == '\r' && s[1] == '\n'));
}

bool words_next(struct words *w, struct word *word)
{
    while (is_blank(*w->at) || mesh_file_goes_on(w)) {
        if (*w->at++ != '\\') continue;
        w->at = strchr(w->at, '\n') + 1;
        w->soup->at++;
    }
    if (w->comments && *w->at == '#')
        while (w->at < w->end && *w->at != '\n') w->at++;
    word->s = w->at;
    while (w->at < w->end && *w->at != '\n' && !is_blank(*w->at) && !mesh_file_goes_on(w)) w->at++;
    word->n = (int)(w->at - word->s < INT32_MAX ? w->at - word->s : INT32_MAX);
    return word->n > 0;
}

bool words_line(struct words *w)
{
    struct word rest;
    while (words_next(w, &rest)) {
    }
    if (w->at == w->end) return false;
    w->at++, w->soup->at++;
    return true;
}

bool words_any(struct words *w, struct word *word)
{
    while (!words_next(w, word))
        if (!words_line(w)) return false;
    return true;
}

bool word_is(struct word word, const char *what)
{
    for (int k = 0; k < word.n; k++)
        if (!what[k] || tolower((unsigned char)word.s[k]) != what[k]) return false;
    return !what[word.n];
}

bool word_has_only(struct word word, const char *letters)
{
    for (int k = 0; k < word.n; k++)
        if (!word.s[k] || !strchr(letters, word.s[k])) return false;
    return true;
}

int word_fault(struct words *w, struct word word, const char *trouble)
{
    return soup_fault(w->soup, "\"%.*s\" %s", word.n < SHOWN ? word.n : SHOWN, word.s, trouble);
}

int word_number(struct words *w, struct word word, double *x)
{
    char *end = NULL;
    bool decimal = word.n < NUMBER_MOST && word_has_only(word, "+-.0123456789eE"); // no nan, 0x1
    if (decimal) *x = number_read(word.s, &end);
    if (!decimal || end != word.s + word.n)
        return word_fault(w, word, "is no finite decimal number");
    return isfinite(*x) ? 0 : word_fault(w, word, "is too large");
}

int words_number(struct words *w, double *x)
{
    struct word word;
    if (!words_next(w, &word))
        return soup_fault(w->soup, "a number is missing: is the file cut off?");
    return word_number(w, word, x);
}

int words_whole(struct words *w, int64_t *i)
{
    double x = 0;
    if (words_number(w, &x)) return w->soup->failure->status;
    if (!(x == floor(x) && fabs(x) < 1e15)) return soup_fault(w->soup, "%g is no whole number", x);
    *i = (int64_t)x;
    return 0;
}

static const struct mesh_format *const formats[] = { &mesh_ply, &mesh_stl, &mesh_obj };

enum { FORMATS = sizeof formats / sizeof formats[0] };

static const struct mesh_format *format_of(const struct mesh_bytes *b)
{
    const char *dot = strrchr(b->name, '.');
    for (int k = 0; k < FORMATS; k++)
        if (formats[k]->looks(b->at, b->n)) return formats[k];
    for (int k = 0; k < FORMATS && dot; k++)
        if (!strcasecmp(dot, formats[k]->ending)) return formats[k];
    return NULL;
}

/* Faces first .. end-1 of the surface are of this part: each of its names */
static int give_part(struct scene_files *files, const char *part, int32_t first, int32_t end,
                     struct failure *failure)
{
    char name[NAME_BYTES + 1];
    for (const char *at = part, *next; *at; at = next + 1) {
        next = strchr(at, '\n');
        snprintf(name, sizeof name, "%.*s", (int)(next - at), at);
        if (names_give(files->parts, name, files->wall, first, end - first, failure)) break;
    }
    return failure->status;
}

/* The parts of a surface are named: each run of triangles that are of one. */
static int give_names(struct scene_files *files, const struct soup *s, struct failure *failure)
{
    if (!s->parts)
        return failure_set(failure, EX_DATAERR,
                           "%s: has no groups: \"parts\": [{name, faces}, ...]", s->name);
    for (int32_t i = 0, end; i < s->triangles && !failure->status; i = end) {
        for (end = i + 1; end < s->triangles && s->part_of[end] == s->part_of[i];) end++;
        if (s->part_of[i] >= 0) give_part(files, s->part[s->part_of[i]], i, end, failure);
    }
    return failure->status;
}

int mesh_bytes_read(struct mesh *to, struct scene_files *files, const struct mesh_bytes *b,
                    int32_t *left_out, struct failure *failure)
{
    struct soup s = {
        .name = b->name, .failure = failure, .work = MESH_WORK_MOST - files->mesh_work, .now = -1
    };
    const struct mesh_format *format = format_of(b);
    if (!format)
        return failure_set(failure, EX_DATAERR,
                           "%s: neither STL, OBJ nor PLY: write it as one of these", b->name);
    s.grouped = files->parts != NULL;
    if (s.grouped && format != &mesh_obj)
        failure_set(failure, EX_DATAERR,
                    "%s: only OBJ files have groups: name ranges of faces instead", b->name);
    else if (!format->read(&s, b->at, b->n) && !soup_mesh(to, &s, b->scale, left_out) && s.grouped)
        give_names(files, &s, failure);
    files->mesh_work = MESH_WORK_MOST - s.work;
    soup_free(&s);
    return failure->status;
}

/* Opens a plain file; nothing else has an end that is known. Returns -1 after a fault. */
static int mesh_file_open_plain(const char *path, int64_t most, int64_t *size,
                                struct failure *failure)
{
    struct stat st;
    int fd = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC); // of a FIFO it would wait
    if (fd < 0 || fstat(fd, &st))
        failure_set(failure, EX_NOINPUT, "%s: cannot be read: %s", path, strerror(errno));
    else if (!S_ISREG(st.st_mode))
        failure_set(failure, EX_NOINPUT, "%s: no plain file: a mesh is not read from a %s", path,
                    S_ISDIR(st.st_mode) ? "directory" : "pipe or device");
    else if (st.st_size > most)
        failure_set(failure, EX_DATAERR, "%s: meshes of more than %d bytes in all", path,
                    MESH_BYTES_MOST);
    else
        return *size = st.st_size, fd;
    if (fd >= 0) close(fd);
    return -1;
}

/* The bytes that the file had when it was opened, and a 0 */
static char *slurp(int fd, const char *path, int64_t size, int64_t *n, struct failure *failure)
{
    char *bytes = malloc((size_t)size + 1);
    if (!bytes)
        failure_set(failure, EX_SOFTWARE, "%s: no memory for %lld bytes", path, (long long)size);
    for (*n = 0; bytes && *n < size;) {
        ssize_t more = read(fd, bytes + *n, (size_t)(size - *n));
        if (more < 0 && errno == EINTR) continue;
        if (more < 0)
            failure_set(failure, EX_NOINPUT, "%s: cannot be read: %s", path, strerror(errno));
        if (more <= 0) break;
        *n += more;
    }
    if (bytes) bytes[*n] = 0;
    return bytes;
}

static int read_path(struct mesh *to, struct scene_files *files, const char *path, double scale,
                     int32_t *left_out, struct failure *failure)
{
    int64_t size, n;
    int fd = mesh_file_open_plain(path, MESH_BYTES_MOST - files->mesh_bytes, &size, failure);
    if (fd < 0) return failure->status;
    files->mesh_bytes += size;
    char *bytes = slurp(fd, path, size, &n, failure);
    close(fd);
    const struct mesh_bytes all = { path, bytes, n, scale };
    if (!failure->status) mesh_bytes_read(to, files, &all, left_out, failure);
    free(bytes);
    return failure->status;
}

int mesh_file_read(struct mesh *to, struct scene_files *files, const char *name, double scale,
                   int32_t *left_out, struct failure *failure)
{
    char *path = scene_path(files->dir, name);
    if (!path) return failure_set(failure, EX_SOFTWARE, "no memory for a name");
    read_path(to, files, path, scale, left_out, failure);
    free(path);
    return failure->status;
}

int mesh_files_read(struct scene *s, struct scene_files *files, struct failure *failure)
{
    for (int32_t k = 0; k < s->meshes && !failure->status; k++) {
        struct scene_mesh *m = &s->mesh_file[k];
        struct wall *w = &s->wall[m->wall];
        w->first_element = s->mesh.elements;
        files->parts = m->groups ? &s->names : NULL, files->wall = m->wall;
        if (mesh_file_read(&s->mesh, files, m->file, m->scale, &m->left_out, failure))
            return failure->status;
        w->elements = s->mesh.elements - w->first_element;
    }
    return 0;
}
