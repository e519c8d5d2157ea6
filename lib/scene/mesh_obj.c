/*
 * scene/mesh_obj.c: Wavefront's OBJ. [Wavefront, Advanced Visualizer 3.0, appendix B1]
 *
 *     v X Y Z          a corner; what is behind it, a weight or a colour, is passed over
 *     f A B C ...      a polygon of corners: A is A/texture/normal, from 1; -1 is the last one so far
 *
 *     o NAME           polygons that follow are of this object
 *     g NAME ...       and in these groups; "default" is none
 *
 * Lines, points, materials and words unknown are passed over; curves, free-form surfaces and other files
 * (call) are not: without them the surface has holes. The format has no end: of a file that is cut off between
 * two lines nothing tells.
 */
#include "scene/mesh_file.h"

#include "scene/ears.h"

#include <stdlib.h>
#include <string.h>

static bool mesh_obj_is_among(struct word word, const char *const *list)
{
    for (; *list; list++)
        if (word_is(word, *list)) return true;
    return false;
}

static int read_corner(struct words *w)
{
    double x[3];
    for (int k = 0; k < 3; k++)
        if (words_number(w, &x[k])) return 1;
    return soup_corner(w->soup, v3(x[0], x[1], x[2]));
}

/* A, A/B, A//C or A/B/C: A, from 0 */
static int read_index(struct words *w, struct word word, int64_t *corner)
{
    const char *slash = memchr(word.s, '/', (size_t)word.n);
    struct word first = { word.s, slash ? (int)(slash - word.s) : word.n };
    char *end;
    int64_t i = strtoll(first.s, &end, 10);
    if (!first.n || end != first.s + first.n || !i)
        return word_fault(w, word, "is no number of a corner (1 is the first, -1 the last)");
    int slashes = 0;
    for (int k = 0; k < word.n; k++) slashes += word.s[k] == '/';
    if (slashes > 2 || !word_has_only(word, "/+-0123456789"))
        return word_fault(w, word, "is no corner A/B/C");
    *corner = i > 0 ? i - 1 : w->soup->corners + i;
    return 0;
}

static int mesh_obj_read_face(struct words *w)
{
    int64_t corner[POLYGON_CORNERS_MOST + 1], n = 0;
    struct word word;
    while (n <= POLYGON_CORNERS_MOST && words_next(w, &word))
        if (read_index(w, word, &corner[n++])) return 1;
    return soup_polygon(w->soup, corner, n);
}

/* The names of an object (0), or of groups (1) */
static int mesh_obj_read_names(struct words *w, int which)
{
    struct word word;
    if (!w->soup->grouped) return 0;
    soup_no_label(w->soup, which);
    while (words_next(w, &word)) {
        bool none = word_is(word, "default") || word_is(word, "(null)") || word_is(word, "off");
        if (!none && soup_label(w->soup, which, word.s, word.n)) return 1;
        if (!which) break;
    }
    return 0;
}

static const char *const curved[] = { "cstype", "curv", "curv2", "surf", "bzp",
                                      "bsp",    "cdc",  "cdp",   "res",  NULL };

static int mesh_obj_read(struct soup *s, const char *bytes, int64_t n)
{
    struct words w = words_of(s, bytes, n);
    w.joined = w.comments = true;
    do {
        struct word word;
        if (!words_next(&w, &word)) continue;
        if (word_is(word, "v")                          ? read_corner(&w)
            : word_is(word, "f") || word_is(word, "fo") ? mesh_obj_read_face(&w)
            : word_is(word, "o") || word_is(word, "g") ? mesh_obj_read_names(&w, word_is(word, "g"))
            : word_is(word, "call")
                ? word_fault(&w, word, "names another file, and no other is read")
                : mesh_obj_is_among(word, curved) &&
                      word_fault(&w, word, "is free-form geometry: write the surface as polygons"))
            return 1;
    } while (words_line(&w));
    return 0;
}

static bool mesh_obj_looks(const char *bytes, int64_t n)
{
    static const char *const usual[] = { "v", "vt", "vn",     "vp",     "f", "g",
                                         "o", "s",  "mtllib", "usemtl", NULL };
    struct soup none = { 0 };
    struct words w = words_of(&none, bytes, n);
    struct word word;
    w.comments = true;
    return !memchr(bytes, 0, (size_t)(n < 512 ? n : 512)) && words_any(&w, &word) &&
           mesh_obj_is_among(word, usual);
}

const struct mesh_format mesh_obj = { "OBJ", ".obj", mesh_obj_looks, mesh_obj_read };
