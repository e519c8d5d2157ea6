/* draw/overlay.c: what cairo draws over a picture [draw/overlay.h]. */
#include "draw/overlay.h"

#include "state/kinematics.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WIDEST 0.011 /* of the longer side: the width of the line of the largest force */
#define FINEST 0.6   /* pixels: thinner lines are not drawn, they would be a grey veil */

static double longer_side(const struct view *v)
{
    return v->camera.width > v->camera.height ? v->camera.width : v->camera.height;
}

/* ---- contacts ---- */

static const double status_colour[3][3] = { { 0.55, 0.58, 0.63 },   // apart
                                            { 0.10, 0.27, 0.58 },   // sticks
                                            { 0.84, 0.20, 0.14 } }; // slides

static void set_status(cairo_t *cr, int status)
{
    const double *c = status_colour[status < 0 || status > 2 ? 0 : status];
    cairo_set_source_rgb(cr, c[0], c[1], c[2]);
}

static bool is_cut(const struct view *v, vec3 x)
{
    return v->cuts && v3_dot(v->cut, x) > v->cut_at;
}

static double largest_force(const struct packing *p, const struct contacts *s)
{
    double most = 0;
    for (int64_t i = 0; i < s->n; i++) most = fmax(most, s->found[i].r[0] / p->dt);
    return most;
}

/* A line from centre to centre, of a wall from the contact; its width is the normal force. */
static void draw_push(cairo_t *cr, const struct view *v, const struct packing *p,
                      const struct contact *c, const struct found *f, double share)
{
    double size;
    vec3 b = p->x[c->b], a = c->a >= 0 ? p->x[c->a] : c->x;
    if (c->a >= 0 && contact_shaped(p, c))
        a = v3_sub(p->x[c->a], cell_shift(p->cell.edge, c->shift));
    else if (c->a >= 0)
        a = v3_sub(b, v3_scale(p->radius[c->a] + p->radius[c->b] + c->gap, c->n));
    if (is_cut(v, a) || is_cut(v, b)) return;
    double width = share * WIDEST * longer_side(v);
    vec3 from = view_sees(v, a, &size), to = view_sees(v, b, &size);
    if (!(size > 0) || width < FINEST) return;
    set_status(cr, f->status);
    cairo_set_line_width(cr, width);
    cairo_move_to(cr, from.x, from.y);
    cairo_line_to(cr, to.x, to.y);
    cairo_stroke(cr);
}

static void draw_network(cairo_t *cr, const struct overlay *o, const struct view *v,
                         const struct packing *p, const struct contacts *s)
{
    double most = o->force > 0 ? o->force : largest_force(p, s);
    cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
    for (int64_t i = 0; most > 0 && i < s->n; i++)
        if (s->found[i].r[0] > 0 && view_joins(v, p, s->c[i].a, s->c[i].b))
            draw_push(cr, v, p, &s->c[i], &s->found[i], fmin(s->found[i].r[0] / p->dt / most, 1));
}

/* Whole bonds are green, those that break red; liquid alone is blue. */
static void overlay_set_bond(cairo_t *cr, const struct bond *b)
{
    if (b->beta > 0)
        cairo_set_source_rgb(cr, 0.84 - 0.74 * b->beta, 0.20 + 0.35 * b->beta,
                             0.14 + 0.1 * b->beta);
    else
        cairo_set_source_rgb(cr, 0.20, 0.55, 0.90);
}

/* A line for each pair that is tied, as draw_push() has them, or from a wall to the body's centre */
static void draw_bonds(cairo_t *cr, const struct view *v, const struct packing *p)
{
    cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
    for (int64_t i = 0; i < p->bonds.n; i++) {
        const struct bond *k = &p->bonds.bond[i];
        if ((!(k->beta > 0) && !k->wet) || !view_joins(v, p, k->a, k->b)) continue;
        double size, small = p->radius[k->b], length = p->radius[k->b] + k->gap;
        if (k->a >= 0) small = fmin(small, p->radius[k->a]), length += p->radius[k->a];
        vec3 b = p->x[k->b], a = v3_axpy(b, -length, k->n);
        if (is_cut(v, a) || is_cut(v, b)) continue;
        vec3 from = view_sees(v, a, &size), to = view_sees(v, b, &size);
        if (!(size > 0)) continue;
        overlay_set_bond(cr, k);
        cairo_set_line_width(cr, fmax(0.25 * small * v->camera.scale, 1.2));
        cairo_move_to(cr, from.x, from.y);
        cairo_line_to(cr, to.x, to.y);
        cairo_stroke(cr);
    }
}

