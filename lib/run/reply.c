#include "run/reply.h"

#include "base/nearest.h"
#include "base/renamed.h"

#include <stdlib.h>
#include <string.h>

static int reply_no_document(struct failure *failure)
{
    return failure_set(failure, EX_DATAERR,
                       "the answer is a document, which is no longer taken: answer a line of JSON "
                       "with what changes, as {\"velocities\": {\"ID\": [x, y, z]}}");
}

json_t *reply_parse(const char *line, size_t length, struct failure *failure)
{
    json_error_t e;
    static const unsigned char document_begins = 0x89; // no JSON does
    if (length && (unsigned char)line[0] == document_begins)
        return reply_no_document(failure), NULL;
    while (length && strchr(" \t\r\n", line[length - 1])) length--;
    if (!length) {
        failure_set(failure, EX_DATAERR, "the answer is an empty line: {} changes nothing");
        return NULL;
    }
    json_t *j = length == 4 && !memcmp(line, "stop", 4)
                    ? json_pack("{s:b}", "stop", 1)
                    : json_loadb(line, length, JSON_REJECT_DUPLICATES, &e);
    if (!j)
        failure_set(failure, EX_DATAERR, "the answer is not JSON: %.100s (column %d)",
                    length == 4 ? "no memory" : e.text, length == 4 ? 0 : e.column);
    else if (!json_is_object(j))
        failure_set(failure, EX_DATAERR, "the answer is neither a JSON object nor the word stop");
    if (!failure->status) return j;
    json_decref(j);
    return NULL;
}

static int reply_wrong(struct failure *failure, const char *what)
{
    return failure_set(failure, EX_DATAERR, "the answer's %s", what);
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
    { "walls", .object = true },
    { "gravity", .array = true },
    { "friction", .array = true },
    { "stop", .boolean = true },
};
enum { KEYS = sizeof known / sizeof *known };

/* What an answer has of each body: the first of them */
enum reply_part { FORCES, TORQUES, VELOCITIES, SPINS, PARTS };

static int reply_set(struct control *acts, enum reply_part part, struct packing *p, int64_t i,
                     const json_t *j, struct failure *failure)
{
    vec3 x;
    if (!vector(j, p->dim, &x))
        return failure_set(failure, EX_DATAERR, "the answer's %s are vectors [x, y, z]",
                           known[part].key);
    if (part == VELOCITIES || part == SPINS) return control_motion(p, i, part == SPINS, x, failure);
    bool torque = part == TORQUES;
    (torque ? acts->twists : acts->pushes)[CONTROL_LASTING] = true;
    (torque ? acts->torque : acts->force)[CONTROL_LASTING][i] = x;
    return 0;
}

/* Of all bodies in their order, or of those with these ids */
static int set_all(const json_t *j, struct control *acts, enum reply_part part, struct packing *p,
                   struct failure *failure)
{
    const char *id;
    json_t *x;
    if (!j) return 0;
    if (json_is_array(j) && json_array_size(j) != (size_t)p->n)
        return failure_set(failure, EX_DATAERR, "the answer has %zu %s, and there are %lld bodies",
                           json_array_size(j), known[part].key, (long long)p->n);
    for (size_t i = 0; json_is_array(j) && i < json_array_size(j); i++)
        if (reply_set(acts, part, p, (int64_t)i, json_array_get(j, i), failure))
            return failure->status;
    json_object_foreach((json_t *)j, id, x)
    {
        int64_t number = reply_whole(id), i = number < 0 ? -1 : control_row(p, (int32_t)number);
        if (i < 0)
            return failure_set(failure, EX_DATAERR,
                               "the answer has %s of body '%.40s', which does not exist",
                               known[part].key, id);
        if (reply_set(acts, part, p, i, x, failure)) return failure->status;
    }
    return 0;
}

