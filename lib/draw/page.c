/*
 * draw/page.c: what the page's program reads, draw/page/page.js.
 *
 * A chunk is a script element of base64, of zlib, of little-endian numbers one array after another:
 *
 *   fK, frame K    u16[n][4] position and |spin|; i16[n][4] velocity, 0; i8[n][4] orientation;
 *                  i32[c] a; i32[c] b; u16[c] normal force; u16[c] tangential; i8[c][4] normal, status
 *   gK, grains     f32[n] radius; f32[n] mass; i32[n] id; i32[n] material; i32[n] shape, where not all are balls
 *   sK, shapes     as draw/page_data.h has them; where not all are balls
 *   bK, walls      u32 triangles, u32 lines; f32 corners [9] each; f32 ends [6] each
 *
 * The JSON element "meta" [draw/page_data.h] has for each frame what its numbers are relative to: x = lo + step k,
 * v = vmax k / 32767, |w| = wmax k / 65535, f = fmax k / 65535.
 */
#include "draw/page.h"

#include "draw/images.h"
#include "draw/outline.h"
#include "draw/page_data.h"

#include <jansson.h>
#include <stdlib.h>
#include <string.h>

/* The texts of draw/page/, which are part of the program. */

enum page_text { PAGE_HTML, PAGE_CSS, PAGE_JS, PAGE_THREE, PAGE_LICENCE };

/* The text of a file */
static const char *page_part(enum page_text which);

/* ---- the assembler takes the files in as they are ---- */

#define TAKE_IN(name, file)                                                                        \
    __asm__(".section .rodata\n.hidden " name "\n.globl " name "\n" name                           \
            ": .incbin \"lib/draw/page/" file "\"\n.byte 0\n.previous\n")

TAKE_IN("nsd_page_html", "page.html");
TAKE_IN("nsd_page_css", "page.css");
TAKE_IN("nsd_page_js", "page.js");
TAKE_IN("nsd_page_three", "three.module.min.js");
TAKE_IN("nsd_page_licence", "LICENSE.three");

extern const char nsd_page_html[], nsd_page_css[], nsd_page_js[], nsd_page_three[],
    nsd_page_licence[];

static const char *page_part(enum page_text which)
{
    static const char *const part[] = { nsd_page_html, nsd_page_css, nsd_page_js, nsd_page_three,
                                        nsd_page_licence };
    return part[which];
}

static int page_no_memory(struct failure *failure)
{
    return failure_set(failure, EX_SOFTWARE, "no memory for the page");
}

static int not_written(const struct page *p, struct failure *failure)
{
    return ferror(p->out) ? failure_set(failure, EX_IOERR, "%s: not written", p->name) : 0;
}

static int write_chunk(struct page *p, char letter, int64_t number, const struct chunk *b,
                       struct failure *failure)
{
    return chunk_write(p->out, letter, number, b) ? page_no_memory(failure)
                                                  : not_written(p, failure);
}

/* Writes a chunk unless it is the same as the last of its kind; frees b or keeps it. */
static int write_changed(struct page *p, char letter, struct page_kept *kept, struct chunk *b,
                         struct failure *failure)
{
    if (kept->n && kept->size == b->n && !memcmp(kept->last, b->at, b->n)) {
        free(b->at);
        return 0;
    }
    free(kept->last);
    kept->last = b->at, kept->size = b->n;
    return write_chunk(p, letter, kept->n++, b, failure);
}

/* ---- what does not change in every frame ---- */

static int write_grains(struct page *p, const struct packing *k, struct failure *failure)
{
    struct chunk b = { malloc(20 * (size_t)k->n + 1), 0 };
    if (!b.at) return page_no_memory(failure);
    for (int64_t i = 0; i < k->n; i++) chunk_put_float(&b, k->radius[i]);
    for (int64_t i = 0; i < k->n; i++) chunk_put_float(&b, k->mass[i]);
    chunk_put(&b, k->id, 4 * (size_t)k->n);
    chunk_put(&b, k->material, 4 * (size_t)k->n);
    if (k->shape) chunk_put(&b, k->shape, 4 * (size_t)k->n);
    return write_changed(p, 'g', &p->grains, &b, failure);
}

static int write_shapes(struct page *p, const struct packing *k, struct failure *failure)
{
    struct chunk b;
    if (page_shapes(&b, k->dim, &k->shapes, failure)) return free(b.at), failure->status;
    return write_changed(p, 's', &p->shapes, &b, failure);
}

static void put_point(struct chunk *b, vec3 x)
{
    chunk_put_float(b, x.x), chunk_put_float(b, x.y), chunk_put_float(b, x.z);
}