static void draw_contacts(cairo_t *cr, const struct view *v, const struct packing *p,
                          const struct contacts *s)
{
    for (int64_t i = 0; i < s->n; i++) {
        const struct contact *c = &s->c[i];
        double size, r = fmax(0.12 * p->radius[c->b] * v->camera.scale, 1.2);
        vec3 at = view_sees(v, c->x, &size);
        if (is_cut(v, c->x) || !(size > 0) || !view_joins(v, p, c->a, c->b)) continue;
        set_status(cr, s->found ? s->found[i].status : 0);
        cairo_arc(cr, at.x, at.y, r, 0, 2 * M_PI);
        cairo_fill(cr);
    }
}

void overlay_bodies(cairo_t *cr, const struct overlay *o, const struct view *v,
                    const struct packing *p, const struct contacts *s)
{
    if (!s && !o->bonds) return;
    cairo_save(cr);
    cairo_rectangle(cr, 0, 0, v->camera.width, v->camera.height);
    cairo_clip(cr);
    if (o->network && s && s->found) draw_network(cr, o, v, p, s);
    if (o->bonds) draw_bonds(cr, v, p);
    if (o->contacts && s) draw_contacts(cr, v, p, s);
    cairo_restore(cr);
}

/* ---- the legend ---- */

/* Pixels: of a row of the legend; words are a quarter of it, and not below 14 pixels where the picture has room */
static int row_height(int width)
{
    int row = 2 * (int)(0.5 * 0.085 * width), least = width < 300 ? 44 : 56;
    return row < least ? least : row > 110 ? 110 : row;
}

int overlay_strip(const struct overlay *o, int width)
{
    if (!o->legend) return 0;
    int row = row_height(width);
    return o->solid ? row + 2 * (int)(0.3 * row) : row; // a second row of half the height
}

/* A length in m as one reads it */
static void say_length(double m, char *text, size_t room)
{
    static const struct {
        double size;
        const char *unit;
    } unit[] = { { 1e3, "km" }, { 1, "m" }, { 1e-2, "cm" }, { 1e-3, "mm" }, { 1e-6, "um" } };
    for (int k = 0; k < 5; k++)
        if (m >= 0.999 * unit[k].size && m < 1e6) {
            snprintf(text, room, "%g %s", m / unit[k].size, unit[k].unit);
            return;
        }
    snprintf(text, room, "%g m", m);
}

enum overlay_side { LEFT, MIDDLE, RIGHT };

/* Words on the line y; returns their width. */
static double overlay_write_words(cairo_t *cr, double x, double y, enum overlay_side side,
                                  const char *text)
{
    cairo_text_extents_t e;
    cairo_text_extents(cr, text, &e);
    double before = side == LEFT ? 0 : side == RIGHT ? e.x_advance : 0.5 * e.x_advance;
    cairo_move_to(cr, x - before, y);
    cairo_show_text(cr, text);
    return e.x_advance;
}

void overlay_colour(cairo_t *cr, struct rgb c)
{
    cairo_set_source_rgb(cr, rgb_byte(c.r) / 255.0, rgb_byte(c.g) / 255.0, rgb_byte(c.b) / 255.0);
}

static double font_height(cairo_t *cr)
{
    cairo_font_extents_t e;
    cairo_font_extents(cr, &e);
    return e.ascent;
}

/* The palette with its name, unit and ends; where there is one value, that */
static void draw_palette(cairo_t *cr, const struct paint *p, double x, double y, double w, double h)
{
    const struct colour_meaning *m = &colour_meaning[p->by];
    char text[100];
    snprintf(text, sizeof text, "%s%s%s", p->name ? p->name : m->name, *m->unit ? ", " : "",
             m->unit);
    if (m->classes || !isfinite(p->lo) || !isfinite(p->hi)) {
        overlay_write_words(cr, x, y + h, LEFT, m->classes ? m->name : "");
        return;
    }
    cairo_save(cr);
    cairo_set_antialias(cr, CAIRO_ANTIALIAS_NONE); // no seams between the steps
    for (int i = 0; i < 256; i++) {
        overlay_colour(cr, p->palette[i]);
        cairo_rectangle(cr, x + w * i / 256, y, w / 256 + 0.5, h);
        cairo_fill(cr);
    }
    cairo_restore(cr);
    double size = font_height(cr);
    overlay_write_words(cr, x + 0.5 * w, y - 0.35 * size, MIDDLE, text);
    snprintf(text, sizeof text, "%.3g", p->lo);
    const double after = x + overlay_write_words(cr, x, y + h + size, LEFT, text) + 0.7 * size;
    snprintf(text, sizeof text, "%.3g", p->hi);
    cairo_text_extents_t e;
    cairo_text_extents(cr, text, &e);
    overlay_write_words(cr, fmax(x + w, after + e.x_advance), y + h + size, RIGHT, text);
}

