/*
 * draw/overlay.h: lines and words over a picture, by cairo: the network of forces, contacts by their
 * status, the legend. The same functions draw on a picture of pixels and, of discs, into an SVG.
 *
 * Words are in the stroke font that is part of cairo, so that they do not depend on the fonts of the
 * machine.
 */
#pragma once

#include "draw/view.h"
#include "state/contact.h"

#include <cairo.h>

struct overlay {
    bool network;  /* a line for each contact that pushes, as wide as its force */
    bool contacts; /* a dot at each contact, its colour the status */
    bool bonds;    /* a line for each bond, its colour the intensity; and for each liquid bridge */
    bool legend;   /* a strip below: the palette, a length, the time */
    double force;  /* N: of the widest line; 0: the largest of the frame */
    const struct solid_walls *solid; /* in the legend, too; NULL: none */
};

/* Lines and areas from now on have this colour. */
void overlay_colour(cairo_t *cr, struct rgb c);
/* Pixels that the legend takes below a picture of this width */
int overlay_strip(const struct overlay *o, int width);

/* What belongs over the bodies; contacts may be NULL. */
void overlay_bodies(cairo_t *cr, const struct overlay *o, const struct view *v,
                    const struct packing *p, const struct contacts *contacts);
/* The legend, in a strip from `top` down to top + overlay_strip() */
void overlay_legend(cairo_t *cr, const struct overlay *o, const struct view *v,
                    const struct packing *p, int top);

/* pic = the picture of view_draw() with all that o asks for. Returns 0, EX_DATAERR, EX_SOFTWARE. */
int overlay_draw(const struct overlay *o, const struct view *v, const struct packing *p,
                 const struct contacts *contacts, struct picture *pic, struct failure *failure);
