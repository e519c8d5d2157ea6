/* bodies/outside.c: memory for what acts from outside [bodies/outside.h]. */
#include "bodies/outside.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void *zeros(int64_t n, size_t size)
{
    return calloc((size_t)n + 1, size);
}

static int no_memory(struct why *why)
{
    return why_set(why, EX_SOFTWARE, "no memory for forces from outside");
}

void outside_free(struct outside *o)
{
    free(o->force), free(o->torque), free(o->push), free(o->words);
    *o = (struct outside){ 0 };
}

void outside_forget(struct outside *o)
{
    bool steered = o->steered;
    outside_free(o);
    o->steered = steered;
}

int outside_alloc(vec3 **to, int64_t n, struct why *why)
{
    if (!*to) *to = zeros(n, sizeof **to);
    return *to ? 0 : no_memory(why);
}

int outside_alloc_push(struct outside *o, int32_t walls, struct why *why)
{
    if (!o->push) o->push = zeros(walls, sizeof *o->push);
    return o->push ? 0 : no_memory(why);
}

int outside_copy(struct outside *to, const struct outside *o, int64_t n, int32_t walls,
                 struct why *why)
{
    *to = (struct outside){ .steered = o->steered, .most = o->most };
    if ((o->force && outside_alloc(&to->force, n, why)) ||
        (o->torque && outside_alloc(&to->torque, n, why)) ||
        (o->push && outside_alloc_push(to, walls, why)) ||
        (o->length && outside_say(to, o->words, o->length, why)))
        return outside_free(to), why->status;
    if (o->force) memcpy(to->force, o->force, (size_t)n * sizeof *o->force);
    if (o->torque) memcpy(to->torque, o->torque, (size_t)n * sizeof *o->torque);
    if (o->push) memcpy(to->push, o->push, (size_t)walls * sizeof *o->push);
    return 0;
}

int outside_resize(struct outside *o, int64_t had, int64_t n, struct why *why)
{
    struct outside now = { 0 };
    size_t keep = (size_t)(had < n ? had : n);
    if ((o->force && outside_alloc(&now.force, n, why)) ||
        (o->torque && outside_alloc(&now.torque, n, why)))
        return outside_free(&now), why->status;
    if (o->force) memcpy(now.force, o->force, keep * sizeof *o->force);
    if (o->torque) memcpy(now.torque, o->torque, keep * sizeof *o->torque);
    free(o->force), free(o->torque);
    o->force = now.force, o->torque = now.torque;
    return 0;
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

int outside_check(const struct outside *o, int dim, int64_t n, int32_t walls, struct why *why)
{
    for (int64_t i = 0; (o->force || o->torque) && i < n; i++) {
        const char *trouble = NULL;
        vec3 f = o->force ? o->force[i] : v3(0, 0, 0), m = o->torque ? o->torque[i] : v3(0, 0, 0);
        if (!v3_finite(f)) trouble = "force from outside is not finite";
        if (!v3_finite(m)) trouble = "torque from outside is not finite";
        if (dim == 2 && (f.z != 0 || m.x != 0 || m.y != 0))
            trouble = "force from outside leaves the plane, and dim is 2";
        if (trouble) return why_set(why, EX_DATAERR, "body %lld: %s", (long long)i, trouble);
    }
    for (int32_t w = 0; o->push && w < walls; w++)
        if (!isfinite(o->push[w]))
            return why_set(why, EX_DATAERR, "wall %d: force from outside is not finite", w);
    return 0;
}