/* A square of the colour, and a word; false where it would be beyond `end`, and dots are there instead. */
static bool draw_key(cairo_t *cr, double *x, double y, double end, struct rgb c, const char *word)
{
    cairo_text_extents_t e;
    double size = font_height(cr);
    cairo_text_extents(cr, word, &e);
    if (*x + 1.4 * size + e.x_advance > end) {
        overlay_write_words(cr, *x, y, LEFT, "...");
        return false;
    }
    cairo_save(cr);
    overlay_colour(cr, c);
    cairo_rectangle(cr, *x, y - 0.85 * size, 0.85 * size, 0.85 * size);
    cairo_fill(cr);
    cairo_restore(cr);
    *x += 1.2 * size;
    *x += overlay_write_words(cr, *x, y, LEFT, word) + 0.9 * size;
    return true;
}

/* The materials, or the names of the groups, that bodies are of, with their colours */
static void draw_classes(cairo_t *cr, const struct view *v, const struct packing *p, double x,
                         double y, double end)
{
    const bool groups = v->paint.by == COLOUR_GROUP;
    const int32_t n = groups ? p->names.n : p->materials;
    bool *any = calloc((size_t)n + 1, sizeof *any);
    for (int64_t i = 0; any && i < p->n; i++) {
        int32_t k = !groups ? p->material[i] : p->group ? p->group[i] - 1 : -1;
        if (k >= 0 && view_joins(v, p, -1, (int32_t)i)) any[k] = true;
    }
    for (int32_t k = 0; any && k < n; k++)
        if (any[k] && !draw_key(cr, &x, y, end, paint_material(k),
                                groups ? p->names.text[k] : p->material_name[k]))
            break;
    free(any);
}

/* What the colours of solid walls show: their names, or numbers */
static void draw_solid(cairo_t *cr, const struct solid_walls *s, const struct paint *paint,
                       double x, double y, double end)
{
    const struct surface_meaning *m = &surface_meaning[s->by];
    double size = font_height(cr);
    char text[100];
    for (int k = 0; s->by == SURFACE_NAME && k < s->named; k++)
        if (!draw_key(cr, &x, y, end, s->shown[k], s->name[k])) return;
    if (s->by == SURFACE_NAME) return;
    snprintf(text, sizeof text, "%s, %s:  %.3g", m->name, m->unit, s->lo);
    x += overlay_write_words(cr, x, y, LEFT, text) + 0.4 * size;
    double w = 0.25 * (end - x);
    cairo_save(cr);
    cairo_set_antialias(cr, CAIRO_ANTIALIAS_NONE);
    for (int i = 0; i < 256; i++) {
        overlay_colour(cr, paint->palette[i]);
        cairo_rectangle(cr, x + w * i / 256, y - 0.8 * size, w / 256 + 0.5, 0.8 * size);
        cairo_fill(cr);
    }
    cairo_restore(cr);
    snprintf(text, sizeof text, "%.3g", s->hi);
    overlay_write_words(cr, x + w + 0.4 * size, y, LEFT, text);
}

static void draw_scale(cairo_t *cr, const struct view *v, double x, double y, double most)
{
    double length = camera_round(most / v->camera.scale), w = length * v->camera.scale;
    char text[40];
    say_length(length, text, sizeof text);
    cairo_set_line_cap(cr, CAIRO_LINE_CAP_BUTT);
    cairo_move_to(cr, x - 0.5 * w, y - 4);
    cairo_line_to(cr, x - 0.5 * w, y + 4);
    cairo_move_to(cr, x - 0.5 * w, y);
    cairo_line_to(cr, x + 0.5 * w, y);
    cairo_move_to(cr, x + 0.5 * w, y - 4);
    cairo_line_to(cr, x + 0.5 * w, y + 4);
    cairo_stroke(cr);
    overlay_write_words(cr, x, y + 6 + 0.9 * font_height(cr), MIDDLE, text);
}

/* What the colours of lines and dots say */
static void draw_status(cairo_t *cr, double x, double y, double size)
{
    static const char *const word[] = { NULL, "stick", "slide" };
    for (int k = 1; k <= 2; k++) {
        cairo_save(cr);
        set_status(cr, k);
        cairo_rectangle(cr, x, y - 0.5 * size, 1.4 * size, 0.3 * size);
        cairo_fill(cr);
        cairo_restore(cr);
        x += 1.7 * size;
        x += overlay_write_words(cr, x, y, LEFT, word[k]) + size;
    }
}