static void page_put_triangle(struct chunk *b, vec3 x, vec3 y, vec3 z)
{
    put_point(b, x), put_point(b, y), put_point(b, z);
}

/* Floors, all that has an outline, and the lines of both */
static void put_walls(struct chunk *b, const struct walls *w, const struct outline *o)
{
    uint32_t counts[2] = { (uint32_t)o->triangles, (uint32_t)w->edges };
    for (int i = 0; i < w->panels; i++)
        if (w->panel[i].corners > 2) counts[0] += (uint32_t)w->panel[i].corners - 2;
    chunk_put(b, counts, sizeof counts);
    for (int i = 0; i < w->panels; i++)
        for (int c = 2; c < w->panel[i].corners; c++)
            page_put_triangle(b, w->panel[i].corner[0], w->panel[i].corner[c - 1],
                              w->panel[i].corner[c]);
    for (int64_t i = 0; i < o->triangles; i++) {
        const vec3 *x = o->triangle[i].corner;
        page_put_triangle(b, x[0], x[1], x[2]);
    }
    for (int i = 0; i < w->edges; i++) put_point(b, w->edge[i].a), put_point(b, w->edge[i].b);
}

static int write_walls(struct page *p, const struct packing *k, const struct extent *r,
                       struct failure *failure)
{
    struct walls *w = malloc(sizeof *w);
    struct outline o;
    if (!w) return page_no_memory(failure);
    int e = outline_init(&o, k, v3_norm(v3_sub(r->hi, r->lo)), failure);
    if (!e) {
        struct chunk b = {
            malloc(8 + 36 * ((size_t)WALLS_PANELS * WALLS_CORNERS + (size_t)o.triangles) +
                   24 * WALLS_EDGES),
            0
        };
        walls_build(w, k, r);
        images_outline(w, k);
        if (b.at) put_walls(&b, w, &o);
        e = b.at ? write_changed(p, 'b', &p->walls, &b, failure) : page_no_memory(failure);
        outline_free(&o);
    }
    free(w);
    return e;
}

/* ---- a frame ---- */

/* What the numbers of the grains are relative to; grains that have flown off do not count. */
static void page_measure(struct page_moment *m, const struct packing *k)
{
    double hi[3] = { -INFINITY, -INFINITY, -INFINITY };
    for (int j = 0; j < 3; j++) m->lo[j] = INFINITY;
    for (int64_t i = 0; i < k->n; i++) {
        const double x[3] = { k->x[i].x, k->x[i].y, k->x[i].z };
        double v = v3_norm(k->v[i]), w = v3_norm(k->w[i]);
        for (int j = 0; j < 3; j++)
            if (fabs(x[j]) < WALLS_FAR) m->lo[j] = fmin(m->lo[j], x[j]), hi[j] = fmax(hi[j], x[j]);
        if (isfinite(v)) m->vmax = fmax(m->vmax, v);
        if (isfinite(w)) m->wmax = fmax(m->wmax, w);
    }
    for (int j = 0; j < 3; j++) {
        if (!(hi[j] >= m->lo[j])) m->lo[j] = hi[j] = 0;
        m->quantum[j] = (hi[j] - m->lo[j]) / U16;
    }
}

static void put_motion(struct chunk *b, const struct page_moment *m, const struct packing *k)
{
    for (int64_t i = 0; i < k->n; i++) {
        const double x[3] = { k->x[i].x, k->x[i].y, k->x[i].z };
        uint16_t four[4];
        for (int j = 0; j < 3; j++) {
            int at = chunk_quantise(x[j] - m->lo[j], m->quantum[j] * U16, U16);
            four[j] = (uint16_t)(at > 0 ? at : 0);
        }
        four[3] = (uint16_t)chunk_quantise(v3_norm(k->w[i]), m->wmax, U16);
        chunk_put(b, four, sizeof four);
    }
    for (int64_t i = 0; i < k->n; i++) {
        const double v[4] = { k->v[i].x, k->v[i].y, k->v[i].z, 0 };
        int16_t four[4];
        for (int j = 0; j < 4; j++) four[j] = (int16_t)chunk_quantise(v[j], m->vmax, I16);
        chunk_put(b, four, sizeof four);
    }
    for (int64_t i = 0; i < k->n; i++) {
        const double q[4] = { k->q[i].w, k->q[i].x, k->q[i].y, k->q[i].z };
        int8_t four[4];
        for (int j = 0; j < 4; j++) four[j] = (int8_t)chunk_quantise(q[j], 1, I8);
        chunk_put(b, four, sizeof four);
    }
}

