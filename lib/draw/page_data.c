/* draw/page_data.c: the element "meta" of a page [draw/page_data.h]. */
#include "draw/page_data.h"

#include "base/json.h"
#include "draw/facets.h"

#include <jansson.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

void chunk_put(struct chunk *b, const void *from, size_t size)
{
    memcpy(b->at + b->n, from, size), b->n += size;
}

void chunk_put_float(struct chunk *b, double x)
{
    float single = (float)x;
    chunk_put(b, &single, sizeof single);
}

void chunk_put_u16(struct chunk *b, int x)
{
    uint16_t number = (uint16_t)x;
    chunk_put(b, &number, sizeof number);
}

int chunk_quantise(double x, double most, int steps)
{
    double k = most > 0 ? x / most * steps : 0;
    return isfinite(k) ? (int)lround(fmin(fmax(k, -steps), steps)) : 0;
}

static void write_base64(FILE *out, const unsigned char *x, size_t n)
{
    static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < n; i += 3) {
        unsigned b = (unsigned)x[i] << 16 | (i + 1 < n ? (unsigned)x[i + 1] << 8 : 0) |
                     (i + 2 < n ? x[i + 2] : 0);
        char four[4] = { digit[b >> 18], digit[b >> 12 & 63], i + 1 < n ? digit[b >> 6 & 63] : '=',
                         i + 2 < n ? digit[b & 63] : '=' };
        fwrite(four, 1, 4, out);
    }
}

int chunk_write(FILE *out, char letter, int64_t number, const struct chunk *b)
{
    uLongf size = compressBound(b->n);
    unsigned char *packed = malloc(size);
    bool good = packed && compress2(packed, &size, b->at, b->n, 6) == Z_OK;
    if (good) {
        fprintf(out, "<script type=\"text/plain\" id=\"%c%lld\">", letter, (long long)number);
        write_base64(out, packed, size);
        fputs("</script>\n", out);
    }
    free(packed);
    return good ? 0 : -1;
}

static json_t *vec_json(vec3 x)
{
    const double three[3] = { x.x, x.y, x.z };
    return json_numbers(three, 3);
}

static json_t *cell_json(const struct page_moment *m)
{
    json_t *j = json_pack("{s:[b,b,b]}", "repeats", m->repeats[0], m->repeats[1], m->repeats[2]);
    json_object_set_new(j, "origin", vec_json(m->origin));
    json_object_set_new(
        j, "edge",
        json_pack("[o,o,o]", vec_json(m->edge[0]), vec_json(m->edge[1]), vec_json(m->edge[2])));
    return j;
}

static json_t *moment_json(const struct page_moment *m)
{
    json_t *j =
        json_pack("{s:I, s:I, s:I, s:I, s:o}", "s", (json_int_t)m->step, "n", (json_int_t)m->n, "c",
                  (json_int_t)m->contacts, "g", (json_int_t)m->grains, "t", json_number(m->t));
    if (m->walls >= 0) json_object_set_new(j, "b", json_integer(m->walls));
    if (m->shapes >= 0) json_object_set_new(j, "h", json_integer(m->shapes));
    if (m->repeats[0] || m->repeats[1] || m->repeats[2])
        json_object_set_new(j, "cell", cell_json(m));
    json_object_set_new(j, "lo", json_numbers(m->lo, 3));
    json_object_set_new(j, "step", json_numbers(m->quantum, 3));
    json_object_set_new(j, "vmax", json_number(m->vmax));
    json_object_set_new(j, "wmax", json_number(m->wmax));
    json_object_set_new(j, "fmax", json_number(m->fmax));
    return j;
}

static json_t *range_json(const struct page *p)
{
    const double lo[3] = { p->seen.lo.x, p->seen.lo.y, p->seen.lo.z },
                 hi[3] = { p->seen.hi.x, p->seen.hi.y, p->seen.hi.z };
    json_t *j =
        json_pack("{s:o, s:o, s:o, s:o, s:i}", "lo", json_numbers(lo, 3), "hi", json_numbers(hi, 3),
                  "speed", json_number(p->fastest), "spin", json_number(p->spin), "z", p->most);
    json_object_set_new(j, "radius", json_numbers(p->radius, 2));
    json_object_set_new(j, "force", json_number(p->force));
    json_object_set_new(j, "push", json_number(p->push));
    return j;
}

