#include "convert/imported.h"

#include "base/array.h"

#include <stdlib.h>
#include <string.h>

static struct imported_ball imported_ball(void)
{
    return (struct imported_ball){ .q = { 1, 0, 0, 0 }, .type = 1, .id = -1 };
}

int imported_add(struct imported *t, const struct imported_ball *ball, struct failure *failure)
{
    if (t->head.n == IMPORTED_MOST)
        return failure_set(failure, EX_DATAERR, "more than %d balls", IMPORTED_MOST);
    if (!array_grow(&t->ball, &t->room, t->head.n + 1, sizeof *t->ball))
        return failure_set(failure, EX_SOFTWARE, "no memory for the balls of a file");
    t->ball[t->head.n++] = *ball;
    return 0;
}

void imported_free(struct imported *t)
{
    free(t->ball);
    *t = (struct imported){ 0 };
}

/* ---- lines of numbers under named columns, as balls ---- */

static const struct {
    const char *name;
    enum import_column column;
} names[] = {
    { "x", IMPORT_X },
    { "y", IMPORT_Y },
    { "z", IMPORT_Z },
    { "xu", IMPORT_X },
    { "yu", IMPORT_Y },
    { "zu", IMPORT_Z },
    { "xs", IMPORT_XS },
    { "ys", IMPORT_YS },
    { "zs", IMPORT_ZS },
    { "xsu", IMPORT_XS },
    { "ysu", IMPORT_YS },
    { "zsu", IMPORT_ZS },
    { "vx", IMPORT_VX },
    { "vy", IMPORT_VY },
    { "vz", IMPORT_VZ },
    { "omegax", IMPORT_WX },
    { "omegay", IMPORT_WY },
    { "omegaz", IMPORT_WZ },
    { "wx", IMPORT_WX },
    { "wy", IMPORT_WY },
    { "wz", IMPORT_WZ },
    { "quatw", IMPORT_QW },
    { "quati", IMPORT_QX },
    { "quatj", IMPORT_QY },
    { "quatk", IMPORT_QZ },
    { "radius", IMPORT_RADIUS },
    { "r", IMPORT_RADIUS },
    { "diameter", IMPORT_DIAMETER },
    { "mass", IMPORT_MASS },
    { "density", IMPORT_DENSITY },
    { "type", IMPORT_TYPE },
    { "matid", IMPORT_TYPE },
    { "id", IMPORT_ID },
    { "shapex", IMPORT_SHAPEX },
    { "shapey", IMPORT_SHAPEY },
    { "shapez", IMPORT_SHAPEZ },
    { "shape[0]", IMPORT_SHAPEX },
    { "shape[1]", IMPORT_SHAPEY },
    { "shape[2]", IMPORT_SHAPEZ },
    { "c_shape[1]", IMPORT_SHAPEX },
    { "c_shape[2]", IMPORT_SHAPEY },
    { "c_shape[3]", IMPORT_SHAPEZ },
    { "blockiness1", IMPORT_BLOCKINESS1 },
    { "blockiness2", IMPORT_BLOCKINESS2 },
    { "roundness1", IMPORT_BLOCKINESS1 },
    { "roundness2", IMPORT_BLOCKINESS2 },
    { "id_multisphere", IMPORT_MULTISPHERE },
};

enum { NAMES = sizeof names / sizeof names[0] };

static const char *imported_name_of(enum import_column c)
{
    for (int k = 0; k < NAMES; k++)
        if (names[k].column == c) return names[k].name;
    return "?";
}

int import_add_column(struct import_columns *c, struct words *w, enum import_column column)
{
    if (c->n == IMPORT_COLUMNS_MOST)
        return soup_fault(w->soup, "more than %d columns", IMPORT_COLUMNS_MOST);
    c->has[column] = true, c->of[c->n++] = column;
    return 0;
}

int import_name_column(struct import_columns *c, struct words *w, struct word name)
{
    for (int k = 0; k < NAMES; k++)
        if (word_is(name, names[k].name)) return import_add_column(c, w, names[k].column);
    return import_add_column(c, w, IMPORT_OTHER);
}

static bool has_all(const struct import_columns *c, enum import_column first, int n)
{
    for (int k = 0; k < n; k++)
        if (!c->has[(int)first + k]) return false;
    return true;
}

/* LIGGGHTS has half axes, beside the exponents; LAMMPS' shapex is the whole axis. */
static bool has_half_axes(const struct import_columns *c)
{
    return has_all(c, IMPORT_SHAPEX, 3) && has_all(c, IMPORT_BLOCKINESS1, 2);
}

int import_check_columns(const struct import_columns *c, struct words *w, const char *cure)
{
    if (!has_all(c, IMPORT_X, 3) && !has_all(c, IMPORT_XS, 3))
        return soup_fault(w->soup, "no columns x y z: %s", cure);
    const bool axes = has_all(c, IMPORT_SHAPEX, 3);
    if (!axes && (c->has[IMPORT_SHAPEX] || c->has[IMPORT_SHAPEY] || c->has[IMPORT_SHAPEZ]))
        return soup_fault(w->soup, "shapex, shapey and shapez are needed together, for only grains "
                                   "with equal axes are read, as balls");
    if (!c->has[IMPORT_RADIUS] && !c->has[IMPORT_DIAMETER] && !has_half_axes(c))
        return soup_fault(w->soup, "no column radius or diameter: %s", cure);
    return 0;
}