static double page_tangential(const struct found *f)
{
    return hypot(f->r[1], f->r[2]);
}

static void page_put_contacts(struct chunk *b, const struct page_moment *m, const struct packing *k,
                              const struct contacts *s)
{
    for (int64_t i = 0; i < s->n; i++) chunk_put(b, &s->c[i].a, 4);
    for (int64_t i = 0; i < s->n; i++) chunk_put(b, &s->c[i].b, 4);
    for (int t = 0; t < 2; t++)
        for (int64_t i = 0; i < s->n; i++) {
            double r = t ? page_tangential(&s->found[i]) : fmax(s->found[i].r[0], 0);
            chunk_put_u16(b, chunk_quantise(r / k->dt, m->fmax, U16));
        }
    for (int64_t i = 0; i < s->n; i++) {
        vec3 n = s->c[i].n;
        int8_t four[4] = { (int8_t)chunk_quantise(n.x, 1, I8), (int8_t)chunk_quantise(n.y, 1, I8),
                           (int8_t)chunk_quantise(n.z, 1, I8), s->found[i].status };
        chunk_put(b, four, sizeof four);
    }
}

/* The ranges of the whole trajectory that colours are scaled by */
static int widen(struct page *p, const struct page_moment *m, const struct packing *k,
                 const struct contacts *s, struct failure *failure)
{
    double *push = calloc((size_t)k->n + 1, sizeof *push);
    int *count = calloc((size_t)k->n + 1, sizeof *count);
    if (!push || !count) {
        free(push), free(count);
        return page_no_memory(failure);
    }
    p->fastest = fmax(p->fastest, m->vmax), p->spin = fmax(p->spin, m->wmax);
    p->force = fmax(p->force, m->fmax);
    for (int64_t i = 0; i < s->n; i++) {
        double f = s->found[i].r[0] / k->dt;
        if (!chunk_quantise(f, m->fmax, U16)) continue;
        push[s->c[i].b] += f, count[s->c[i].b]++;
        if (s->c[i].a >= 0) push[s->c[i].a] += f, count[s->c[i].a]++;
    }
    for (int64_t i = 0; i < k->n; i++) {
        p->radius[0] = fmin(p->radius[0], k->radius[i]);
        p->radius[1] = fmax(p->radius[1], k->radius[i]);
        p->push = fmax(p->push, push[i]), p->most = count[i] > p->most ? count[i] : p->most;
    }
    free(push), free(count);
    return 0;
}

static int write_frame(struct page *p, const struct page_moment *m, const struct packing *k,
                       const struct contacts *s, struct failure *failure)
{
    struct chunk b = { malloc(20 * (size_t)k->n + 16 * (size_t)m->contacts + 1), 0 };
    if (!b.at) return page_no_memory(failure);
    put_motion(&b, m, k);
    if (m->contacts) page_put_contacts(&b, m, k, s);
    int e = write_chunk(p, 'f', p->frames, &b, failure);
    free(b.at);
    return e;
}

static struct page_moment *page_add_moment(struct page *p)
{
    if (p->frames == p->room) {
        int64_t room = p->room ? 2 * p->room : 64;
        void *more = realloc(p->moment, (size_t)room * sizeof *p->moment);
        if (!more) return NULL;
        p->moment = more, p->room = room;
        for (int c = 0; c < p->curves; c++) {
            double *value = realloc(p->curve[c].value, (size_t)room * sizeof *value);
            if (!value) return NULL;
            p->curve[c].value = value;
        }
    }
    for (int c = 0; c < p->curves; c++) p->curve[c].value[p->frames] = NAN;
    return &p->moment[p->frames];
}

/* The first frame's materials and dimension are the page's. */
static int adopt(struct page *p, const struct packing *k, struct failure *failure)
{
    p->dim = k->dim, p->up = walls_up(k);
    p->radius[0] = INFINITY;
    p->material_name = calloc((size_t)k->materials + 1, sizeof *p->material_name);
    for (; p->material_name && p->materials < k->materials; p->materials++)
        if (!(p->material_name[p->materials] = strdup(k->material_name[p->materials]))) break;
    return p->material_name && p->materials == k->materials ? 0 : page_no_memory(failure);
}

