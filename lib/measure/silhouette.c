#include "measure/silhouette.h"

#include "base/output.h"
#include "measure/branch.h"
#include "measure/measures.h"
#include "measure/photo.h"
#include "state/placement.h"

#include <math.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>

enum { CLOSED = 7, BODIES_CUT = 10, PHOTO_CUT = 30 };

static const struct quantity quantities[] = {
    { "frames", "1", 1, "number of frames that are laid over each other" },
    { "area", "m2", 1, "area that bodies cover" },
    { "photo", "m2", 1, "area that is covered in the photograph" },
    { "differ", "m2", 1, "area that one of them covers and the other does not" },
    { "surplus", "m2", 1, "area that only bodies cover" },
    { "missing", "m2", 1, "area that only the photograph covers" },
    { "mirrored", "m2", 1, "area that differs if the photograph is mirrored left to right" },
    { 0 },
};

/* ---- the picture: pixels across and up, the first one at the lower left ---- */

struct canvas {
    int64_t w, h;
    double left, bottom, dx, dy; /* m: of the window; of a pixel */
    vec3 right, up;              /* axes of the picture */
};

static struct canvas canvas_of(const struct asked *a, int dim)
{
    struct canvas c = {
        .w = a->photo.w, .h = a->photo.h, .left = a->window[0], .bottom = a->window[2]
    };
    const double width = a->window[1] - a->window[0], height = a->window[3] - a->window[2];
    if (!a->photo.grey) {
        c.w = a->pixels;
        c.h = (int64_t)fmax(1, fmin(PHOTO_MOST, round((double)c.w * height / width)));
    }
    c.dx = width / (double)c.w, c.dy = height / (double)c.h;
    const int axis = dim == 2 ? 2 : a->view;
    c.right = axis == 0 ? v3(0, 1, 0) : v3(1, 0, 0);
    c.up = axis == 2 ? v3(0, 1, 0) : v3(0, 0, 1);
    return c;
}

/* The projection of a core: all points within `round` of a convex polygon */
struct outline {
    int32_t n;
    double (*x)[2]; /* [n] m: counterclockwise */
    double round;
};

static int by_place(const void *a, const void *b)
{
    const double *x = a, *y = b;
    if (x[0] != y[0]) return x[0] < y[0] ? -1 : 1;
    return (x[1] > y[1]) - (x[1] < y[1]);
}

static double turn_of(const double *a, const double *b, const double *c)
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* o->x = the corners of the convex hull of n points, by Andrew's monotone chain; hull has room for 2 n */
static void outline_hull(struct outline *o, double (*point)[2], int32_t n, double (*hull)[2])
{
    int32_t k = 0;
    qsort(point, (size_t)n, sizeof *point, by_place);
    for (int32_t pass = 0; pass < 2; pass++) {
        const int32_t first = k;
        for (int32_t i = 0; i < n; i++) {
            const double *p = point[pass ? n - 1 - i : i];
            while (k >= first + 2 && turn_of(hull[k - 2], hull[k - 1], p) <= 0) k--;
            hull[k][0] = p[0], hull[k++][1] = p[1];
        }
        if (n > 1) k--; // the other chain begins there
    }
    o->n = k, o->x = hull;
}

static double square_from_edge(const double *a, const double *b, const double *p)
{
    const double ex = b[0] - a[0], ey = b[1] - a[1], e = ex * ex + ey * ey;
    double s = e > 0 ? ((p[0] - a[0]) * ex + (p[1] - a[1]) * ey) / e : 0;
    s = fmax(0, fmin(1, s));
    const double x = p[0] - a[0] - s * ex, y = p[1] - a[1] - s * ey;
    return x * x + y * y;
}

static bool outline_holds(const struct outline *o, const double p[2])
{
    bool inside = o->n > 2;
    double least = INFINITY;
    for (int32_t i = 0; i < o->n; i++) {
        const double *a = o->x[i], *b = o->x[(i + 1) % o->n];
        inside = inside && turn_of(a, b, p) >= 0;
        least = fmin(least, square_from_edge(a, b, p));
    }
    return inside || least <= o->round * o->round;
}

/* ---- the pixels of a frame ---- */

/* The first and the last pixel whose centre lies from lo to hi; none: last < first */
static void span_of(double lo, double hi, double origin, double size, int64_t n, int64_t *first,
                    int64_t *last)
{
    const double a = ceil((lo - origin) / size - 0.5), b = floor((hi - origin) / size - 0.5);
    *first = a > 0 ? (int64_t)fmin(a, (double)n) : 0;
    *last = b < (double)(n - 1) ? (int64_t)fmax(b, -1) : n - 1;
}

