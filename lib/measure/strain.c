/* measure/strain.c: the logarithmic strain since the first frame. */
#include "measure/measures.h"
#include "measure/snapshot.h"

#include <math.h>

static const struct quantity quantities[] = {
    { "since", "s", 1, "time since the first frame" },
    { "volumetric", "1", 1, "- ln(V/V0), compression positive" },
    { "shear", "1", 1, "sqrt(2/3 e:e) of the deviator e (2D: difference of the principal values)" },
    { "tensor", "1", 9, "- ln V of F = V R, compression positive" },
    { "principal", "1", 3, "principal values, the largest first" },
    { "gradient", "1", 9, "deformation gradient F" },
    { 0 },
};

/* -ln V = -1/2 ln(F F^T) */
static struct tensor strain_of(const struct tensor *F, int dim)
{
    struct tensor B = { { { 0 } } };
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) B.x[i][j] += F->x[i][k] * F->x[j][k];
    struct tensor H = tensor_log(&B, dim);
    for (int k = 0; k < 9; k++) H.x[k / 3][k % 3] = 0 - 0.5 * H.x[k / 3][k % 3];
    return H;
}

static int strain_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    int dim = s->p->dim;
    struct deformed now = { 0 };
    double value[3], *at = table_row(t, failure);
    if (!at) return failure->status;
    if (s->before) now = s->before->form;
    deformed_follow(&now, s->p);
    put(&at, s->first ? s->p->t - s->first->t : 0);
    struct tensor H = strain_of(&now.F, dim);
    bool good = !now.lost;
    for (int k = 0; k < 9; k++) good = good && isfinite(H.x[k / 3][k % 3]);
    if (!good) {
        table_null(t, "%s",
                   now.lost ? "the cell's edges cannot be followed: frames at shorter times"
                            : "the room of the grains has no extent");
        return 0;
    }
    tensor_principal(&H, dim, value);
    put(&at, tensor_trace(&H));
    put(&at, tensor_deviator(&H, dim) * (dim == 2 ? 2 : 2.0 / 3));
    put_tensor(&at, &H);
    for (int k = 0; k < 3; k++) put(&at, value[k]);
    put_tensor(&at, &now.F);
    return 0;
}

const struct measure measure_strain = {
    .name = "strain",
    .help = "logarithmic strain of the cell, or of the space between walls, since the first frame",
    .quantity = quantities,
    .needs = NEEDS_BODIES,
    .remembers = true,
    .rows = strain_rows,
};
