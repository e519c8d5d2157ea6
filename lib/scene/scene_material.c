/* scene/scene_material.c: materials: kinds, and the law of each pair of them, from their JSON. */
#include "scene/scene_read.h"

#include <stdlib.h>
#include <string.h>

int scene_read_law(const jnode *o, struct scene_law *l)
{
#define READ(member, name, unit, key, most, range)                                                 \
    if (json_node_number(json_node_key(o, key), (most) == 1 ? J_UNIT : J_NOT_NEGATIVE,             \
                         &l->member))                                                              \
        return 1;
    EACH_PAIR_NUMBER(READ)
#undef READ
    if ((l->mu_s > 0) != (l->v_s > 0))
        return json_node_fault(
            *o, "mu_s, static friction, and v_s, the sliding speed up to which it holds (m/s), "
                "are given together");
    if (l->mu_s > 0 && l->mu_s < l->mu)
        return json_node_fault(*o, "mu_s, static friction, must not be below mu");
    return 0;
}

static int32_t find_kind(const struct scene *s, const char *name)
{
    for (int32_t k = 0; k < s->kinds; k++)
        if (!strcmp(s->kind[k].name, name)) return k;
    return -1;
}

int scene_read_kind(jnode n, const struct scene *s, int32_t *kind)
{
    const char *name = NULL;
    if (json_node_text(n, &name)) return 1;
    if (!name) return 0;
    *kind = find_kind(s, name);
    return *kind < 0 ? json_node_fault(n, "no kind \"%s\"; name it under \"kinds\"", name) : 0;
}

static int add_kind(jnode n, struct scene *s, const char *name, double density)
{
    const char *trouble = name_trouble_of_kind(name, strlen(name));
    if (trouble) return json_node_fault(n, "the name of a kind %s", trouble);
    s->kind[s->kinds] = (struct scene_kind){ strdup(name), density };
    if (!s->kind[s->kinds].name) return failure_set(n.in->failure, EX_SOFTWARE, "no memory for a kind");
    s->kinds++;
    return 0;
}

int scene_read_kinds(jnode o, struct scene *s, double density)
{
    const char *name;
    json_t *value;
    size_t most = 1000, count = json_object_size(o.json);
    if (o.json && !json_is_object(o.json)) return json_node_fault(o, "needs an object {...}");
    if (count > most) return json_node_fault(o, "more than %zu kinds", most);
    if (!(s->kind = scene_alloc(o, count + 2, sizeof *s->kind))) return 1;
    if (add_kind(o, s, "ball", density) || add_kind(o, s, "wall", density)) return 1;
    json_object_foreach(o.json, name, value)
    {
        jnode n = json_node_key(&o, name);
        if (!strcmp(name, "comment")) continue;
        if (json_node_only(n, "density")) return 1;
        if (find_kind(s, name) < 0 && add_kind(o, s, name, density)) return 1;
        double *d = &s->kind[find_kind(s, name)].density;
        if (json_node_number(json_node_key(&n, "density"), J_POSITIVE, d)) return 1;
    }
    return 0;
}

/* A pair that does not act has no law. */
static int read_acts(jnode o, struct scene_law *l)
{
    bool acts = true;
    jnode key = json_node_key(&o, "acts");
    if (json_node_bool(key, &acts)) return 1;
    if (acts) return 0;
    if (json_object_size(o.json) > 2 + (json_node_key(&o, "comment").json != NULL))
        return json_node_fault(o, "a pair with \"acts\": false has no contacts, and no other key");
    *l = (struct scene_law){ .inert = 1 };
    return 0;
}

static int read_pair(jnode o, struct scene *s, bool *given)
{
    size_t n;
    int32_t k[2] = { 0 };
    if (json_node_only(o, "pair acts" EACH_PAIR_NUMBER(
                              PAIR_KEY) " impact cohesion capillary rolling adhesion") ||
        json_node_need(&o, "pair"))
        return 1;
    jnode pair = json_node_key(&o, "pair");
    if (json_node_array(pair, &n)) return 1;
    if (n != 2) return json_node_fault(pair, "needs two kinds");
    for (size_t i = 0; i < 2; i++) {
        jnode name = json_node_item(&pair, i);
        if (scene_read_kind(name, s, &k[i])) return 1;
    }
    int32_t ab = k[0] * s->kinds + k[1], ba = k[1] * s->kinds + k[0];
    if (given[ab]) return json_node_fault(pair, "this pair was given before");
    given[ab] = given[ba] = true;
    if (scene_read_law(&o, &s->law[ab]) || scene_read_laws(&o, s->t, &s->law[ab].pair_law) ||
        read_acts(o, &s->law[ab]))
        return 1;
    s->law[ba] = s->law[ab];
    return 0;
}

int scene_read_pairs(jnode a, struct scene *s, struct scene_law law)
{
    size_t n, k2 = (size_t)s->kinds * (size_t)s->kinds;
    if (json_node_array(a, &n) || !(s->law = scene_alloc(a, k2, sizeof *s->law))) return 1;
    for (size_t i = 0; i < k2; i++) s->law[i] = law;
    bool *given = scene_alloc(a, k2, sizeof *given);
    int bad = !given;
    for (size_t i = 0; i < n && !bad; i++) bad = read_pair(json_node_item(&a, i), s, given);
    free(given);
    return bad;
}
