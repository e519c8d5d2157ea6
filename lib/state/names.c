#include "state/names.h"

#include <stdlib.h>
#include <string.h>

void names_free(struct names *s)
{
    for (int32_t k = 0; k < s->n; k++) free(s->text[k]);
    free(s->text), free(s->row);
    *s = (struct names){ 0 };
}

static int names_no_memory(struct failure *failure)
{
    return failure_set(failure, EX_SOFTWARE, "no memory for names");
}

static int add_text(struct names *s, const char *text, size_t n, struct failure *failure)
{
    char **more = realloc(s->text, ((size_t)s->n + 1) * sizeof *more);
    if (!more) return names_no_memory(failure);
    s->text = more;
    if (!(s->text[s->n] = strndup(text, n))) return names_no_memory(failure);
    s->n++;
    return 0;
}

static int names_add_row(struct names *s, struct named row, struct failure *failure)
{
    struct named *more = realloc(s->row, ((size_t)s->rows + 1) * sizeof *more);
    if (!more) return names_no_memory(failure);
    s->row = more;
    s->row[s->rows++] = row;
    return 0;
}

int names_copy(struct names *to, const struct names *from, struct failure *failure)
{
    *to = (struct names){ 0 };
    for (int32_t k = 0; k < from->n; k++)
        if (add_text(to, from->text[k], strlen(from->text[k]), failure)) goto fail;
    for (int32_t k = 0; k < from->rows; k++)
        if (names_add_row(to, from->row[k], failure)) goto fail;
    return 0;
fail:
    names_free(to);
    return failure->status;
}

/* Bytes of the character at s, of which there are n; 0: no UTF-8, or a character that controls a terminal */
static size_t names_character(const unsigned char *s, size_t n)
{
    size_t length = s[0] < 0x80 ? 1 : s[0] < 0xc2 ? 0 : s[0] < 0xe0 ? 2 : s[0] < 0xf0 ? 3 : 4;
    if (!length || length > n || s[0] > 0xf4 || s[0] < ' ' || s[0] == 0x7f) return 0;
    for (size_t k = 1; k < length; k++)
        if ((s[k] & 0xc0) != 0x80) return 0;
    if (s[0] == 0xc2 && s[1] < 0xa0) return 0;                                    // C1
    if ((s[0] == 0xe0 && s[1] < 0xa0) || (s[0] == 0xf0 && s[1] < 0x90)) return 0; // overlong
    if ((s[0] == 0xed && s[1] > 0x9f) || (s[0] == 0xf4 && s[1] > 0x8f)) return 0; // no characters
    return length;
}

const char *name_trouble_of_material(const char *text, size_t n)
{
    if (!n) return "is empty";
    if (n > NAME_BYTES) return "is longer than 60 bytes";
    for (size_t i = 0, length; i < n; i += length) {
        if (!(length = names_character((const unsigned char *)text + i, n - i)))
            return "has a control character, or is not UTF-8";
        if (strchr(",\"\\", text[i])) return "has a comma, a quote or a backslash";
    }
    return text[0] == ' ' || text[n - 1] == ' ' ? "begins or ends with a blank" : NULL;
}

const char *name_trouble(const char *text, size_t n)
{
    const char *trouble = name_trouble_of_material(text, n);
    if (trouble) return trouble;
    return strspn(text, "0123456789") >= n ? "is a number, as walls have without a name" : NULL;
}

int32_t names_find(const struct names *s, const char *text, size_t n)
{
    for (int32_t k = 0; k < s->n; k++)
        if (!strncmp(s->text[k], text, n) && !s->text[k][n]) return k;
    return -1;
}

int names_add(struct names *s, const char *text, int32_t *which, struct failure *failure)
{
    size_t n = strlen(text);
    const char *trouble = name_trouble(text, n);
    if (trouble) return failure_set(failure, EX_DATAERR, "a name %s", trouble);
    *which = names_find(s, text, n);
    if (*which >= 0) return 0;
    if (s->n == NAMES_MOST)
        return failure_set(failure, EX_DATAERR, "more than %d names", NAMES_MOST);
    *which = s->n;
    return add_text(s, text, n, failure);
}

