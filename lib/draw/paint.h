/* draw/paint.h: which colour a body has, and the mark by which one sees it turn. */
#ifndef NSD_PAINT_H
#define NSD_PAINT_H

#include "bodies/packing.h"

enum colour { COLOUR_RADIUS, COLOUR_SPEED, COLOUR_KIND, COLOUR_ID, COLOUR_COUNT };
extern const char *const colour_name[COLOUR_COUNT]; /* as the command line has them */

/* Light, linear, 0 to 1: what can be added and averaged. */
struct rgb {
    float r, g, b;
};

struct rgb rgb_mix(struct rgb a, struct rgb b, float t); /* (1 - t) a + t b */
struct rgb rgb_of(unsigned code);                        /* 0xRRGGBB, sRGB */
/* The sRGB byte for linear light, with its table made by paint_init. */
unsigned char rgb_byte(float light);

struct paint {
    enum colour by;
    bool plain;    /* no marks */
    bool fixed;    /* lo and hi are given */
    double lo, hi; /* m or m/s at the palette's ends; lo > hi: nothing seen yet */
    struct rgb palette[256];
};

void paint_init(struct paint *, enum colour, bool plain);
/* lo and hi come to include this packing; speeds begin at 0. */
void paint_range(struct paint *, const struct packing *);
/* A body's own colour. */
struct rgb paint_body(const struct paint *, const struct packing *, int64_t i);
/* The same where the point (unit vector, body frame) of a ball is; and of a disc, inside of the
   unit circle. */
struct rgb paint_ball(const struct paint *, struct rgb own, vec3 point);
struct rgb paint_disc(const struct paint *, struct rgb own, vec3 point);

#endif
