/*
 * scene/mesh_ply.c: PLY, by text or binary, of either byte order. [Turk, The PLY Polygon File Format, 1994]
 *
 *     ply
 *     format ascii 1.0           or binary_little_endian, binary_big_endian
 *     comment ...
 *     element vertex 8           elements of any name, in any order, of any properties
 *     property float x
 *     element face 6
 *     property list uchar int vertex_indices
 *     end_header
 *
 * and then the elements, by text one a line. Taken are x, y and z of vertex and vertex_indices (vertex_index)
 * of face. Elements are gone through twice, for faces may be in front of vertices.
 */
#include "scene/mesh_file.h"

#include "scene/ears.h"

#include <string.h>

enum {
    ELEMENTS_MOST = 32,
    PROPERTIES_MOST = 256 /* of all elements */
};

/* What is taken: the places of x, y and z, and the list of corners */
enum mesh_ply_role { NOTHING = -1, X, Y, Z, CORNERS, ROLES };
static const char *const role_name[ROLES] = { "x", "y", "z", "vertex_indices" };

struct property {
    enum mesh_ply_role role;
    enum bytes_type type;
    bool list;
    enum bytes_type count; /* of a list */
};

struct element {
    enum { OTHER, VERTEX, FACE } kind;
    int64_t n;
    int first, end; /* properties */
};

struct ply {
    struct soup *soup;
    struct words w; /* of the header, and of elements by text */
    enum { ASCII, LITTLE_ENDIAN_BYTES, BIG_ENDIAN_BYTES } form;
    int elements, properties;
    struct element element[ELEMENTS_MOST];
    struct property property[PROPERTIES_MOST];
};

/* ---- the header ---- */

static bool mesh_ply_looks(const char *bytes, int64_t n)
{
    struct soup none = { 0 };
    struct words w = words_of(&none, bytes, n);
    struct word first, more;
    return words_next(&w, &first) && word_is(first, "ply") && !words_next(&w, &more);
}

/* Which of n names the next word is, where a name may be two with a blank between; -1: a fault */
static int next_among(struct words *w, const char *const *names, int n)
{
    struct word word;
    if (!words_next(w, &word)) return soup_fault(w->soup, "a word is missing"), -1;
    for (int k = 0; k < n; k++) {
        const char *s = names[k];
        for (size_t length; (length = strcspn(s, " ")); s += length, s += *s == ' ')
            if (length == (size_t)word.n && !memcmp(s, word.s, length)) return k;
    }
    return word_fault(w, word, "is not known here"), -1;
}

static int read_type(struct words *w, enum bytes_type *type)
{
    static const char *const names[BYTES_TYPES] = { "char int8",     "uchar uint8",   "short int16",
                                                    "ushort uint16", "int int32",     "uint uint32",
                                                    "float float32", "double float64" };
    int k = next_among(w, names, BYTES_TYPES);
    if (k >= 0) *type = (enum bytes_type)k;
    return k < 0;
}

static int mesh_ply_read_format(struct ply *p)
{
    static const char *const names[] = { "ascii", "binary_little_endian", "binary_big_endian" };
    struct word version;
    int k = next_among(&p->w, names, 3);
    if (k < 0) return 1;
    p->form = k == 0 ? ASCII : k == 1 ? LITTLE_ENDIAN_BYTES : BIG_ENDIAN_BYTES;
    if (!words_next(&p->w, &version) || !word_is(version, "1.0"))
        return soup_fault(p->soup, "a PLY of another version than 1.0");
    return 0;
}

static int read_element(struct ply *p)
{
    struct word name;
    if (p->elements == ELEMENTS_MOST)
        return soup_fault(p->soup, "more than %d elements", ELEMENTS_MOST);
    struct element *e = &p->element[p->elements++];
    if (!words_next(&p->w, &name)) return soup_fault(p->soup, "an element without a name");
    e->kind = word_is(name, "vertex") ? VERTEX : word_is(name, "face") ? FACE : OTHER;
    e->first = e->end = p->properties;
    for (int k = 0; k < p->elements - 1; k++)
        if (e->kind && p->element[k].kind == e->kind) return word_fault(&p->w, name, "comes twice");
    if (words_whole(&p->w, &e->n)) return 1;
    return e->n >= 0 ? 0 : soup_fault(p->soup, "a negative number of elements");
}

