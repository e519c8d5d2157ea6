/* state/external_force.c: memory for what acts from outside [state/external_force.h]. */
#include "state/external_force.h"

#include "base/array.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The first pull of a body with this id, or where it would be */
static int32_t external_force_first_of(const struct drives *d, int32_t id)
{
    int32_t lo = 0, hi = d->n;
    while (lo < hi) {
        int32_t middle = lo + (hi - lo) / 2;
        if (d->drive[middle].wall < id)
            lo = middle + 1;
        else
            hi = middle;
    }
    return lo;
}

vec3 pulls_on(const struct drives *d, int32_t id, double t, bool turns)
{
    vec3 sum = v3(0, 0, 0);
    for (int32_t k = external_force_first_of(d, id); k < d->n && d->drive[k].wall == id; k++) {
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
        for (int32_t k = external_force_first_of(d, id[i]); k < d->n && d->drive[k].wall == id[i];
             k++)
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
        return failure_set(failure, EX_DATAERR,
                           "forces: their largest acceleration is not a number");
    return 0;
}

static void *zeros(int64_t n, size_t size)
{
    return calloc((size_t)n + 1, size);
}

static int external_force_no_memory(struct failure *failure)
{
    return failure_set(failure, EX_SOFTWARE, "no memory for forces from outside");
}

static void lasting_free(struct lasting *s)
{
    free(s->force), free(s->torque), free(s->push);
    *s = (struct lasting){ 0 };
}

void external_force_free(struct external_force *o)
{
    free(o->force), free(o->torque), free(o->push), free(o->words);
    lasting_free(&o->lasts);
    *o = (struct external_force){ 0 };
}

void external_force_forget(struct external_force *o)
{
    const struct external_force had = *o;
    o->lasts = (struct lasting){ 0 };
    external_force_free(o);
    o->steered = had.steered, o->lasts = had.lasts;
}

int external_force_alloc(vec3 **to, int64_t n, struct failure *failure)
{
    if (!*to) *to = zeros(n, sizeof **to);
    return *to ? 0 : external_force_no_memory(failure);
}

static int alloc_push(double **to, int32_t walls, struct failure *failure)
{
    if (!*to) *to = zeros(walls, sizeof **to);
    return *to ? 0 : external_force_no_memory(failure);
}

int external_force_alloc_push(struct external_force *o, int32_t walls, struct failure *failure)
{
    return alloc_push(&o->push, walls, failure);
}

/* *to = a copy of x[n], or NULL */
static int copy_vectors(vec3 **to, const vec3 *x, int64_t n, struct failure *failure)
{
    if (!x) return 0;
    if (external_force_alloc(to, n, failure)) return failure->status;
    memcpy(*to, x, (size_t)n * sizeof *x);
    return 0;
}

static int copy_push(double **to, const double *x, int32_t walls, struct failure *failure)
{
    if (!x) return 0;
    if (alloc_push(to, walls, failure)) return failure->status;
    memcpy(*to, x, (size_t)walls * sizeof *x);
    return 0;
}

int external_force_begin(struct external_force *o, const double *mass, int64_t n, int32_t walls,
                         struct failure *failure)
{
    const struct lasting *s = &o->lasts;
    free(o->force), free(o->torque), free(o->push);
    o->force = o->torque = NULL, o->push = NULL;
    if (copy_vectors(&o->force, s->force, n, failure) ||
        copy_vectors(&o->torque, s->torque, n, failure) ||
        copy_push(&o->push, s->push, walls, failure))
        return failure->status;
    external_force_measure(o, mass, n);
    return 0;
}

void external_force_follow(struct external_force *o, const int32_t *row, int64_t n)
{
    const struct lasting *s = &o->lasts;
    for (int64_t i = 0; (s->force || s->torque) && i < n; i++) {
        if (row[i] < 0) continue;
        if (s->force) s->force[row[i]] = s->force[i];
        if (s->torque) s->torque[row[i]] = s->torque[i];
    }
}

int external_force_resize(struct external_force *o, int64_t had, int64_t n, struct failure *failure)
{
    vec3 **const old[] = { &o->force, &o->torque, &o->lasts.force, &o->lasts.torque };
    enum { ARRAYS = sizeof old / sizeof old[0] };
    vec3 *now[ARRAYS] = { 0 };
    const size_t keep = (size_t)(had < n ? had : n);
    for (int k = 0; k < ARRAYS && !failure->status; k++)
        if (*old[k] && !external_force_alloc(&now[k], n, failure))
            memcpy(now[k], *old[k], keep * sizeof **now);
    for (int k = 0; k < ARRAYS; k++) {
        if (failure->status) free(now[k]);
        if (failure->status || !*old[k]) continue;
        free(*old[k]);
        *old[k] = now[k];
    }
    return failure->status;
}

void external_force_measure(struct external_force *o, const double *mass, int64_t n)
{
    double most = 0;
    for (int64_t i = 0; o->force && i < n; i++) {
        double f2 = v3_dot(o->force[i], o->force[i]), m2 = mass[i] * mass[i];
        if (m2 > 0 && f2 > most * m2) most = f2 / m2;
    }
    o->most = sqrt(most);
}

int external_force_say(struct external_force *o, const char *words, int64_t length,
                       struct failure *failure)
{
    if (!array_grow(&o->words, &o->room, o->length + length, 1))
        return failure_set(failure, EX_SOFTWARE, "no memory for the answer");
    if (length) memcpy(o->words + o->length, words, (size_t)length);
    o->length += length;
    return 0;
}

/* Is every number finite, and in the plane where dim is 2? */
static int check_vectors(const vec3 *force, const vec3 *torque, int dim, int64_t n,
                         struct failure *failure)
{
    for (int64_t i = 0; (force || torque) && i < n; i++) {
        const char *trouble = NULL;
        vec3 f = force ? force[i] : v3(0, 0, 0), m = torque ? torque[i] : v3(0, 0, 0);
        if (!v3_finite(f)) trouble = "force from outside is not finite";
        if (!v3_finite(m)) trouble = "torque from outside is not finite";
        if (dim == 2 && (f.z != 0 || m.x != 0 || m.y != 0))
            trouble = "force from outside leaves the plane, and dim is 2";
        if (trouble)
            return failure_set(failure, EX_DATAERR, "body %lld: %s", (long long)i, trouble);
    }
    return 0;
}

static int check_push(const double *push, int32_t walls, struct failure *failure)
{
    for (int32_t w = 0; push && w < walls; w++)
        if (!isfinite(push[w]))
            return failure_set(failure, EX_DATAERR, "wall %d: force from outside is not finite", w);
    return 0;
}

int external_force_check(const struct external_force *o, int dim, int64_t n, int32_t walls,
                         struct failure *failure)
{
    const struct lasting *s = &o->lasts;
    if (check_vectors(o->force, o->torque, dim, n, failure) ||
        check_push(o->push, walls, failure) || check_vectors(s->force, s->torque, dim, n, failure))
        return failure->status;
    return check_push(s->push, walls, failure);
}
