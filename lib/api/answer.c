#include "api/answer.h"

#include <stdlib.h>
#include <string.h>

json_t *answer_parse(const char *line, size_t length, struct why *why)
{
    json_error_t e;
    while (length && strchr(" \t\r\n", line[length - 1])) length--;
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

static int wrong(struct why *why, const char *what)
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
static int64_t whole(const char *text)
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

/* What an answer has of each body */
enum part { FORCES, TORQUES, VELOCITIES, SPINS, PARTS };
static const char *const part_name[PARTS] = { "forces", "torques", "velocities",
                                              "angular_velocities" };

static int set(struct acts *acts, enum part part, struct packing *p, int64_t i, const json_t *j,
               struct why *why)
{
    vec3 x;
    if (!vector(j, p->dim, &x))
        return why_set(why, EX_DATAERR, "the answer's %s are vectors [x, y, z]", part_name[part]);
    if (part == VELOCITIES || part == SPINS) return acts_motion(p, i, part == SPINS, x, why);
    bool torque = part == TORQUES;
    (torque ? acts->twists : acts->pushes)[ACTS_LASTING] = true;
    (torque ? acts->torque : acts->force)[ACTS_LASTING][i] = x;
    return 0;
}

/* Of all bodies in their order, or of those with these ids */
static int set_all(const json_t *j, struct acts *acts, enum part part, struct packing *p,
                   struct why *why)
{
    const char *id;
    json_t *x;
    if (!j) return 0;
    if (json_is_array(j) && json_array_size(j) != (size_t)p->n)
        return why_set(why, EX_DATAERR, "the answer has %zu %s, and there are %lld bodies",
                       json_array_size(j), part_name[part], (long long)p->n);
    if (!json_is_array(j) && !json_is_object(j))
        return why_set(why, EX_DATAERR, "the answer's %s are an array, or an object by ids",
                       part_name[part]);
    for (size_t i = 0; json_is_array(j) && i < json_array_size(j); i++)
        if (set(acts, part, p, (int64_t)i, json_array_get(j, i), why)) return why->status;
    json_object_foreach((json_t *)j, id, x)
    {
        int64_t number = whole(id), i = number < 0 ? -1 : acts_row(p, (int32_t)number);
        if (i < 0)
            return why_set(why, EX_DATAERR,
                           "the answer has %s of body '%.40s', which does not exist",
                           part_name[part], id);
        if (set(acts, part, p, i, x, why)) return why->status;
    }
    return 0;
}

static bool is_part(const char *key)
{
    for (int k = 0; k < PARTS; k++)
        if (!strcmp(key, part_name[k])) return true;
    return false;
}

static int set_boundary(const json_t *j, struct acts *acts, struct packing *p, int64_t wall,
                        struct why *why)
{
    const char *key;
    json_t *x;
    vec3 v;
    if (!json_is_object(j)) return wrong(why, "boundaries have velocity and force");
    json_object_foreach((json_t *)j, key, x)
    {
        if (!strcmp(key, "velocity")) {
            if (!vector(x, p->dim, &v)) return wrong(why, "velocity is a vector [x, y, z]");
            acts_velocity(p, wall, v, why);
        } else if (!strcmp(key, "force")) {
            if (!json_is_number(x)) return wrong(why, "force of a boundary is a number");
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
    if (!json_is_object(j)) return wrong(why, "boundaries are an object by their numbers or names");
    json_object_foreach((json_t *)j, key, x)
    {
        const int32_t name = names_find(&p->names, key, strlen(key));
        int64_t wall = whole(key); // a name is no number
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
            return wrong(why, "friction is [[KIND, KIND, mu], ...]");
        if (acts_friction(p, json_string_value(a), json_string_value(b), json_number_value(mu),
                          why))
            return why->status;
    }
    return json_is_array(j) ? 0 : wrong(why, "friction is [[KIND, KIND, mu], ...]");
}

int answer_apply(const json_t *answer, struct acts *acts, struct packing *p, bool *stop,
                 struct why *why)
{
    const char *key;
    json_t *x;
    vec3 g;
    *stop = false;
    bool forces = json_object_get(answer, "forces") || json_object_get(answer, "torques");
    if (forces && acts_arrays(acts, p, why)) return why->status;
    acts_clear(acts, p->walls);
    for (int k = 0; k < PARTS; k++)
        if (set_all(json_object_get(answer, part_name[k]), acts, (enum part)k, p, why))
            return why->status;
    json_object_foreach((json_t *)answer, key, x)
    {
        if (!strcmp(key, "boundaries")) {
            set_boundaries(x, acts, p, why);
        } else if (!strcmp(key, "gravity")) {
            if (!vector(x, p->dim, &g)) return wrong(why, "gravity is a vector [x, y, z]");
            acts_gravity(p, g, why);
        } else if (!strcmp(key, "friction")) {
            set_frictions(x, p, why);
        } else if (!strcmp(key, "stop")) {
            if (!json_is_boolean(x)) return wrong(why, "stop is true or false");
            *stop = json_is_true(x);
        } else if (!is_part(key)) {
            why_set(why, EX_DATAERR,
                    "the answer has no '%.40s': it has forces, torques, velocities, "
                    "angular_velocities, boundaries, gravity, friction, stop",
                    key);
        }
        if (why->status) return why->status;
    }
    return 0;
}