int page_frame(struct page *p, const struct packing *k, const struct contacts *s,
               struct failure *failure)
{
    struct extent r = { 0 };
    const struct contacts none = { 0 };
    if (!s || !s->found) s = &none;
    if (k->n > INT32_MAX || s->n > INT32_MAX)
        return failure_set(failure, EX_DATAERR, "too many grains or contacts for a page");
    if (p->frames && k->dim != p->dim)
        return failure_set(failure, EX_DATAERR, "dim is %d, that of the first frame %d", k->dim,
                           p->dim);
    if (!p->frames && adopt(p, k, failure)) return failure->status;
    struct page_moment *m = page_add_moment(p);
    if (!m) return page_no_memory(failure);
    *m = (struct page_moment){
        .step = k->step, .t = k->t, .n = k->n, .contacts = s->n, .walls = -1, .shapes = -1
    };
    p->solved |= s->found != NULL;
    page_measure(m, k);
    for (int64_t i = 0; i < s->n; i++) {
        double f = fmax(s->found[i].r[0], page_tangential(&s->found[i])) / k->dt;
        if (isfinite(f)) m->fmax = fmax(m->fmax, f);
    }
    for (int j = 0; j < 3; j++) m->repeats[j] = k->cell.repeats[j], m->edge[j] = k->cell.edge[j];
    m->origin = k->cell.origin;
    bool any = region_of(&r, k), walls = k->walls || cell_repeats(&k->cell);
    if (any) p->seen = p->frames ? region_join(p->seen, r) : r;
    if (any && walls && write_walls(p, k, &r, failure)) return failure->status;
    if (k->shape && write_shapes(p, k, failure)) return failure->status;
    if (k->shape) m->shapes = p->shapes.n - 1;
    if (write_grains(p, k, failure) || widen(p, m, k, s, failure) ||
        write_frame(p, m, k, s, failure))
        return failure->status;
    m->grains = p->grains.n - 1;
    if (any && walls) m->walls = p->walls.n - 1;
    p->frames++;
    return 0;
}

int page_value(struct page *p, const char *name, const char *unit, double value,
               struct failure *failure)
{
    int c = 0;
    while (c < p->curves && strcmp(p->curve[c].name, name) != 0) c++;
    if (c == p->curves) {
        struct page_curve *more = realloc(p->curve, (size_t)(c + 1) * sizeof *more), new;
        if (!more) return page_no_memory(failure);
        p->curve = more;
        new = (struct page_curve){ strdup(name), strdup(unit),
                                   malloc((size_t)(p->room + 1) * sizeof(double)) };
        p->curve[p->curves++] = new;
        if (!new.name || !new.unit || !new.value) return page_no_memory(failure);
        for (int64_t k = 0; k < p->frames; k++) new.value[k] = NAN;
    }
    p->curve[c].value[p->frames - 1] = value;
    return 0;
}

/* ---- the whole file ---- */

static void write_text(FILE *out, const char *text) // as HTML
{
    for (; *text; text++)
        if (*text == '<')
            fputs("&lt;", out);
        else if (*text == '&')
            fputs("&amp;", out);
        else
            fputc(*text, out);
}

int page_begin(struct page *p, FILE *out, const char *name, const char *title,
               struct failure *failure)
{
    *p = (struct page){ .out = out, .name = name };
    fputs("<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>",
          out);
    write_text(out, title);
    fprintf(out, "</title>\n<style>\n%s</style>\n</head>\n<body>\n%s", page_part(PAGE_CSS),
            page_part(PAGE_HTML));
    return not_written(p, failure);
}

int page_end(struct page *p, struct failure *failure)
{
    json_t *meta = page_meta(p);
    char *text = json_dumps(meta, JSON_COMPACT | JSON_REAL_PRECISION(9));
    json_decref(meta);
    if (!text) return page_no_memory(failure);
    fputs("<script type=\"application/json\" id=\"meta\">", p->out);
    for (const char *s = text; *s; s++) // "</script" in a name must not end it
        if (*s == '<')
            fputs("\\u003c", p->out);
        else
            fputc(*s, p->out);
    free(text);
    fprintf(
        p->out,
        "</script>\n<!-- three.js\n%s-->\n<script type=\"text/plain\" id=\"three\">%s</script>\n"
        "<script type=\"module\">\n%s</script>\n</body>\n</html>\n",
        page_part(PAGE_LICENCE), page_part(PAGE_THREE), page_part(PAGE_JS));
    return not_written(p, failure);
}

void page_free(struct page *p)
{
    for (int c = 0; c < p->curves; c++)
        free(p->curve[c].name), free(p->curve[c].unit), free(p->curve[c].value);
    for (int32_t k = 0; p->material_name && k < p->materials; k++) free(p->material_name[k]);
    free(p->curve), free(p->material_name), free(p->moment), free(p->grains.last),
        free(p->walls.last);
    free(p->shapes.last);
    *p = (struct page){ 0 };
}
