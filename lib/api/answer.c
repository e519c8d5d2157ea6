#include "api/answer.h"

#include <stdlib.h>
#include <string.h>

json_t *answer_parse(const char *line, size_t length, struct why *why)
{
    json_error_t e;
    while (length && strchr(" \t\r\n", line[length - 1])) length--;
    if (!length) {
        why_set(why, EX_DATAERR, "the answer is an empty line: {} changes nothing");
        return NULL;
    }
    json_t *j = length == 4 && !memcmp(line, "stop", 4)
                    ? json_pack("{s:b}", "stop", 1)
                    : json_loadb(line, length, JSON_REJECT_DUPLICATES, &e);
    if (!j)
        why_set(why, EX_DATAERR, "the answer is not JSON: %.100s (column %d)",
                length == 4 ? "no memory" : e.text, length == 4 ? 0 : e.column);
    else if (!json_is_object(j))
        why_set(why, EX_DATAERR, "the answer is neither a JSON object nor the word stop");
    if (!why->status) return j;
    json_decref(j);
    return NULL;
}

static int reply_wrong(struct why *why, const char *what)
{
    return why_set(why, EX_DATAERR, "the answer's %s", what);
}

/* As many numbers as the space has dimensions, or three */
static bool vector(const json_t *j, int dim, vec3 *x)
{
    size_t n = json_array_size(j);
    double a[3] = { 0 };
    if (!json_is_array(j) || (n != 3 && n != (size_t)dim)) return false;
    for (size_t k = 0; k < n; k++) {
        if (!json_is_number(json_array_get(j, k))) return false;
        a[k] = json_number_value(json_array_get(j, k));
    }
    *x = v3(a[0], a[1], a[2]);
    return true;
}

/* A number that is a key, written in one way only, so that no two keys are the same number: at least 0; -1: it is none */
static int64_t reply_whole(const char *text)
{
    int64_t n = 0;
    if (text[0] == '0' && text[1]) return -1;
    for (const char *c = text; *c; c++) {
        if (*c < '0' || *c > '9') return -1;
        n = 10 * n + (*c - '0');
        if (n > INT32_MAX) return -1;
    }
    return *text ? n : -1;
}

/* The keys of an answer, and what they have for values */
static const struct {
    const char *key;
    bool array, object, boolean;
} known[] = {
    { "forces", .array = true, .object = true },
    { "torques", .array = true, .object = true },
    { "velocities", .array = true, .object = true },
    { "angular_velocities", .array = true, .object = true },
    { "boundaries", .object = true },
    { "gravity", .array = true },
    { "friction", .array = true },
    { "stop", .boolean = true },
};
enum { KEYS = sizeof known / sizeof *known };

/* What an answer has of each body: the first of them */
enum reply_part { FORCES, TORQUES, VELOCITIES, SPINS, PARTS };

static int reply_set(struct acts *acts, enum reply_part part, struct packing *p, int64_t i, const json_t *j,
               struct why *why)
{
    vec3 x;
    if (!vector(j, p->dim, &x))
        return why_set(why, EX_DATAERR, "the answer's %s are vectors [x, y, z]", known[part].key);
    if (part == VELOCITIES || part == SPINS) return acts_motion(p, i, part == SPINS, x, why);
    bool torque = part == TORQUES;
    (torque ? acts->twists : acts->pushes)[ACTS_LASTING] = true;
    (torque ? acts->torque : acts->force)[ACTS_LASTING][i] = x;
    return 0;
}