int names_give(struct names *s, const char *text, int32_t wall, int32_t first, int32_t count,
               struct failure *failure)
{
    int32_t name;
    if (names_add(s, text, &name, failure)) return failure->status;
    if (s->rows == NAMED_MOST)
        return failure_set(failure, EX_DATAERR, "names of more than %d ranges of faces",
                           NAMED_MOST);
    return names_add_row(s, (struct named){ name, wall, first, count }, failure);
}

static int names_compare(const void *a, const void *b)
{
    const struct named *x = a, *y = b;
    if (x->name != y->name) return x->name < y->name ? -1 : 1;
    if (x->wall != y->wall) return x->wall < y->wall ? -1 : 1;
    if ((x->count == 0) != (y->count == 0)) return x->count ? 1 : -1; // a whole one first
    return (x->first > y->first) - (x->first < y->first);
}

void names_settle(struct names *s)
{
    int32_t n = 0;
    if (s->rows) qsort(s->row, (size_t)s->rows, sizeof *s->row, names_compare);
    for (int32_t k = 0; k < s->rows; k++) {
        struct named *last = n ? &s->row[n - 1] : NULL, now = s->row[k];
        bool same = last && last->name == now.name && last->wall == now.wall;
        if (same && !last->count) continue;
        if (same && now.first <= last->first + last->count) {
            int32_t end = now.first + now.count;
            if (end > last->first + last->count) last->count = end - last->first;
            continue;
        }
        s->row[n++] = now;
    }
    s->rows = n;
}

int names_check(const struct names *s, int32_t walls, const struct wall *wall,
                struct failure *failure)
{
    for (int32_t k = 0; k < s->n; k++) {
        const char *trouble = name_trouble(s->text[k], strlen(s->text[k]));
        if (trouble) return failure_set(failure, EX_DATAERR, "name %d %s", k, trouble);
        if (names_find(s, s->text[k], strlen(s->text[k])) != k)
            return failure_set(failure, EX_DATAERR, "name \"%s\" occurs twice", s->text[k]);
    }
    for (int32_t k = 0; k < s->rows; k++) {
        const struct named *r = &s->row[k], *last = k ? r - 1 : NULL;
        if (r->name < 0 || r->name >= s->n || r->wall < 0 || r->wall >= walls)
            return failure_set(failure, EX_DATAERR, "names: no such name, or no such wall");
        const struct wall *w = &wall[r->wall];
        int32_t faces = w->shape == WALL_MESH ? w->elements : 0;
        if (r->first < 0 || r->count < 0 || r->first > faces || r->count > faces - r->first ||
            (!r->count && r->first))
            return failure_set(failure, EX_DATAERR,
                               "name \"%s\": wall %d has no such faces, it has %d",
                               s->text[r->name], r->wall, faces);
        bool same = last && last->name == r->name && last->wall == r->wall;
        if (last && (names_compare(last, r) >= 0 ||
                     (same && (!last->count || r->first < last->first + last->count))))
            return failure_set(failure, EX_DATAERR, "names: not sorted, or a face twice");
    }
    return 0;
}

const char *names_of_wall(const struct names *s, int32_t wall)
{
    for (int32_t k = 0; k < s->rows; k++)
        if (s->row[k].wall == wall && !s->row[k].count) return s->text[s->row[k].name];
    return NULL;
}

const char *names_of_face(const struct names *s, int32_t wall, int32_t face)
{
    for (int32_t k = s->rows - 1; k >= 0;
         k--) { // an object's name comes before those of its groups
        const struct named *r = &s->row[k];
        if (r->wall == wall && face >= r->first && face < r->first + r->count)
            return s->text[r->name];
    }
    return names_of_wall(s, wall);
}