/* mark[] = stamp at the pixels that the outline covers; each that had another is counted once more. */
static void cover_outline(uint32_t *cover, uint32_t *mark, uint32_t stamp, const struct canvas *c,
                          const struct outline *o)
{
    double lo[2] = { INFINITY, INFINITY }, hi[2] = { -INFINITY, -INFINITY };
    int64_t i0, i1, j0, j1;
    for (int32_t k = 0; k < o->n; k++)
        for (int m = 0; m < 2; m++)
            lo[m] = fmin(lo[m], o->x[k][m]), hi[m] = fmax(hi[m], o->x[k][m]);
    span_of(lo[0] - o->round, hi[0] + o->round, c->left, c->dx, c->w, &i0, &i1);
    span_of(lo[1] - o->round, hi[1] + o->round, c->bottom, c->dy, c->h, &j0, &j1);
    for (int64_t j = j0; j <= j1; j++)
        for (int64_t i = i0; i <= i1; i++) {
            const double p[2] = { c->left + ((double)i + 0.5) * c->dx,
                                  c->bottom + ((double)j + 0.5) * c->dy };
            if (mark[j * c->w + i] == stamp || !outline_holds(o, p)) continue;
            mark[j * c->w + i] = stamp, cover[j * c->w + i]++;
        }
}

static void flat(const struct canvas *c, vec3 x, double to[2])
{
    to[0] = v3_dot(x, c->right), to[1] = v3_dot(x, c->up);
}

/* Adds the bodies of a frame to cover[]; a pixel of a clump counts once. Returns 0 or EX_SOFTWARE. */
static int cover_frame(uint32_t *cover, const struct canvas *c, const struct snapshot *s,
                       struct failure *failure)
{
    const struct packing *p = s->p;
    const struct positions now = positions_now(p);
    struct placed placed;
    if (placed_init(&placed, p, &now, failure)) return failure->status;
    uint32_t *mark = calloc((size_t)(c->w * c->h), sizeof *mark);
    double(*point)[2] = malloc(3 * SHAPE_VERTICES_MOST * sizeof *point);
    if (!mark || !point) failure_set(failure, EX_SOFTWARE, "no memory for a picture");
    for (int64_t i = 0; i < p->n && !failure->status; i++)
        for (int32_t k = 0; k < placed_cores(&placed, i) && counts_body(s, i); k++) {
            const struct core core = placed_core(&placed, i, k);
            struct outline o = { .round = core.round };
            for (int32_t v = 0; v < core.n; v++) flat(c, core.v[v], point[v]);
            outline_hull(&o, point, core.n, point + core.n);
            cover_outline(cover, mark, (uint32_t)i + 1, c, &o);
        }
    free(mark), free(point);
    placed_free(&placed);
    return failure->status;
}

/* now->cover = that of s->before, and this frame's. Returns 0 or EX_SOFTWARE. */
static int silhouette_keep(struct frame_memory *now, const struct snapshot *s,
                           struct failure *failure)
{
    if (!(s->asked->window[1] > s->asked->window[0])) return 0;
    const struct canvas c = canvas_of(s->asked, s->p->dim);
    const size_t n = (size_t)(c.w * c.h);
    now->dim = s->p->dim;
    now->cover = calloc(n, sizeof *now->cover);
    if (!now->cover) return failure_set(failure, EX_SOFTWARE, "no memory for a picture");
    now->covered = 1;
    if (s->before && s->before->cover) {
        now->covered = s->before->covered + 1;
        memcpy(now->cover, s->before->cover, n * sizeof *now->cover);
    }
    return cover_frame(now->cover, &c, s, failure);
}

/* ---- what is covered ---- */

/* to[n] = the largest, or smallest, of the CLOSED values around each of from[n], `step` apart */
static void extreme(uint8_t *to, const uint8_t *from, int64_t n, int64_t step, bool largest)
{
    const int64_t half = CLOSED / 2;
    for (int64_t i = 0; i < n; i++) {
        uint8_t e = from[i * step];
        for (int64_t k = i > half ? i - half : 0; k <= i + half && k < n; k++) {
            const uint8_t x = from[k * step];
            e = largest == (x > e) ? x : e;
        }
        to[i * step] = e;
    }
}

static void close_gaps(uint8_t *a, uint8_t *other, int64_t w, int64_t h)
{
    for (int pass = 0; pass < 2; pass++) {
        for (int64_t j = 0; j < h; j++) extreme(other + j * w, a + j * w, w, 1, !pass);
        for (int64_t i = 0; i < w; i++) extreme(a + i, other + i, h, w, !pass);
    }
}

/* Does the pixel lie in the disc that is asked for? */
static bool counts_pixel(const struct canvas *c, const struct asked *a, int64_t i, int64_t j)
{
    double at[2];
    flat(c, a->point, at);
    return hypot(c->left + ((double)i + 0.5) * c->dx - at[0],
                 c->bottom + ((double)j + 0.5) * c->dy - at[1]) <= a->radius;
}

struct silhouette {
    uint8_t *body, *photo; /* [w * h] 1: covered */
};

static void silhouette_free(struct silhouette *s)
{
    free(s->body), free(s->photo);
}