/* Of all bodies in their order, or of those with these ids */
static int set_all(const json_t *j, struct acts *acts, enum reply_part part, struct packing *p,
                   struct why *why)
{
    const char *id;
    json_t *x;
    if (!j) return 0;
    if (json_is_array(j) && json_array_size(j) != (size_t)p->n)
        return why_set(why, EX_DATAERR, "the answer has %zu %s, and there are %lld bodies",
                       json_array_size(j), known[part].key, (long long)p->n);
    for (size_t i = 0; json_is_array(j) && i < json_array_size(j); i++)
        if (reply_set(acts, part, p, (int64_t)i, json_array_get(j, i), why)) return why->status;
    json_object_foreach((json_t *)j, id, x)
    {
        int64_t number = reply_whole(id), i = number < 0 ? -1 : acts_row(p, (int32_t)number);
        if (i < 0)
            return why_set(why, EX_DATAERR,
                           "the answer has %s of body '%.40s', which does not exist",
                           known[part].key, id);
        if (reply_set(acts, part, p, i, x, why)) return why->status;
    }
    return 0;
}

static int set_boundary(const json_t *j, struct acts *acts, struct packing *p, int64_t wall,
                        struct why *why)
{
    const char *key;
    json_t *x;
    vec3 v;
    if (!json_is_object(j)) return reply_wrong(why, "boundaries have velocity and force");
    json_object_foreach((json_t *)j, key, x)
    {
        if (!strcmp(key, "velocity")) {
            if (!vector(x, p->dim, &v)) return reply_wrong(why, "velocity is a vector [x, y, z]");
            acts_velocity(p, wall, v, why);
        } else if (!strcmp(key, "force")) {
            if (!json_is_number(x)) return reply_wrong(why, "force of a boundary is a number");
            acts_push(acts, p, wall, json_number_value(x), ACTS_LASTING, why);
        } else {
            why_set(why, EX_DATAERR, "the answer's boundaries have no '%.40s'", key);
        }
        if (why->status) return why->status;
    }
    return 0;
}

static int set_boundaries(const json_t *j, struct acts *acts, struct packing *p, struct why *why)
{
    const char *key;
    json_t *x;
    json_object_foreach((json_t *)j, key, x)
    {
        const int32_t name = names_find(&p->names, key, strlen(key));
        int64_t wall = reply_whole(key); // a name is no number
        for (int32_t k = 0; name >= 0 && k < p->names.rows && !why->status; k++) {
            const struct named *r = &p->names.row[k];
            if (r->name == name && !r->count) set_boundary(x, acts, p, wall = r->boundary, why);
        }
        if (why->status || (name >= 0 && wall >= 0)) continue;
        if (wall < 0)
            why_set(why, EX_DATAERR, "the answer's boundaries: no wall is named '%.60s'", key);
        else
            set_boundary(x, acts, p, wall, why);
    }
    return why->status;
}

static int set_frictions(const json_t *j, struct packing *p, struct why *why)
{
    for (size_t k = 0; k < json_array_size(j); k++) {
        const json_t *x = json_array_get(j, k);
        const json_t *a = json_array_get(x, 0), *b = json_array_get(x, 1),
                     *mu = json_array_get(x, 2);
        if (json_array_size(x) != 3 || !json_is_string(a) || !json_is_string(b) ||
            !json_is_number(mu))
            return reply_wrong(why, "friction is [[KIND, KIND, mu], ...]");
        if (acts_friction(p, json_string_value(a), json_string_value(b), json_number_value(mu),
                          why))
            return why->status;
    }
    return 0;
}

int answer_check(const json_t *answer, struct why *why)
{
    const char *key;
    json_t *x;
    json_object_foreach((json_t *)answer, key, x)
    {
        int k = 0;
        while (k < KEYS && strcmp(key, known[k].key) != 0) k++;
        if (k == KEYS)
            return why_set(why, EX_DATAERR,
                           "the answer has no '%.40s': it has forces, torques, velocities, "
                           "angular_velocities, boundaries, gravity, friction, stop",
                           key);
        if ((known[k].array && json_is_array(x)) || (known[k].object && json_is_object(x)) ||
            (known[k].boolean && json_is_boolean(x)))
            continue;
        if (known[k].boolean) return reply_wrong(why, "stop is true or false");
        return why_set(why, EX_DATAERR, "the answer's %s is %s", key,
                       k < PARTS         ? "an array, or an object by ids"
                       : known[k].object ? "an object by their numbers"
                       : k == KEYS - 2   ? "[[KIND, KIND, mu], ...]"
                                         : "a vector [x, y, z]");
    }
    return 0;
}

