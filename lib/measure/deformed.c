#include "measure/deformed.h"

#include "measure/region.h"

#include <math.h>

static struct tensor of_columns(const vec3 e[3])
{
    return (struct tensor){
        { { e[0].x, e[1].x, e[2].x }, { e[0].y, e[1].y, e[2].y }, { e[0].z, e[1].z, e[2].z } }
    };
}

static struct tensor snapshot_times(const struct tensor *A, const struct tensor *B)
{
    struct tensor C;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            C.x[i][j] = A->x[i][0] * B->x[0][j] + A->x[i][1] * B->x[1][j] + A->x[i][2] * B->x[2][j];
    return C;
}

static struct tensor inverse_of(const struct tensor *A)
{
    vec3 column[3], row[3];
    for (int k = 0; k < 3; k++) column[k] = v3(A->x[0][k], A->x[1][k], A->x[2][k]);
    cell_inverse(column, row);
    return (struct tensor){ { { row[0].x, row[0].y, row[0].z },
                              { row[1].x, row[1].y, row[1].z },
                              { row[2].x, row[2].y, row[2].z } } };
}

static double determinant(const struct tensor *A)
{
    const vec3 row[3] = { v3(A->x[0][0], A->x[0][1], A->x[0][2]),
                          v3(A->x[1][0], A->x[1][1], A->x[1][2]),
                          v3(A->x[2][0], A->x[2][1], A->x[2][2]) };
    return v3_dot(row[0], v3_cross(row[1], row[2]));
}

/* 1 + s L, L the velocity gradient of the edges' rates */
static struct tensor snapshot_grown(const struct deformed *d, double s)
{
    const struct tensor E = of_columns(d->span), V = of_columns(d->rate), I = inverse_of(&E);
    struct tensor G = snapshot_times(&V, &I);
    tensor_scale(&G, s);
    for (int k = 0; k < 3; k++) G.x[k][k] += 1;
    return G;
}

/* Where everything is now */
static void snapshot_look(struct deformed *d, const struct packing *p)
{
    struct region all;
    region_whole(&all, p);
    for (int k = 0; k < 3; k++) {
        double far = k < p->dim && p->n ? all.hi[k] - all.lo[k] : 1;
        vec3 along = v3((k == 0) * far, (k == 1) * far, (k == 2) * far);
        d->span[k] = p->cell.repeats[k] ? p->cell.edge[k] : along;
        d->rate[k] = p->cell.repeats[k] ? p->cell.rate[k] : v3(0, 0, 0);
    }
    d->t = p->t;
}

/* The whole numbers by which the edges of `now` differ from those of `then` deformed; false: no such */
static bool recut(const struct deformed *then, const struct deformed *now, struct tensor *N)
{
    double half = (now->t - then->t) / 2;
    struct tensor ahead = snapshot_grown(then, half), back = snapshot_grown(now, -half), E = of_columns(then->span);
    struct tensor to = of_columns(now->span), from = snapshot_times(&ahead, &E);
    // the rates say how far the edges have gone by half a span of time from either end
    to = snapshot_times(&back, &to);
    from = inverse_of(&from);
    *N = snapshot_times(&from, &to);
    for (int k = 0; k < 9; k++) N->x[k / 3][k % 3] = rint(N->x[k / 3][k % 3]);
    return fabs(determinant(N)) == 1;
}

void deformed_follow(struct deformed *d, const struct packing *p)
{
    struct deformed now = { .known = true };
    struct tensor N;
    snapshot_look(&now, p);
    now.lost = d->lost;
    if (!d->known) {
        now.F = (struct tensor){ { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
    } else if (!recut(d, &now, &N)) {
        now.lost = true, now.F = d->F;
    } else {
        struct tensor E = of_columns(d->span), EN = snapshot_times(&E, &N), to = of_columns(now.span);
        EN = inverse_of(&EN);
        struct tensor step = snapshot_times(&to, &EN);
        now.F = snapshot_times(&step, &d->F);
    }
    *d = now;
}