/* Returns 0 or EX_SOFTWARE; to be freed in any case. */
static int silhouette_of(struct silhouette *s, const struct canvas *c, const struct asked *a,
                         const uint32_t *cover, struct failure *failure)
{
    const int64_t n = c->w * c->h;
    uint32_t most = 1;
    *s = (struct silhouette){ calloc((size_t)n, 1), calloc((size_t)n, 1) };
    uint8_t *other = malloc((size_t)n);
    if (!s->body || !s->photo || !other)
        failure_set(failure, EX_SOFTWARE, "no memory for a picture");
    for (int64_t k = 0; k < n && !failure->status; k++)
        if (cover[k] > most && counts_pixel(c, a, k % c->w, k / c->w)) most = cover[k];
    for (int64_t k = 0; k < n && !failure->status; k++) {
        if (!counts_pixel(c, a, k % c->w, k / c->w)) continue;
        s->body[k] = (uint8_t)((double)cover[k] / most * 255);
        if (a->photo.grey) s->photo[k] = (uint8_t)(255 - a->photo.grey[k]);
    }
    if (!failure->status)
        close_gaps(s->body, other, c->w, c->h), close_gaps(s->photo, other, c->w, c->h);
    for (int64_t k = 0; k < n && !failure->status; k++) {
        const bool counts = counts_pixel(c, a, k % c->w, k / c->w);
        s->body[k] = counts && s->body[k] > BODIES_CUT;
        s->photo[k] = counts && s->photo[k] > PHOTO_CUT;
    }
    free(other);
    return failure->status;
}

static int silhouette_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    const struct asked *a = s->asked;
    struct frame_memory now = { 0 };
    struct silhouette both = { 0 };
    double *at = table_row(t, failure), body = 0, photo = 0, surplus = 0, missing = 0, mirrored = 0;
    if (!at) return failure->status;
    if (!(a->window[1] > a->window[0])) {
        table_null(t, "the picture has no edges: give --window");
        return 0;
    }
    const struct canvas c = canvas_of(a, s->p->dim);
    if (silhouette_keep(&now, s, failure) || silhouette_of(&both, &c, a, now.cover, failure)) {
        silhouette_free(&both), frame_memory_free(&now);
        return failure->status;
    }
    for (int64_t j = 0; j < c.h; j++)
        for (int64_t i = 0; i < c.w; i++) {
            const bool b = both.body[j * c.w + i], f = both.photo[j * c.w + i];
            body += b, photo += f, surplus += b && !f, missing += f && !b;
            mirrored += b != both.photo[j * c.w + c.w - 1 - i];
        }
    const double pixel = c.dx * c.dy;
    put(&at, (double)now.covered), put(&at, pixel * body);
    if (a->photo.grey) {
        put(&at, pixel * photo), put(&at, pixel * (surplus + missing)), put(&at, pixel * surplus);
        put(&at, pixel * missing), put(&at, pixel * mirrored);
    } else {
        table_null(t, "no photograph: --photo names one");
    }
    silhouette_free(&both), frame_memory_free(&now);
    return 0;
}

const struct measure measure_silhouette = {
    .name = "silhouette",
    .help = "area that bodies cover in a projection, compared with a photograph",
    .quantity = quantities,
    .keeps_to = KEEPS_TO_BODIES,
    .remembers = true,
    .keep = silhouette_keep,
    .rows = silhouette_rows,
};

/* ---- the picture ---- */

int silhouette_write(const char *file, const struct frame_memory *kept, const struct asked *asked,
                     struct failure *failure)
{
    static const uint8_t colour[4][3] = {
        { 255, 255, 255 }, { 60, 110, 190 }, { 210, 60, 50 }, { 120, 120, 120 }
    };
    const struct canvas c = canvas_of(asked, kept->dim);
    struct silhouette both = { 0 };
    uint8_t *rgb = malloc((size_t)(3 * c.w * c.h));
    struct output to;
    FILE *out = NULL;
    png_image image = { .version = PNG_IMAGE_VERSION, .format = PNG_FORMAT_RGB };
    image.width = (png_uint_32)c.w, image.height = (png_uint_32)c.h;
    if (!rgb)
        failure_set(failure, EX_SOFTWARE, "no memory for a picture");
    else if (!silhouette_of(&both, &c, asked, kept->cover, failure))
        for (int64_t k = 0; k < c.w * c.h; k++)
            memcpy(rgb + 3 * k, colour[both.body[k] + 2 * both.photo[k]], 3);
    if (!failure->status) out = output_stream(&to, file, failure);
    if (out && !png_image_write_to_stdio(&image, out, 0, rgb, -3 * (png_int_32)c.w, NULL))
        failure_set(failure, EX_IOERR, "%.200s: %s", file, image.message);
    if (out) output_stream_close(&to, out, failure);
    silhouette_free(&both), free(rgb);
    return failure->status;
}