static enum mesh_ply_role role_of(const struct element *e, struct word name, bool list)
{
    for (int k = X; k <= Z && e->kind == VERTEX && !list; k++)
        if (word_is(name, role_name[k])) return (enum mesh_ply_role)k;
    bool corners = word_is(name, "vertex_indices") || word_is(name, "vertex_index");
    return e->kind == FACE && list && corners ? CORNERS : NOTHING;
}

static bool is_whole(enum bytes_type type)
{
    return type < BYTES_F32;
}

static int read_property(struct ply *p)
{
    struct words list = p->w;
    struct word word;
    struct property new = { 0 };
    if (!p->elements) return soup_fault(p->soup, "a property of no element");
    if (p->properties == PROPERTIES_MOST)
        return soup_fault(p->soup, "more than %d properties", PROPERTIES_MOST);
    if ((new.list = words_next(&list, &word) && word_is(word, "list"))) p->w = list;
    if ((new.list &&read_type(&p->w, &new.count)) || read_type(&p->w, &new.type)) return 1;
    if (!words_next(&p->w, &word)) return soup_fault(p->soup, "a property without a name");
    struct element *e = &p->element[p->elements - 1];
    new.role = role_of(e, word, new.list);
    if ((new.list && !is_whole(new.count)) || (new.role == CORNERS && !is_whole(new.type)))
        return word_fault(&p->w, word, "is a list with a number or corners that are not whole");
    for (int k = e->first; k < e->end; k++)
        if (new.role != NOTHING && p->property[k].role == new.role)
            return word_fault(&p->w, word, "comes twice");
    p->property[p->properties++] = new;
    e->end = p->properties;
    return 0;
}

static bool mesh_ply_has(const struct ply *p, int kind, enum mesh_ply_role role)
{
    for (int i = 0; i < p->elements; i++)
        for (int k = p->element[i].first; k < p->element[i].end; k++)
            if ((int)p->element[i].kind == kind && p->property[k].role == role) return true;
    return false;
}

static int check_header(struct ply *p)
{
    for (enum mesh_ply_role r = X; r < ROLES; r++)
        if (!mesh_ply_has(p, r == CORNERS ? FACE : VERTEX, r))
            return soup_fault(p->soup, "no %s of %s", role_name[r],
                              r == CORNERS ? "face: strips and clouds of points are not read"
                                           : "vertex");
    for (int i = 0; i < p->elements; i++)
        if (p->element[i].first == p->element[i].end && p->element[i].n)
            return soup_fault(p->soup, "elements without a property");
    return 0;
}

static int read_header(struct ply *p)
{
    static const char *const names[] = { "format", "element", "property", "comment obj_info",
                                         "end_header" };
    bool format = false;
    if (!mesh_ply_looks(p->w.at, p->w.end - p->w.at))
        return soup_fault(p->soup, "no PLY: it begins otherwise");
    while (words_line(&p->w)) {
        struct word none;
        struct words line = p->w;
        if (!words_next(&line, &none)) continue;
        int k = next_among(&p->w, names, 5);
        if (k < 0) return 1;
        if (k == 4 && !format) return soup_fault(p->soup, "a header without format");
        if (k == 4)
            return words_line(&p->w) ? check_header(p)
                                     : soup_fault(p->soup, "ends with its header");
        if (k == 0   ? mesh_ply_read_format(p)
            : k == 1 ? read_element(p)
                     : k == 2 && read_property(p))
            return 1;
        format |= k == 0;
        if (k != 3 && words_next(&p->w, &none)) return word_fault(&p->w, none, "is too much");
    }
    return soup_fault(p->soup, "ends within its header: the file is cut off");
}

/* ---- the elements ---- */

static int next_number(struct ply *p, enum bytes_type type, double *x)
{
    struct words *w = &p->w;
    if (p->form == ASCII) {
        if (words_number(w, x)) return 1;
        bool bad = is_whole(type) && !(*x == floor(*x) && fabs(*x) < 1e15);
        return bad ? soup_fault(p->soup, "%g is no whole number", *x) : 0;
    }
    if (w->end - w->at < bytes_size[type]) return soup_fault(p->soup, "the file is cut off here");
    *x = bytes_number(w->at, type, p->form == BIG_ENDIAN_BYTES);
    w->at += bytes_size[type];
    return 0;
}