/* What an answer may change, as it was: an answer that is refused has changed nothing. */
struct reply_before {
    vec3 *v, *w, g;
    struct wall *wall;
    double *mu;
    bool steered;
    struct acts acts;
};

static void reply_forget(struct reply_before *b)
{
    free(b->v), free(b->w), free(b->wall), free(b->mu);
    acts_free(&b->acts);
}

/* *to = a copy, where the answer has this key; false: no memory */
static bool reply_copy(void *to, const json_t *answer, const char *key, const void *from, size_t bytes)
{
    void **copy = to;
    if (!json_object_get(answer, key) || !bytes) return true;
    if ((*copy = malloc(bytes))) memcpy(*copy, from, bytes);
    return *copy;
}

static int reply_remember(struct reply_before *b, const json_t *answer, const struct acts *acts,
                    const struct packing *p, struct why *why)
{
    const size_t n = (size_t)p->n, walls = (size_t)p->walls, kinds = (size_t)p->kinds;
    *b = (struct reply_before){ .g = p->g, .steered = p->outside.steered };
    if (reply_copy(&b->v, answer, "velocities", p->v, n * sizeof *b->v) &&
        reply_copy(&b->w, answer, "angular_velocities", p->w, n * sizeof *b->w) &&
        reply_copy(&b->wall, answer, "boundaries", p->wall, walls * sizeof *b->wall) &&
        reply_copy(&b->mu, answer, "friction", p->mu, kinds * kinds * sizeof *b->mu))
        return acts_copy(&b->acts, acts, p->walls, why);
    return why_set(why, EX_SOFTWARE, "no memory for an answer");
}

static void reply_restore(struct reply_before *b, struct acts *acts, struct packing *p)
{
    struct acts none = { 0 };
    if (b->v) memcpy(p->v, b->v, (size_t)p->n * sizeof *b->v);
    if (b->w) memcpy(p->w, b->w, (size_t)p->n * sizeof *b->w);
    if (b->wall) memcpy(p->wall, b->wall, (size_t)p->walls * sizeof *b->wall);
    if (b->mu) memcpy(p->mu, b->mu, (size_t)(p->kinds * p->kinds) * sizeof *b->mu);
    p->g = b->g, p->outside.steered = b->steered;
    acts_free(acts);
    *acts = b->acts, b->acts = none;
}

/* All that the answer has but stop */
static int reply_apply_keys(const json_t *answer, struct acts *acts, struct packing *p, struct why *why)
{
    vec3 g;
    const json_t *boundaries = json_object_get(answer, "boundaries");
    const json_t *gravity = json_object_get(answer, "gravity");
    const json_t *friction = json_object_get(answer, "friction");
    bool forces = json_object_get(answer, "forces") || json_object_get(answer, "torques");
    if (forces && acts_arrays(acts, p, why)) return why->status;
    acts_clear(acts, p->walls);
    for (int k = 0; k < PARTS; k++)
        if (set_all(json_object_get(answer, known[k].key), acts, (enum reply_part)k, p, why))
            return why->status;
    if (boundaries && set_boundaries(boundaries, acts, p, why)) return why->status;
    if (gravity && !vector(gravity, p->dim, &g)) return reply_wrong(why, "gravity is a vector [x, y, z]");
    if (gravity && acts_gravity(p, g, why)) return why->status;
    return friction ? set_frictions(friction, p, why) : 0;
}

int answer_apply(const json_t *answer, struct acts *acts, struct packing *p, bool *stop,
                 struct why *why)
{
    struct reply_before b = { 0 };
    *stop = json_is_true(json_object_get(answer, "stop"));
    if (answer_check(answer, why) || *stop) return why->status;
    if (!reply_remember(&b, answer, acts, p, why) && reply_apply_keys(answer, acts, p, why)) reply_restore(&b, acts, p);
    reply_forget(&b);
    return why->status;
}