static int set_wall(const json_t *j, struct control *acts, struct packing *p, int64_t wall,
                    struct failure *failure)
{
    const char *key;
    json_t *x;
    vec3 v;
    if (!json_is_object(j)) return reply_wrong(failure, "walls have velocity and force");
    json_object_foreach((json_t *)j, key, x)
    {
        if (!strcmp(key, "velocity")) {
            if (!vector(x, p->dim, &v))
                return reply_wrong(failure, "velocity is a vector [x, y, z]");
            control_velocity(p, wall, v, failure);
        } else if (!strcmp(key, "force")) {
            if (!json_is_number(x)) return reply_wrong(failure, "force of a wall is a number");
            control_push(acts, p, wall, json_number_value(x), CONTROL_LASTING, failure);
        } else {
            failure_set(failure, EX_DATAERR, "the answer's walls have no '%.40s'", key);
        }
        if (failure->status) return failure->status;
    }
    return 0;
}

static int set_walls(const json_t *j, struct control *acts, struct packing *p,
                     struct failure *failure)
{
    const char *key;
    json_t *x;
    json_object_foreach((json_t *)j, key, x)
    {
        const int32_t name = names_find(&p->names, key, strlen(key));
        int64_t wall = reply_whole(key); // a name is no number
        for (int32_t k = 0; name >= 0 && k < p->names.rows && !failure->status; k++) {
            const struct named *r = &p->names.row[k];
            if (r->name == name && !r->count) set_wall(x, acts, p, wall = r->wall, failure);
        }
        if (failure->status || (name >= 0 && wall >= 0)) continue;
        if (wall < 0)
            failure_set(failure, EX_DATAERR, "the answer's walls: no wall is named '%.60s'", key);
        else
            set_wall(x, acts, p, wall, failure);
    }
    return failure->status;
}

static int set_frictions(const json_t *j, struct packing *p, struct failure *failure)
{
    for (size_t k = 0; k < json_array_size(j); k++) {
        const json_t *x = json_array_get(j, k);
        const json_t *a = json_array_get(x, 0), *b = json_array_get(x, 1),
                     *mu = json_array_get(x, 2);
        if (json_array_size(x) != 3 || !json_is_string(a) || !json_is_string(b) ||
            !json_is_number(mu))
            return reply_wrong(failure, "friction is [[MATERIAL, MATERIAL, mu], ...]");
        if (control_friction(p, json_string_value(a), json_string_value(b), json_number_value(mu),
                             failure))
            return failure->status;
    }
    return 0;
}

static int reply_unknown(const char *key, struct failure *failure)
{
    struct nearest near = { 0 };
    for (int k = 0; k < KEYS; k++) nearest_look(&near, key, strlen(key), known[k].key);
    return failure_set(failure, EX_DATAERR,
                       "the answer has no '%.40s'%s%s%s: it has forces, torques, velocities, "
                       "angular_velocities, walls, gravity, friction, stop",
                       key, near.name ? "; did you mean '" : "", near.name ? near.name : "",
                       near.name ? "'?" : "");
}

/* The walls of an answer, which programs of version 1 call boundaries; NULL: it has none */
static const json_t *reply_walls(const json_t *answer)
{
    const struct renamed *r;
    const json_t *walls = json_object_get(answer, "walls");
    for (int k = 0; !walls && (r = renamed_at(k)); k++)
        if (!strcmp(r->in, "answer")) walls = json_object_get(answer, r->was);
    return walls;
}