static int read_word(struct words *w, enum import_column c, struct word word, double *x)
{
    if (word_number(w, word, x)) return w->soup->failure->status;
    const bool positive =
        c == IMPORT_RADIUS || c == IMPORT_DIAMETER || c == IMPORT_MASS || c == IMPORT_DENSITY;
    if (positive && !(*x > 0)) return word_fault(w, word, "must be positive");
    if (c != IMPORT_TYPE && c != IMPORT_ID) return 0;
    bool whole = *x >= 0 && *x <= INT32_MAX && *x == (double)(int32_t)*x;
    return whole ? 0 : word_fault(w, word, "must be a whole number from 0 to 2147483647");
}

/* Relative difference of numbers that a dump prints to six digits */
static const double PRINTED = 1e-5;

static bool differ(double a, double b)
{
    return fabs(a - b) > PRINTED * fmax(fabs(a), fabs(b));
}

/* Is the grain a ball? Other shapes have the ball around them for a radius, and parts of clumps have one of their own. */
static int check_ball(const struct import_columns *c, struct words *w, const double *x)
{
    const double *axis = &x[IMPORT_SHAPEX], *exponent = &x[IMPORT_BLOCKINESS1];
    if (has_all(c, IMPORT_SHAPEX, 3) && (differ(axis[0], axis[1]) || differ(axis[0], axis[2])))
        return soup_fault(w->soup,
                          "an ellipsoid or superquadric (shapex %g, shapey %g, shapez %g): only "
                          "balls are read",
                          axis[0], axis[1], axis[2]);
    for (int k = 0; k < 2; k++)
        if (c->has[IMPORT_BLOCKINESS1 + k] && differ(exponent[k], 2))
            return soup_fault(w->soup, "a superquadric (blockiness%d %g): only balls are read",
                              k + 1, exponent[k]);
    if (c->has[IMPORT_MULTISPHERE] && x[IMPORT_MULTISPHERE] >= 0)
        return soup_fault(w->soup, "a part of a clump (id_multisphere %g): only balls are read",
                          x[IMPORT_MULTISPHERE]);
    if (c->has[IMPORT_RADIUS] && c->has[IMPORT_DIAMETER] &&
        differ(2 * x[IMPORT_RADIUS], x[IMPORT_DIAMETER]))
        return soup_fault(w->soup, "a radius %g, and a diameter %g", x[IMPORT_RADIUS],
                          x[IMPORT_DIAMETER]);
    return 0;
}

/* The numbers of a line */
static int read_numbers(const struct import_columns *c, struct words *w, double *x)
{
    bool had[IMPORT_COLUMNS + 1] = { false };
    struct word word;
    for (int k = 0; k < c->n; k++) {
        const enum import_column which = c->of[k];
        double number;
        if (!words_next(w, &word))
            return soup_fault(w->soup, "%d numbers for %d columns (truncated?)", k, c->n);
        if (which == IMPORT_OTHER) continue;
        if (read_word(w, which, word, &number)) return w->soup->failure->status;
        if (had[which] && number != x[which])
            return soup_fault(w->soup, "two columns %s, with %.10g and %.10g: which one is meant?",
                              imported_name_of(which), x[which], number);
        had[which] = true, x[which] = number;
    }
    return words_next(w, &word) ? word_fault(w, word, "is one more than there are columns") : 0;
}

int import_line(const struct import_columns *c, struct words *w, const struct imported_head *head,
                struct imported_ball *b)
{
    double x[IMPORT_COLUMNS] = { 0 };
    if (read_numbers(c, w, x) || check_ball(c, w, x)) return w->soup->failure->status;
    *b = imported_ball();
    b->x = v3(x[IMPORT_X], x[IMPORT_Y], x[IMPORT_Z]);
    if (!c->has[IMPORT_X]) {
        b->x = head->origin;
        for (int k = 0; k < 3; k++) b->x = v3_axpy(b->x, x[IMPORT_XS + k], head->edge[k]);
    }
    b->v = v3(x[IMPORT_VX], x[IMPORT_VY], x[IMPORT_VZ]);
    b->w = v3(x[IMPORT_WX], x[IMPORT_WY], x[IMPORT_WZ]);
    b->radius = c->has[IMPORT_RADIUS]     ? x[IMPORT_RADIUS]
                : c->has[IMPORT_DIAMETER] ? 0.5 * x[IMPORT_DIAMETER]
                                          : x[IMPORT_SHAPEX];
    if (!(b->radius > 0)) return soup_fault(w->soup, "shapex %g must be positive", b->radius);
    b->mass = x[IMPORT_MASS], b->density = x[IMPORT_DENSITY];
    if (c->has[IMPORT_TYPE]) b->type = (int32_t)x[IMPORT_TYPE];
    if (c->has[IMPORT_ID]) b->id = (int32_t)x[IMPORT_ID];
    if (!has_all(c, IMPORT_QW, 4)) return 0;
    quat q = { x[IMPORT_QW], x[IMPORT_QX], x[IMPORT_QY], x[IMPORT_QZ] };
    double length = sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    if (!(fabs(length - 1) < 1e-3))
        return soup_fault(w->soup, "quatw quati quatj quatk is no unit quaternion");
    b->q = quat_unit(q);
    return 0;
}