/* What a reader has to know of the numbers: they are rounded. */
static json_t *said(const struct page *p)
{
    double most = 0, speed = 0;
    for (int64_t k = 0; k < p->frames; k++) {
        for (int j = 0; j < 3; j++) most = fmax(most, p->moment[k].quantum[j]);
        speed = fmax(speed, p->moment[k].vmax / I16);
    }
    char text[300];
    snprintf(text, sizeof text,
             "Numbers here are rounded: positions to %.2g m, velocities to %.2g m/s, orientations "
             "to 1/127, forces to 1/65535 of a frame's largest. The document has them whole.",
             most / 2, speed / 2);
    return json_string(text);
}

json_t *page_meta(const struct page *p)
{
    json_t *j = json_pack("{s:i, s:b}", "dim", p->dim, "solved", p->solved), *list = json_array();
    if ((p->dim == 2 ? p->up.y : p->up.z) != 1) // else the page knows
        json_object_set_new(j, "up", json_pack("[f, f, f]", p->up.x, p->up.y, p->up.z));
    for (int32_t k = 0; k < p->materials; k++) {
        json_t *name = json_string(p->material_name[k]);
        json_array_append_new(list, name ? name : json_string("?"));
    }
    json_object_set_new(j, "materials", list);
    json_object_set_new(j, "frames", list = json_array());
    for (int64_t k = 0; k < p->frames; k++) json_array_append_new(list, moment_json(&p->moment[k]));
    json_object_set_new(j, "range", range_json(p));
    json_object_set_new(j, "curves", list = json_object());
    for (int c = 0; c < p->curves; c++)
        json_object_set_new(list, p->curve[c].name,
                            json_pack("{s:s, s:o}", "unit", p->curve[c].unit, "value",
                                      json_numbers(p->curve[c].value, p->frames)));
    json_object_set_new(j, "said", said(p));
    return j;
}

/* ---- shapes as triangles, by draw/facets.h ---- */

enum { DETAIL = 2 }; /* of what is round */

struct triangles {
    struct chunk *corners;
    unsigned char *edges;
    int64_t n;
    bool
        sharp; /* all sides of polygons are edges; else in the plane that across from the middle, in space none */
    int dim;
};

static void page_data_put_fan(void *to, int corners, const vec3 *x)
{
    struct triangles *t = to;
    for (int k = 2; k < corners; k++) {
        const vec3 *corner[3] = { &x[0], &x[k - 1], &x[k] };
        for (int c = 0; c < 3; c++) {
            chunk_put_float(t->corners, corner[c]->x);
            chunk_put_float(t->corners, corner[c]->y);
            chunk_put_float(t->corners, corner[c]->z);
        }
        int sides = (k == 2) | 2 | (k == corners - 1) << 2;
        t->edges[t->n++] = (unsigned char)(t->sharp ? sides : t->dim == 2 ? 2 : 0);
    }
}

int page_shapes(struct chunk *b, int dim, const struct shapes *t, struct failure *failure)
{
    struct facets f;
    double radius = 1;
    int32_t row = 0;
    vec3 x = v3(0, 0, 0);
    quat q = { 1, 0, 0, 0 };
    struct packing one = { .dim = dim, .n = 1, .radius = &radius, .x = &x, .q = &q };
    one.shape = &row, one.shapes = *t; // a grain of each shape, one after another
    *b = (struct chunk){ 0 };
    if (facets_init(&f, DETAIL, failure)) return failure->status;
    int64_t all = 0;
    for (row = 1; row < t->n; row++) all += facets_triangles(&f, &one, 0);
    b->at = malloc(4 * ((size_t)t->n + 1) + 37 * (size_t)all);
    struct triangles s = { b, malloc((size_t)all + 1), 0, false, dim };
    if (b->at && s.edges) {
        uint32_t n = (uint32_t)t->n;
        chunk_put(b, &n, 4);
        for (row = 0; row < t->n; row++) {
            n = row ? (uint32_t)facets_triangles(&f, &one, 0) : 0;
            chunk_put(b, &n, 4);
        }
        for (row = 1; row < t->n; row++) {
            s.sharp = facets_are_faces(&t->s[row]);
            facets_of(&f, &one, 0, page_data_put_fan, &s);
        }
        chunk_put(b, s.edges, (size_t)s.n);
    } else {
        failure_set(failure, EX_SOFTWARE, "no memory for the shapes on a page");
    }
    free(s.edges);
    facets_free(&f);
    return failure->status;
}
