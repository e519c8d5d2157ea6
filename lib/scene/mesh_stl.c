/*
 * scene/mesh_stl.c: STL, by text or binary. [3D Systems, StereoLithography Interface Specification, 1989]
 *
 *     solid NAME                                      80 bytes of anything
 *     facet normal X Y Z                              u32 number of triangles, and of each:
 *     outer loop                                        f32[3] normal
 *     vertex X Y Z        three of these                f32[3][3] corners
 *     endloop endfacet    ...                           u16 of anything
 *     endsolid NAME       more solids may follow
 *
 * Normals are not believed: what they say is in the order of the corners. A binary file may begin with "solid",
 * too: its number of triangles has a zero byte, which no text has.
 */
#include "scene/mesh_file.h"

#include <stdio.h>
#include <string.h>

enum { HEADER = 84, TRIANGLE = 50 };

/* ---- text ---- */

static bool is_text(const char *bytes, int64_t n)
{
    struct soup none = { 0 };
    struct words w = words_of(&none, bytes, n);
    struct word first;
    return words_any(&w, &first) && word_is(first, "solid") &&
           !memchr(bytes, 0, (size_t)(n < HEADER ? n : HEADER));
}

static int want(struct words *w, const char *what)
{
    struct word word;
    if (!words_any(w, &word))
        return soup_fault(w->soup, "ends where %s should be: the file is cut off", what);
    if (word_is(word, what)) return 0;
    char trouble[60];
    snprintf(trouble, sizeof trouble, "where %s should be%s", what,
             strstr("vertex endloop", what) ? ": a facet has three corners" : "");
    return word_fault(w, word, trouble);
}

static int past_normal(struct words *w)
{
    struct word word;
    for (int k = 0; k < 5 && words_any(w, &word); k++)
        if (word_is(word, "outer")) return 0;
    return soup_fault(w->soup, "a facet without outer loop");
}

/* Behind the word facet */
static int read_facet(struct words *w)
{
    int64_t corner[3];
    double x[3];
    if (past_normal(w) || want(w, "loop")) return 1;
    for (int k = 0; k < 3; k++) {
        if (want(w, "vertex")) return 1;
        for (int i = 0; i < 3; i++)
            if (words_number(w, &x[i])) return 1;
        corner[k] = w->soup->corners;
        if (soup_corner(w->soup, v3(x[0], x[1], x[2]))) return 1;
    }
    return want(w, "endloop") || want(w, "endfacet") || soup_polygon(w->soup, corner, 3);
}

static int mesh_stl_read_solid(struct words *w)
{
    struct word word;
    words_line(w); // past the name
    while (words_any(w, &word)) {
        if (word_is(word, "endsolid")) return words_line(w), 0;
        if (!word_is(word, "facet"))
            return word_fault(w, word, "where facet or endsolid should be");
        if (read_facet(w)) return 1;
    }
    return soup_fault(w->soup, "ends without endsolid: the file is cut off");
}

static int read_text(struct soup *s, const char *bytes, int64_t n)
{
    struct words w = words_of(s, bytes, n);
    struct word word;
    while (words_any(&w, &word)) {
        if (!word_is(word, "solid")) return word_fault(&w, word, "where solid should be");
        if (mesh_stl_read_solid(&w)) return 1;
    }
    return 0;
}

/* ---- binary ---- */

static int64_t mesh_stl_size_of(const char *bytes)
{
    return HEADER + TRIANGLE * (int64_t)bytes_number(bytes + 80, BYTES_U32, false);
}

static int read_binary(struct soup *s, const char *bytes, int64_t n)
{
    if (n < HEADER)
        return soup_fault(s, "no STL: %lld bytes that do not begin with solid", (long long)n);
    if (!memchr(bytes, 0, HEADER))
        return soup_fault(s, "no STL: text that does not begin with solid");
    int64_t size = mesh_stl_size_of(bytes), triangles = (size - HEADER) / TRIANGLE;
    if (n < size)
        return soup_fault(s,
                          "cut off, or no STL: %lld bytes, which should be %lld for %lld triangles",
                          (long long)n, (long long)size, (long long)triangles);
    if (n > size)
        return soup_fault(s, "%lld bytes behind the last of its %lld triangles",
                          (long long)(n - size), (long long)triangles);
    s->unit = "triangle", s->single = true;
    for (s->at = 1; s->at <= triangles; s->at++) {
        const char *at = bytes + HEADER + TRIANGLE * (s->at - 1) + 12;
        int64_t corner[3] = { s->corners, s->corners + 1, s->corners + 2 };
        for (int k = 0; k < 3; k++, at += 12)
            if (soup_corner(s, v3(bytes_number(at, BYTES_F32, false),
                                  bytes_number(at + 4, BYTES_F32, false),
                                  bytes_number(at + 8, BYTES_F32, false))))
                return 1;
        if (soup_polygon(s, corner, 3)) return 1;
    }
    return 0;
}

static bool mesh_stl_looks(const char *bytes, int64_t n)
{
    return is_text(bytes, n) || (n >= HEADER && mesh_stl_size_of(bytes) == n);
}

static int mesh_stl_read(struct soup *s, const char *bytes, int64_t n)
{
    return is_text(bytes, n) ? read_text(s, bytes, n) : read_binary(s, bytes, n);
}

const struct mesh_format mesh_stl = { "STL", ".stl", mesh_stl_looks, mesh_stl_read };