int reply_check(const json_t *answer, struct failure *failure)
{
    const char *key;
    json_t *x;
    json_object_foreach((json_t *)answer, key, x)
    {
        const struct renamed *r = renamed_find("answer", key, strlen(key));
        int k = 0;
        if (r && json_object_get(answer, r->is))
            return failure_set(failure, EX_DATAERR,
                               "the answer has %s twice: %s is its former name", r->is, r->was);
        while (k < KEYS && strcmp(r ? r->is : key, known[k].key) != 0) k++;
        if (!strcmp(key, "document")) return reply_no_document(failure);
        if (k == KEYS) return reply_unknown(key, failure);
        if ((known[k].array && json_is_array(x)) || (known[k].object && json_is_object(x)) ||
            (known[k].boolean && json_is_boolean(x)))
            continue;
        if (known[k].boolean) return reply_wrong(failure, "stop is true or false");
        return failure_set(failure, EX_DATAERR, "the answer's %s is %s", key,
                           k < PARTS         ? "an array, or an object by ids"
                           : known[k].object ? "an object by their numbers"
                           : k == KEYS - 2   ? "[[MATERIAL, MATERIAL, mu], ...]"
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
    struct control acts;
};

static void reply_forget(struct reply_before *b)
{
    free(b->v), free(b->w), free(b->wall), free(b->mu);
    control_free(&b->acts);
}

/* *to = a copy, where the answer has what would change it; false: no memory */
static bool reply_copy(void *to, const json_t *has, const void *from, size_t bytes)
{
    void **copy = to;
    if (!has || !bytes) return true;
    if ((*copy = malloc(bytes))) memcpy(*copy, from, bytes);
    return *copy;
}

static int reply_remember(struct reply_before *b, const json_t *answer, const struct control *acts,
                          const struct packing *p, struct failure *failure)
{
    const size_t n = (size_t)p->n, walls = (size_t)p->walls, materials = (size_t)p->materials;
    *b = (struct reply_before){ .g = p->g, .steered = p->outside.steered };
    if (reply_copy(&b->v, json_object_get(answer, "velocities"), p->v, n * sizeof *b->v) &&
        reply_copy(&b->w, json_object_get(answer, "angular_velocities"), p->w, n * sizeof *b->w) &&
        reply_copy(&b->wall, reply_walls(answer), p->wall, walls * sizeof *b->wall) &&
        reply_copy(&b->mu, json_object_get(answer, "friction"), p->mu,
                   materials * materials * sizeof *b->mu))
        return control_copy(&b->acts, acts, p->walls, failure);
    return failure_set(failure, EX_SOFTWARE, "no memory for an answer");
}

static void reply_restore(struct reply_before *b, struct control *acts, struct packing *p)
{
    struct control none = { 0 };
    if (b->v) memcpy(p->v, b->v, (size_t)p->n * sizeof *b->v);
    if (b->w) memcpy(p->w, b->w, (size_t)p->n * sizeof *b->w);
    if (b->wall) memcpy(p->wall, b->wall, (size_t)p->walls * sizeof *b->wall);
    if (b->mu) memcpy(p->mu, b->mu, (size_t)(p->materials * p->materials) * sizeof *b->mu);
    p->g = b->g, p->outside.steered = b->steered;
    control_free(acts);
    *acts = b->acts, b->acts = none;
}

/* All that the answer has but stop */
static int reply_apply_keys(const json_t *answer, struct control *acts, struct packing *p,
                            struct failure *failure)
{
    vec3 g;
    const json_t *walls = reply_walls(answer);
    const json_t *gravity = json_object_get(answer, "gravity");
    const json_t *friction = json_object_get(answer, "friction");
    bool forces = json_object_get(answer, "forces") || json_object_get(answer, "torques");
    if (forces && control_arrays(acts, p, failure)) return failure->status;
    control_clear(acts, p->walls);
    for (int k = 0; k < PARTS; k++)
        if (set_all(json_object_get(answer, known[k].key), acts, (enum reply_part)k, p, failure))
            return failure->status;
    if (walls && set_walls(walls, acts, p, failure)) return failure->status;
    if (gravity && !vector(gravity, p->dim, &g))
        return reply_wrong(failure, "gravity is a vector [x, y, z]");
    if (gravity && control_gravity(p, g, failure)) return failure->status;
    return friction ? set_frictions(friction, p, failure) : 0;
}

int reply_apply(const json_t *answer, struct control *acts, struct packing *p, bool *stop,
                struct failure *failure)
{
    struct reply_before b = { 0 };
    *stop = json_is_true(json_object_get(answer, "stop"));
    if (reply_check(answer, failure) || *stop) return failure->status;
    if (!reply_remember(&b, answer, acts, p, failure) && reply_apply_keys(answer, acts, p, failure))
        reply_restore(&b, acts, p);
    reply_forget(&b);
    return failure->status;
}