void overlay_legend(cairo_t *cr, const struct overlay *o, const struct view *v,
                    const struct packing *p, int top)
{
    double w = v->camera.width, strip = row_height(v->camera.width), size = 0.25 * strip;
    bool bright = v->background.r + v->background.g + v->background.b > 0.6F;
    double ink = bright ? 0.12 : 0.9;
    char text[60];
    cairo_set_source_rgb(cr, ink, ink, ink);
    cairo_select_font_face(cr, "@cairo:sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cr, size);
    cairo_set_line_width(cr, fmax(1.2, 0.0016 * w));
    if (o->solid)
        draw_solid(cr, o->solid, &v->paint, 0.03 * w, top + strip + 0.3 * strip, 0.97 * w);
    if (v->paint.by == COLOUR_MATERIAL || v->paint.by == COLOUR_GROUP)
        draw_classes(cr, v, p, 0.03 * w, top + 0.58 * strip, 0.43 * w);
    else
        draw_palette(cr, &v->paint, 0.03 * w, top + 0.36 * strip, 0.34 * w, 0.22 * strip);
    const bool keys = o->network || o->contacts;
    const double status = 0.97 * w - 8.6 * size; // pixels: where its words begin
    const double scale = keys ? fmin(0.54 * w, status - size - 0.1 * w) : 0.54 * w;
    if (isinf(v->camera.eye)) draw_scale(cr, v, scale, top + 0.42 * strip, 0.2 * w);
    snprintf(text, sizeof text, "t = %.4g s", p->t);
    overlay_write_words(cr, 0.97 * w, top + 0.36 * strip + (keys ? 0 : 0.6 * size), RIGHT, text);
    if (keys) draw_status(cr, status, top + 0.58 * strip + size, size);
}

/* ---- over pixels ---- */

/* The picture with a strip of background below it */
static int add_strip(struct picture *pic, const struct view *v, int strip, struct failure *failure)
{
    struct picture whole;
    if (!strip) return 0;
    if (picture_init(&whole, pic->width, pic->height + strip, failure)) return failure->status;
    size_t n = 3 * (size_t)pic->width * (size_t)pic->height;
    memcpy(whole.rgb, pic->rgb, n);
    for (size_t i = n; i < n + 3 * (size_t)pic->width * (size_t)strip; i += 3) {
        whole.rgb[i] = rgb_byte(v->background.r);
        whole.rgb[i + 1] = rgb_byte(v->background.g);
        whole.rgb[i + 2] = rgb_byte(v->background.b);
    }
    picture_free(pic);
    *pic = whole;
    return 0;
}

/* Between the picture's bytes and cairo's words, 0xXXRRGGBB */
static void copy_pixels(struct picture *pic, unsigned char *data, int stride, bool back)
{
    for (int y = 0; y < pic->height; y++)
        for (int x = 0; x < pic->width; x++) {
            unsigned char *rgb = pic->rgb + 3 * ((size_t)y * (size_t)pic->width + (size_t)x);
            uint32_t word;
            unsigned char *at = data + (size_t)y * (size_t)stride + 4 * (size_t)x;
            if (back) {
                memcpy(&word, at, 4);
                rgb[0] = word >> 16 & 255, rgb[1] = word >> 8 & 255, rgb[2] = word & 255;
            } else {
                word = (uint32_t)rgb[0] << 16 | (uint32_t)rgb[1] << 8 | rgb[2];
                memcpy(at, &word, 4);
            }
        }
}

int overlay_draw(const struct overlay *o, const struct view *v, const struct packing *p,
                 const struct contacts *s, struct picture *pic, struct failure *failure)
{
    int top = v->camera.height;
    if (view_draw(v, p, pic, failure)) return failure->status;
    if (!o->network && !o->contacts && !o->bonds && !o->legend) return 0;
    if (add_strip(pic, v, overlay_strip(o, pic->width), failure)) {
        picture_free(pic);
        return failure->status;
    }
    cairo_surface_t *surface =
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, pic->width, pic->height);
    unsigned char *data = cairo_image_surface_get_data(surface);
    if (!data) {
        cairo_surface_destroy(surface);
        picture_free(pic);
        return failure_set(failure, EX_SOFTWARE, "no memory for %d x %d pixels", pic->width,
                           pic->height);
    }
    copy_pixels(pic, data, cairo_image_surface_get_stride(surface), false);
    cairo_surface_mark_dirty(surface);
    cairo_t *cr = cairo_create(surface);
    overlay_bodies(cr, o, v, p, s);
    if (o->legend) overlay_legend(cr, o, v, p, top);
    bool good = cairo_status(cr) == CAIRO_STATUS_SUCCESS;
    cairo_destroy(cr);
    cairo_surface_flush(surface);
    if (good) copy_pixels(pic, data, cairo_image_surface_get_stride(surface), true);
    cairo_surface_destroy(surface);
    if (good) return 0;
    picture_free(pic);
    return failure_set(failure, EX_SOFTWARE, "no memory for lines and words");
}
