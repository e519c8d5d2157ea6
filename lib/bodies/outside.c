/* bodies/outside.c: memory for what acts from outside [bodies/outside.h]. */
#include "bodies/outside.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void *zeros(int64_t n, size_t size)
{
    return calloc((size_t)n + 1, size);
}

static int external_force_no_memory(struct why *why)
{
    return why_set(why, EX_SOFTWARE, "no memory for forces from outside");
}

static void lasting_free(struct lasting *s)
{
    free(s->force), free(s->torque), free(s->push);
    *s = (struct lasting){ 0 };
}

void outside_free(struct outside *o)
{
    free(o->force), free(o->torque), free(o->push), free(o->words);
    lasting_free(&o->lasts);
    *o = (struct outside){ 0 };
}

void outside_forget(struct outside *o)
{
    const struct outside had = *o;
    o->lasts = (struct lasting){ 0 };
    outside_free(o);
    o->steered = had.steered, o->lasts = had.lasts;
}

int outside_alloc(vec3 **to, int64_t n, struct why *why)
{
    if (!*to) *to = zeros(n, sizeof **to);
    return *to ? 0 : external_force_no_memory(why);
}

static int alloc_push(double **to, int32_t walls, struct why *why)
{
    if (!*to) *to = zeros(walls, sizeof **to);
    return *to ? 0 : external_force_no_memory(why);
}

int outside_alloc_push(struct outside *o, int32_t walls, struct why *why)
{
    return alloc_push(&o->push, walls, why);
}

/* *to = a copy of x[n], or NULL */
static int copy_vectors(vec3 **to, const vec3 *x, int64_t n, struct why *why)
{
    if (!x) return 0;
    if (outside_alloc(to, n, why)) return why->status;
    memcpy(*to, x, (size_t)n * sizeof *x);
    return 0;
}

static int copy_push(double **to, const double *x, int32_t walls, struct why *why)
{
    if (!x) return 0;
    if (alloc_push(to, walls, why)) return why->status;
    memcpy(*to, x, (size_t)walls * sizeof *x);
    return 0;
}

int outside_copy(struct outside *to, const struct outside *from, int64_t n, int32_t walls,
                 struct why *why)
{
    const struct lasting *s = &from->lasts;
    *to = (struct outside){ .steered = from->steered, .most = from->most };
    if (copy_vectors(&to->force, from->force, n, why) ||
        copy_vectors(&to->torque, from->torque, n, why) ||
        copy_push(&to->push, from->push, walls, why) ||
        copy_vectors(&to->lasts.force, s->force, n, why) ||
        copy_vectors(&to->lasts.torque, s->torque, n, why) ||
        copy_push(&to->lasts.push, s->push, walls, why) ||
        (from->length && outside_say(to, from->words, from->length, why)))
        return outside_free(to), why->status;
    return 0;
}

int outside_begin(struct outside *o, const double *mass, int64_t n, int32_t walls, struct why *why)
{
    const struct lasting *s = &o->lasts;
    free(o->force), free(o->torque), free(o->push);
    o->force = o->torque = NULL, o->push = NULL;
    if (copy_vectors(&o->force, s->force, n, why) || copy_vectors(&o->torque, s->torque, n, why) ||
        copy_push(&o->push, s->push, walls, why))
        return why->status;
    outside_measure(o, mass, n);
    return 0;
}

void outside_follow(struct outside *o, const int32_t *row, int64_t n)
{
    const struct lasting *s = &o->lasts;
    for (int64_t i = 0; (s->force || s->torque) && i < n; i++) {
        if (row[i] < 0) continue;
        if (s->force) s->force[row[i]] = s->force[i];
        if (s->torque) s->torque[row[i]] = s->torque[i];
    }
}

int outside_resize(struct outside *o, int64_t had, int64_t n, struct why *why)
{
    vec3 **const old[] = { &o->force, &o->torque, &o->lasts.force, &o->lasts.torque };
    enum { ARRAYS = sizeof old / sizeof old[0] };
    vec3 *now[ARRAYS] = { 0 };
    const size_t keep = (size_t)(had < n ? had : n);
    for (int k = 0; k < ARRAYS && !why->status; k++)
        if (*old[k] && !outside_alloc(&now[k], n, why))
            memcpy(now[k], *old[k], keep * sizeof **now);
    for (int k = 0; k < ARRAYS; k++) {
        if (why->status) free(now[k]);
        if (why->status || !*old[k]) continue;
        free(*old[k]);
        *old[k] = now[k];
    }
    return why->status;
}

void outside_measure(struct outside *o, const double *mass, int64_t n)
{
    double most = 0;
    for (int64_t i = 0; o->force && i < n; i++) {
        double f2 = v3_dot(o->force[i], o->force[i]), m2 = mass[i] * mass[i];
        if (m2 > 0 && f2 > most * m2) most = f2 / m2;
    }
    o->most = sqrt(most);
}

int outside_say(struct outside *o, const char *words, int64_t length, struct why *why)
{
    if (o->length + length > o->room) {
        int64_t room = 2 * (o->length + length);
        char *more = realloc(o->words, (size_t)room);
        if (!more) return why_set(why, EX_SOFTWARE, "no memory for the answer");
        o->words = more, o->room = room;
    }
    if (length) memcpy(o->words + o->length, words, (size_t)length);
    o->length += length;
    return 0;
}

/* Is every number finite, and in the plane where dim is 2? */
static int check_vectors(const vec3 *force, const vec3 *torque, int dim, int64_t n, struct why *why)
{
    for (int64_t i = 0; (force || torque) && i < n; i++) {
        const char *trouble = NULL;
        vec3 f = force ? force[i] : v3(0, 0, 0), m = torque ? torque[i] : v3(0, 0, 0);
        if (!v3_finite(f)) trouble = "force from outside is not finite";
        if (!v3_finite(m)) trouble = "torque from outside is not finite";
        if (dim == 2 && (f.z != 0 || m.x != 0 || m.y != 0))
            trouble = "force from outside leaves the plane, and dim is 2";
        if (trouble) return why_set(why, EX_DATAERR, "body %lld: %s", (long long)i, trouble);
    }
    return 0;
}

static int check_push(const double *push, int32_t walls, struct why *why)
{
    for (int32_t w = 0; push && w < walls; w++)
        if (!isfinite(push[w]))
            return why_set(why, EX_DATAERR, "wall %d: force from outside is not finite", w);
    return 0;
}

int outside_check(const struct outside *o, int dim, int64_t n, int32_t walls, struct why *why)
{
    const struct lasting *s = &o->lasts;
    if (check_vectors(o->force, o->torque, dim, n, why) || check_push(o->push, walls, why) ||
        check_vectors(s->force, s->torque, dim, n, why))
        return why->status;
    return check_push(s->push, walls, why);
}
