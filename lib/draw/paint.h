/* draw/paint.h: the colour of a body, and the marks that show how it turns. */
#pragma once

#include "state/contact.h"
#include "state/packing.h"

#include <stdio.h>

enum colour {
    COLOUR_RADIUS,
    COLOUR_SPEED,
    COLOUR_MATERIAL,
    COLOUR_ID,
    COLOUR_SPIN,
    COLOUR_HEIGHT,
    COLOUR_MASS,
    COLOUR_CONTACTS,   /* that push it */
    COLOUR_FORCE,      /* the sum of its normal forces */
    COLOUR_VALUE,      /* a number for each body, from elsewhere */
    COLOUR_GROUP,      /* the name of its group */
    COLOUR_GENERATION, /* how many of its ancestors have broken */
    COLOUR_DAMAGE,     /* 0 to 1, with which it breaks */
    COLOUR_COUNT
};

/* What a colour shows; a table in paint.c */
struct colour_meaning {
    const char *name, *unit; /* as the command line and the legend have them */
    bool classes;            /* a few colours that differ, not a palette */
    bool from_zero;          /* the palette begins at 0 */
    bool given;              /* the numbers are in paint->value */
};
extern const struct colour_meaning colour_meaning[COLOUR_COUNT];

/* Linear light, 0 to 1, which can be added and averaged */
struct rgb {
    float r, g, b;
};

struct rgb rgb_mix(struct rgb a, struct rgb b, float t); /* (1 - t) a + t b */
struct rgb rgb_of(unsigned code);                        /* of 0xRRGGBB, sRGB */
/* The sRGB byte for linear light; paint_init must have made its table. */
unsigned char rgb_byte(float light);

struct paint {
    enum colour by;
    bool plain;          /* no marks */
    bool fixed;          /* lo and hi are given */
    double lo, hi;       /* at the palette's ends; lo > hi: nothing seen yet */
    const char *name;    /* of COLOUR_VALUE's numbers; or NULL */
    const double *value; /* [bodies] of this packing, where the meaning says so; NAN: none */
    struct rgb palette[256];
};

void paint_init(struct paint *p, enum colour by, bool plain);
/* Widens [lo, hi] to the values of this packing, unless fixed; speeds begin at 0. */
void paint_range(struct paint *p, const struct packing *packing);
/* The colour of body i, without marks */
struct rgb paint_body(const struct paint *p, const struct packing *packing, int64_t i);
/* That of a material, where colours are materials */
struct rgb paint_material(int32_t material);
/* The colour with marks, at a point in the body's axes: of a ball a unit vector, of a disc within
   the unit circle. own: paint_body() of it. */
struct rgb paint_ball(const struct paint *p, struct rgb own, vec3 point);
struct rgb paint_disc(const struct paint *p, struct rgb own, vec3 point);

/* A number for each body, for its colour: of its contacts, or out of a table. */

/* Numbers by step and id, out of a table. All zero to begin with. */
struct values {
    char *name; /* of their column */
    int64_t n, room;
    struct value {
        int64_t step, id; /* step -1: of every step */
        double x;
    } * row; /* [n] sorted by (step, id) */
};

/*
 * Reads a table: lines of numbers, columns separated by blanks or tabs, their names in the first
 * line, perhaps after a #. There must be `id`; with `step`, a row is of that step alone. `column`
 * names the numbers wanted; NULL: the last column. Returns 0, EX_DATAERR with file and line, or
 * EX_NOINPUT, EX_SOFTWARE.
 */
int values_read(struct values *v, const char *path, const char *column, struct failure *failure);
void values_free(struct values *v);

/* out[p->n] = what colours of this meaning show; contacts, values may be NULL: NAN. */
void values_of(double *out, enum colour by, const struct packing *p,
               const struct contacts *contacts, const struct values *values);