/* What is not taken may be anything. */
static int pass_over(struct ply *p, enum bytes_type type)
{
    struct word word;
    double x;
    if (p->form != ASCII) return next_number(p, type, &x);
    return words_next(&p->w, &word) ? 0 : soup_fault(p->soup, "fewer numbers than properties");
}

/* A list: into corner[] its first numbers, one more than a polygon may have; *n: how many there are */
static int next_list(struct ply *p, const struct property *q, int64_t corner[], int64_t *n)
{
    double count = 0, x = 0;
    if (next_number(p, q->count, &count)) return 1;
    if (count < 0) return soup_fault(p->soup, "a list of %g numbers", count);
    *n = (int64_t)count;
    for (int64_t i = 0; i < *n; i++) {
        if (q->role == CORNERS ? next_number(p, q->type, &x) : pass_over(p, q->type)) return 1;
        if (q->role == CORNERS && i <= POLYGON_CORNERS_MOST) corner[i] = (int64_t)x;
    }
    return 0;
}

/* One element; it is put into the soup if it is to be taken */
static int next_element(struct ply *p, const struct element *e, bool taken)
{
    double x[3] = { 0 };
    int64_t corner[POLYGON_CORNERS_MOST + 1], corners = 0, n = 0;
    for (int k = e->first; k < e->end; k++) {
        const struct property *q = &p->property[k];
        bool place = !q->list && q->role != NOTHING;
        if (q->list ? next_list(p, q, corner, &n)
            : place ? next_number(p, q->type, &x[q->role])
                    : pass_over(p, q->type))
            return 1;
        if (q->role == CORNERS) corners = n;
        p->soup->single |= place && q->type == BYTES_F32 && p->form != ASCII;
    }
    if (!taken) return 0;
    if (e->kind == VERTEX) return soup_corner(p->soup, v3(x[0], x[1], x[2]));
    return soup_polygon(p->soup, corner, corners);
}

/* By text: to the next line that has something on it, and the end of an element's line */
static int begin_line(struct ply *p)
{
    struct word word;
    if (!words_any(&p->w, &word))
        return soup_fault(p->soup, "ends before its last element: the file is cut off");
    p->w.at = word.s;
    return 0;
}

static int end_line(struct ply *p)
{
    struct word word;
    return words_next(&p->w, &word) && word_fault(&p->w, word, "is too much for an element");
}

/* Goes through all elements, and takes those of a kind. */
static int go_through(struct ply *p, int kind)
{
    for (int i = 0; i < p->elements; i++) {
        const struct element *e = &p->element[i];
        bool taken = (int)e->kind == kind;
        if (p->form != ASCII)
            p->soup->unit = e->kind == VERTEX ? "vertex" : e->kind == FACE ? "face" : "element";
        for (int64_t k = 1; k <= e->n; k++) {
            if (p->form != ASCII) p->soup->at = k;
            if ((p->form == ASCII && begin_line(p)) || next_element(p, e, taken) ||
                (p->form == ASCII && end_line(p)))
                return 1;
        }
    }
    return 0;
}

static int mesh_ply_read(struct soup *s, const char *bytes, int64_t n)
{
    struct ply p = { .soup = s, .w = words_of(s, bytes, n) };
    struct word rest;
    if (read_header(&p)) return 1;
    struct words body = p.w;
    int64_t line = s->at;
    if (go_through(&p, VERTEX)) return 1;
    p.w = body, s->at = line;
    if (go_through(&p, FACE)) return 1;
    if (p.form != ASCII) s->unit = NULL;
    if (p.form != ASCII && p.w.at < p.w.end)
        return soup_fault(s, "%lld bytes behind the last element", (long long)(p.w.end - p.w.at));
    return p.form == ASCII && words_any(&p.w, &rest)
               ? word_fault(&p.w, rest, "behind the last element")
               : 0;
}

const struct mesh_format mesh_ply = { "PLY", ".ply", mesh_ply_looks, mesh_ply_read };
