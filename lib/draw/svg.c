/* draw/svg.c: discs, walls and what lies over them, by cairo's SVG surface. */
#include "draw/svg.h"

#include "draw/images.h"

#include <cairo-svg.h>
#include <stdlib.h>
#include <string.h>

/* A shape in one colour, wider by `rim` (pixels) all around: its core filled, and drawn with a round pen */
static void draw_core(cairo_t *cr, const struct view *v, const struct packing *p, int64_t i,
                      double rim)
{
    const struct shape *s = packing_shape(p, i);
    const bool faces = shape_has_faces(s);
    double r = p->radius[i], scale = 0;
    for (int32_t k = 0; k < shape_parts(s); k++) {
        const struct shape_part part = shape_part(s, k);
        const int32_t n = faces ? s->corners : part.n;
        for (int32_t j = 0; j < n; j++) {
            int32_t vertex = faces ? s->corner[j] : part.first + j;
            vec3 x = v3_axpy(p->x[i], r, quat_turn(p->q[i], s->vertex[vertex]));
            vec3 at = view_sees(v, x, &scale);
            if (n == 1)
                cairo_arc(cr, at.x, at.y, part.round * r * scale + rim, 0, 2 * M_PI);
            else
                (j ? cairo_line_to : cairo_move_to)(cr, at.x, at.y);
        }
        cairo_set_line_width(cr, 2 * (part.round * r * scale + rim));
        cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
        cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
        if (faces) cairo_close_path(cr), cairo_fill_preserve(cr);
        if (n == 1)
            cairo_fill(cr);
        else if (part.round * r * scale + rim > 0)
            cairo_stroke(cr);
        else
            cairo_new_path(cr);
    }
}

static void svg_draw_shape(cairo_t *cr, const struct view *v, const struct packing *p, int64_t i,
                           struct rgb own, double r)
{
    const struct rgb dark = { 0.06F, 0.06F, 0.06F };
    const struct shape *s = packing_shape(p, i);
    double rim = fmin(0.08 * r, 0.8);
    if (!shape_has_faces(s) || s->round * r > rim) {
        overlay_colour(cr, dark), draw_core(cr, v, p, i, 0);
        overlay_colour(cr, own), draw_core(cr, v, p, i, -rim);
        return;
    }
    overlay_colour(cr, own);
    draw_core(cr, v, p, i, 0); // a sharp one: its rim is drawn over it, half of it outside
    overlay_colour(cr, dark);
    cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
    for (int32_t k = 0; k < s->corners; k++) {
        double scale;
        vec3 x = v3_axpy(p->x[i], p->radius[i], quat_turn(p->q[i], s->vertex[s->corner[k]]));
        vec3 at = view_sees(v, x, &scale);
        (k ? cairo_line_to : cairo_move_to)(cr, at.x, at.y);
    }
    cairo_close_path(cr);
    cairo_set_line_width(cr, rim);
    cairo_stroke(cr);
}

/* The disc, its half that was up when it was made paler, and its rim */
static void draw_disc(cairo_t *cr, const struct view *v, const struct packing *p, int64_t i)
{
    double scale;
    vec3 at = view_sees(v, p->x[i], &scale);
    double r = p->radius[i] * scale, angle = 2 * atan2(p->q[i].z, p->q[i].w);
    angle -= atan2(v->camera.right.y, v->camera.right.x);
    if (at.x + r < 0 || at.x - r > v->camera.width || at.y + r < 0 || at.y - r > v->camera.height)
        return;
    struct rgb own = paint_body(&v->paint, p, i);
    own = rgb_mix(own, v->background, v->pale);
    if (packing_shape(p, i)) {
        svg_draw_shape(cr, v, p, i, own, r);
        return;
    }
    overlay_colour(cr, own);
    cairo_arc(cr, at.x, at.y, r, 0, 2 * M_PI);
    cairo_fill(cr);
    if (!v->paint.plain) {
        struct rgb half = rgb_mix(paint_disc(&v->paint, own, v3(0, 1, 0)), v->background, v->pale);
        overlay_colour(cr, half);
        cairo_arc(cr, at.x, at.y, r, M_PI - angle, 2 * M_PI - angle);
        cairo_fill(cr);
    }
    overlay_colour(cr, (struct rgb){ 0.06F, 0.06F, 0.06F });
    cairo_set_line_width(cr, fmin(0.08 * r, 0.8));
    cairo_arc(cr, at.x, at.y, r, 0, 2 * M_PI);
    cairo_stroke(cr);
}

/* 0; -1: no memory */
static int draw_walls(cairo_t *cr, const struct view *v, const struct packing *p)
{
    struct walls *b = malloc(sizeof *b);
    if (!b) return -1;
    const struct extent r = { v3_add(v->region.lo, v->moved), v3_add(v->region.hi, v->moved) };
    walls_build(b, p, &r);
    images_outline(b, p);
    cairo_set_source_rgb(cr, 0.2, 0.2, 0.2);
    cairo_set_line_width(cr, 1.2);
    for (int i = 0; i < b->edges; i++) {
        double scale;
        vec3 from = view_sees(v, b->edge[i].a, &scale), to = view_sees(v, b->edge[i].b, &scale);
        cairo_move_to(cr, from.x, from.y);
        cairo_line_to(cr, to.x, to.y);
        cairo_stroke(cr);
    }
    free(b);
    return 0;
}

static cairo_status_t svg_keep(void *picture, const unsigned char *data, unsigned n)
{
    struct bytes_out *b = picture;
    return bytes_append(b, data, n) ? CAIRO_STATUS_NO_MEMORY : CAIRO_STATUS_SUCCESS;
}

/* Is all of it there? */
static bool draw_all(cairo_t *cr, const struct overlay *o, const struct view *v,
                     const struct packing *p, const struct contacts *contacts)
{
    overlay_colour(cr, v->background);
    cairo_paint(cr);
    cairo_save(cr);
    cairo_rectangle(cr, 0, 0, v->camera.width, v->camera.height);
    cairo_clip(cr);
    for (int64_t i = 0; i < p->n; i++)
        if (view_shows(v, p, i)) draw_disc(cr, v, p, i);
    int missing = draw_walls(cr, v, p);
    cairo_restore(cr);
    overlay_bodies(cr, o, v, p, contacts);
    if (o->legend) overlay_legend(cr, o, v, p, v->camera.height);
    return !missing && cairo_status(cr) == CAIRO_STATUS_SUCCESS;
}

int svg_draw(const struct overlay *o, const struct view *v, const struct packing *p,
             const struct contacts *contacts, const char *path, struct failure *failure)
{
    const struct camera *c = &v->camera;
    struct bytes_out b = { 0 };
    if (p->dim != 2)
        return failure_set(failure, EX_DATAERR, "an SVG shows discs, and dim is %d", p->dim);
    cairo_surface_t *surface = cairo_svg_surface_create_for_stream(
        svg_keep, &b, c->width, c->height + overlay_strip(o, c->width));
    cairo_t *cr = cairo_create(surface);
    bool good = draw_all(cr, o, v, p, contacts);
    cairo_destroy(cr);
    cairo_surface_finish(surface);
    good &= cairo_surface_status(surface) == CAIRO_STATUS_SUCCESS;
    cairo_surface_destroy(surface);
    if (!good)
        failure_set(failure, EX_SOFTWARE, "no memory for the SVG");
    else
        bytes_write(&b, path, failure);
    free(b.at);
    return failure->status;
}
