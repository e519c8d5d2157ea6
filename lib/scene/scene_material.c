/* scene/scene_material.c: materials: kinds, and the law of each pair of them, from their JSON. */

#include "contact/spring.h"
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
    if (!s->kind[s->kinds].name)
        return failure_set(n.in->failure, EX_SOFTWARE, "no memory for a kind");
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
                              PAIR_KEY) " impact stiffness cohesion capillary rolling adhesion") ||
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

/* What a pair of kinds does beyond friction and restitution, from its JSON: each
   law is an object of its own, which takes the place of the one for all pairs. */

static int read_cohesion(jnode o, struct pair_law *l)
{
    if (!o.json) return 0;
    l->cohesion = l->range = 0;
    return json_node_only(o, "force range") || json_node_need(&o, "force") ||
           json_node_number(json_node_key(&o, "force"), J_NOT_NEGATIVE, &l->cohesion) ||
           json_node_number(json_node_key(&o, "range"), J_NOT_NEGATIVE, &l->range);
}

static int read_capillary(jnode o, struct pair_law *l)
{
    if (!o.json) return 0;
    l->volume = l->tension = l->wetting = 0;
    jnode angle = json_node_key(&o, "wetting");
    if (json_node_only(o, "volume tension wetting") || json_node_need(&o, "volume tension") ||
        json_node_number(json_node_key(&o, "volume"), J_NOT_NEGATIVE, &l->volume) ||
        json_node_number(json_node_key(&o, "tension"), J_NOT_NEGATIVE, &l->tension) ||
        json_node_number(angle, J_NOT_NEGATIVE, &l->wetting))
        return 1;
    if (l->wetting < M_PI / 2) return 0;
    return json_node_fault(angle,
                           "must be less than pi/2: a liquid that does not wet has no bridge");
}

static int read_rolling(jnode o, struct pair_law *l)
{
    if (!o.json) return 0;
    l->mu_r = l->mu_p = 0;
    return json_node_only(o, "mu_r mu_p") ||
           json_node_number(json_node_key(&o, "mu_r"), J_NOT_NEGATIVE, &l->mu_r) ||
           json_node_number(json_node_key(&o, "mu_p"), J_NOT_NEGATIVE, &l->mu_p);
}

/* t: of the scene, s */
static int read_adhesion(jnode o, double t, struct pair_law *l)
{
    bool forever = false;
    if (!o.json) return 0;
    l->eta = l->area = 0, l->beta = 1, l->made = t;
    if (json_node_only(o, "c_n c_t w eta area beta made forever") || json_node_need(&o, "c_n w") ||
        json_node_number(json_node_key(&o, "c_n"), J_POSITIVE, &l->cn))
        return 1;
    l->ct = l->cn;
    if (json_node_number(json_node_key(&o, "c_t"), J_NOT_NEGATIVE, &l->ct) ||
        json_node_number(json_node_key(&o, "w"), J_NOT_NEGATIVE, &l->w) ||
        json_node_number(json_node_key(&o, "eta"), J_NOT_NEGATIVE, &l->eta) ||
        json_node_number(json_node_key(&o, "area"), J_NOT_NEGATIVE, &l->area) ||
        json_node_number(json_node_key(&o, "beta"), J_UNIT, &l->beta) ||
        json_node_number(json_node_key(&o, "made"), J_ANY, &l->made) ||
        json_node_bool(json_node_key(&o, "forever"), &forever))
        return 1;
    l->forever = forever;
    if (forever && json_node_key(&o, "made").json)
        return json_node_fault(o, "bonds are made at a time or for ever: not both");
    return 0;
}

static int read_impact(jnode o, struct pair_law *l)
{
    const char *name = NULL;
    if (!o.json) return 0;
    if (json_node_text(o, &name)) return 1;
    l->impact = !strcmp(name, "newton") ? IMPACT_NEWTON : IMPACT_BOUNDED;
    if (l->impact == IMPACT_NEWTON || !strcmp(name, "bounded")) return 0;
    return json_node_fault(o, "needs \"newton\" or \"bounded\"");
}

/* K, or {"normal": K, "tangential": K} */
static int read_stiffness(jnode o, struct pair_law *l)
{
    if (!o.json) return 0;
    if (!json_is_object(o.json)) {
        if (json_node_number(o, J_POSITIVE, &l->kn)) return 1;
        l->kt = SPRING_ACROSS * l->kn;
        return 0;
    }
    if (json_node_only(o, "normal tangential") || json_node_need(&o, "normal") ||
        json_node_number(json_node_key(&o, "normal"), J_POSITIVE, &l->kn))
        return 1;
    l->kt = SPRING_ACROSS * l->kn;
    return json_node_number(json_node_key(&o, "tangential"), J_POSITIVE, &l->kt);
}

int scene_read_laws(const jnode *o, double t, struct pair_law *l)
{
    return read_cohesion(json_node_key(o, "cohesion"), l) ||
           read_capillary(json_node_key(o, "capillary"), l) ||
           read_rolling(json_node_key(o, "rolling"), l) ||
           read_adhesion(json_node_key(o, "adhesion"), t, l) ||
           read_impact(json_node_key(o, "impact"), l) ||
           read_stiffness(json_node_key(o, "stiffness"), l);
}

/* Names of walls, of parts of their surfaces and of groups of bodies, from their JSON. */

int scene_read_name(jnode n, const struct scene *s, const char **out)
{
    *out = NULL;
    if (!n.json) return 0;
    if (json_node_text(n, out)) return 1;
    const char *trouble = name_trouble(*out, strlen(*out));
    if (trouble) return json_node_fault(n, "a name %s", trouble);
    for (int32_t k = 0; k < s->kinds; k++)
        if (!strcmp(s->kind[k].name, *out))
            return json_node_fault(n, "\"%s\" is a kind: walls and groups have other names", *out);
    return 0;
}

int scene_read_group(jnode n, struct scene *s, int32_t *group)
{
    const char *name;
    int32_t which = -1;
    if (scene_read_name(n, s, &name)) return 1;
    if (name && names_add(&s->names, name, &which, n.in->failure)) return 1;
    *group = which + 1;
    return 0;
}

static int scene_material_read_part(jnode o, struct scene *s)
{
    const char *name;
    int64_t first = 0, last = 0;
    size_t n;
    jnode faces = json_node_key(&o, "faces"), text = json_node_key(&o, "name");
    if (json_node_only(o, "name faces") || json_node_need(&o, "name faces") ||
        scene_read_name(text, s, &name) || json_node_array(faces, &n))
        return 1;
    if (n != 2) return json_node_fault(faces, "needs [first, last]");
    if (json_node_integer(json_node_item(&faces, 0), 0, INT32_MAX - 1, &first) ||
        json_node_integer(json_node_item(&faces, 1), 0, INT32_MAX - 1, &last))
        return 1;
    if (first > last) return json_node_fault(faces, "its first face is behind its last");
    struct failure *failure = o.in->failure;
    return names_give(&s->names, name, s->walls, (int32_t)first, (int32_t)(last - first + 1),
                      failure);
}

int scene_read_parts(jnode a, struct scene *s, bool *groups)
{
    size_t n;
    if (groups && json_is_string(a.json) && !strcmp(json_string_value(a.json), "groups")) {
        *groups = true;
        return 0;
    }
    if (groups && a.json && !json_is_array(a.json))
        return json_node_fault(a, "needs \"groups\" or a list [{name, faces}, ...]");
    if (json_node_array(a, &n)) return 1;
    for (size_t i = 0; i < n; i++)
        if (scene_material_read_part(json_node_item(&a, i), s)) return 1;
    return 0;
}
