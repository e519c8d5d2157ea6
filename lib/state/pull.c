#include "state/pull.h"

#include <math.h>

/* The first pull of a body with this id, or where it would be */
static int32_t external_force_first_of(const struct drives *d, int32_t id)
{
    int32_t lo = 0, hi = d->n;
    while (lo < hi) {
        int32_t middle = lo + (hi - lo) / 2;
        if (d->drive[middle].boundary < id)
            lo = middle + 1;
        else
            hi = middle;
    }
    return lo;
}

vec3 pulls_on(const struct drives *d, int32_t id, double t, bool turns)
{
    vec3 sum = v3(0, 0, 0);
    for (int32_t k = external_force_first_of(d, id); k < d->n && d->drive[k].boundary == id; k++) {
        const struct drive *s = &d->drive[k];
        if (s->turns == turns && t >= s->from && t < s->until)
            sum = v3_axpy(sum, drive_way(d, s, t), s->axis);
    }
    return sum;
}

/* N: its size at most */
static double external_force_largest(const struct drives *d, const struct drive *k)
{
    double most = k->signal == DRIVE_TABLE ? 0 : fabs(k->value);
    for (int32_t i = 0; k->signal == DRIVE_TABLE && i < k->rows; i++)
        most = fmax(most, fabs(d->row[k->first + i].s));
    return most;
}

double pulls_most(const struct drives *d, int64_t n, const int32_t *id, const double *mass)
{
    double most = 0;
    for (int64_t i = 0; d->n && i < n; i++) {
        double sum = 0;
        for (int32_t k = external_force_first_of(d, id[i]); k < d->n && d->drive[k].boundary == id[i]; k++)
            if (!d->drive[k].turns) sum += external_force_largest(d, &d->drive[k]);
        if (mass[i] > 0) most = fmax(most, sum / mass[i]);
    }
    return most;
}

int pulls_check(const struct drives *d, double most, int dim, struct failure *failure)
{
    if (drives_check(d, INT32_MAX, dim, "force", failure)) return failure->status;
    for (int32_t k = 0; k < d->n; k++)
        if (d->drive[k].signal == DRIVE_SPEED)
            return failure_set(failure, EX_DATAERR, "force %d: no such signal", k);
    if (!(most >= 0 && isfinite(most)))
        return failure_set(failure, EX_DATAERR, "forces: their largest acceleration is not a number");
    return 0;
}
