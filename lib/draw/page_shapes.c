/* draw/page_shapes.c: shapes as triangles, by draw/facets.h [draw/page_shapes.h]. */
#include "draw/page_shapes.h"

#include "draw/facets.h"

#include <stdlib.h>

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
