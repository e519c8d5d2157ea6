/* scene/scene_material.c: materials, and the law of each pair of them, from their JSON. */

#include "scene/scene_read.h"
#include "scene/stiffness.h"

#include <stdlib.h>
#include <string.h>

static int32_t find_material(const struct scene *s, const char *name)
{
    for (int32_t k = 0; k < s->materials; k++)
        if (!strcmp(s->material[k].name, name)) return k;
    return -1;
}

static int scene_material_read(jnode n, const struct key *k, struct scene *s, void *member)
{
    const char *name = NULL;
    int32_t *material = member;
    (void)k;
    if (json_node_text(n, &name)) return 1;
    *material = find_material(s, name);
    return *material < 0
               ? json_node_fault(n, "no material \"%s\"; name it under \"materials\"", name)
               : 0;
}

const struct key_type key_material = { "string", "{'type': 'string'}", scene_material_read, NULL };

/* "materials" */

#define AT(member) offsetof(struct scene_material, member)

static const struct key scene_material_key[] = {
    { "density", &key_positive, AT(density), "kg/m^3", "of the scene", "7800",
      "Density of the material; in 2D in kg/m^2." },
    { "breaks", &key_object, AT(breaks), "-", "none", "see below",
      "How grains of the material break.", .object = &scene_breaks_keys },
    { 0 },
};
#undef AT
const struct keys scene_material_keys = { "material", scene_material_key };

static int add_material(jnode n, struct scene *s, const char *name, double density)
{
    const char *trouble = name_trouble_of_material(name, strlen(name));
    if (trouble) return json_node_fault(n, "the name of a material %s", trouble);
    s->material[s->materials] = (struct scene_material){ strdup(name), density, { 0 } };
    if (!s->material[s->materials].name)
        return failure_set(n.in->failure, EX_SOFTWARE, "no memory for a material");
    s->materials++;
    return 0;
}

int scene_read_materials(jnode o, struct scene *s, void *out)
{
    const char *name;
    json_t *value;
    size_t most = 1000, count = json_object_size(o.json);
    (void)out;
    if (o.json && !json_is_object(o.json)) return json_node_fault(o, "needs an object {...}");
    if (count > most) return json_node_fault(o, "more than %zu materials", most);
    if (!(s->material = scene_alloc(o, count + 2, sizeof *s->material))) return 1;
    if (add_material(o, s, "ball", s->density) || add_material(o, s, "wall", s->density)) return 1;
    json_object_foreach(o.json, name, value)
    {
        jnode n = json_node_key(&o, name);
        if (!strcmp(name, "comment")) continue;
        if (find_material(s, name) < 0 && add_material(n, s, name, s->density)) return 1;
        if (keys_read(n, &scene_material_keys, s, &s->material[find_material(s, name)])) return 1;
    }
    return 0;
}

/*
 * What a pair of materials does beyond friction and restitution: each law is an object of its own, which takes the place
 * of the one for all pairs.
 */
#define AT(member) offsetof(struct pair_law, member)

static const struct key cohesion_key[] = {
    { "force", &key_not_negative, AT(cohesion), "N", REQUIRED, "1e-3",
      "Constant attractive force between two bodies that touch or whose gap is less than the "
      "range." },
    { "range", &key_not_negative, AT(range), "m", "0", "1e-5", "Gap up to which the force acts." },
    { 0 },
};
static const struct keys cohesion_keys = { "cohesion", cohesion_key };

static const struct key capillary_key[] = {
    { "volume", &key_not_negative, AT(volume), "m^3", REQUIRED, "1e-10",
      "Volume of the liquid bridge that forms when bodies touch; it ruptures at a distance that "
      "follows from the volume, see nsd-methods(7). Discs have the bridges of balls." },
    { "tension", &key_not_negative, AT(tension), "N/m", REQUIRED, "0.072", "Surface tension." },
    { "wetting", &key_not_negative, AT(wetting), "rad", "0", "0.2",
      "Wetting angle, less than pi/2.", .most = 1.5707963267948963, /* the last double below pi/2 */
      .limit = "must be less than pi/2: a liquid that does not wet has no bridge" },
    { 0 },
};
static const struct keys capillary_keys = { "capillary", capillary_key };

static const struct key rolling_key[] = {
    { "mu_r", &key_not_negative, AT(mu_r), "m", "0", "1e-4",
      "Rolling friction: the moment against rolling is at most mu_r times the normal force." },
    { "mu_p", &key_not_negative, AT(mu_p), "m", "0", "1e-5",
      "Pivoting friction: the moment about the normal is at most mu_p times the normal force." },
    { "mu_r_ratio", &key_not_negative, AT(mu_r_ratio), "-", "0", "0.2",
      "Rolling friction over the effective radius r1 r2/(r1 + r2), r at a wall; it is added to "
      "mu_r." },
    { "mu_p_ratio", &key_not_negative, AT(mu_p_ratio), "-", "0", "0.05",
      "Pivoting friction over the effective radius; it is added to mu_p." },
    { 0 },
};
static const struct keys rolling_keys = { "rolling", rolling_key };

static int read_forever(jnode n, const struct key *k, struct scene *s, void *member)
{
    bool forever = false;
    (void)k, (void)s;
    if (json_node_bool(n, &forever)) return 1;
    *(double *)member = forever;
    return 0;
}

static const struct key_type key_forever = { "true or false", "{'type': 'boolean'}", read_forever,
                                             NULL };

static const struct key adhesion_key[] = {
    { "c_n", &key_positive, AT(cn), "N/m^3", REQUIRED, "2e9",
      "Normal stiffness of a bond per area." },
    { "c_t", &key_not_negative, AT(ct), "N/m^3", "c_n", "1e9", "Tangential stiffness per area." },
    { "w", &key_not_negative, AT(w), "J/m^2", REQUIRED, "0.2", "Energy of adhesion per area." },
    { "eta", &key_not_negative, AT(eta), "N s/m", "0", "1e-4",
      "Viscosity, which slows the damage of a bond." },
    { "area", &key_not_negative, AT(area), "m^2", "by size", "1e-6",
      "Bonded area. Default: the cross section of the smaller body, for shapes that of the "
      "circumscribed ball; discs count as 1 m deep. The points of a pair that bond in one step "
      "share it." },
    { "beta", &key_share, AT(beta), "-", "1", "1", "Intensity of a new bond." },
    { "made", &key_number, AT(made), "s", "time", "0",
      "Time at which the pairs that touch are bonded: at the beginning of the step that contains "
      "it, or in this step." },
    { "forever", &key_forever, AT(forever), "-", "false", "true",
      "Instead of made: bond all pairs whenever they touch. A pair that is bonded as soon as it "
      "touches does not rebound; e_n holds for pairs whose bond has broken." },
    { 0 },
};

static int finish_adhesion(jnode o, struct scene *s, void *out)
{
    struct pair_law *l = out;
    const bool made = keys_has(&o, "made");
    if (!keys_has(&o, "c_t")) l->ct = l->cn;
    if (!keys_has(&o, "area")) l->area = 0;
    if (!keys_has(&o, "forever")) l->forever = 0;
    if (!made) l->made = s->t;
    if (l->forever > 0 && made)
        return json_node_fault(o, "bonds are made at a time or for ever: not both");
    return 0;
}

static const struct keys adhesion_keys = { "adhesion", adhesion_key, .finish = finish_adhesion };

static const char *const impacts[] = { "newton", "bounded", NULL };

static int read_impact(jnode n, struct scene *s, void *member)
{
    int which = 0;
    (void)s;
    if (json_node_word(n, impacts, &which)) return 1;
    *(double *)member = which ? IMPACT_BOUNDED : IMPACT_NEWTON;
    return 0;
}

/* ---- the law of all pairs, or of one ---- */

#undef AT
#define AT(member) offsetof(struct scene_law, member)

/* K, "auto", or {"normal": K, "tangential": K}, {"young": E, "tangential": K}, {"compliance": ALPHA} */
static const struct key stiffness_key[] = {
    { "normal", &key_positive, AT(pair_law.kn), "N/m", "-", "1e5", "Normal force per overlap.",
      .choice = 1 },
    { "young", &key_positive, AT(young), "Pa", "-", "1e7",
      "Young's modulus E: the normal stiffness is pi/4 E d, d the smallest diameter, in the plane "
      "E: that of a bar with the cross-section and the length of the smallest grain.",
      .choice = 1 },
    { "compliance", &key_share, AT(pair_law.soft), "-", "-", "1e-2",
      "alpha, which \"auto\" sets to 1e-2: the normal stiffness of a contact is 1/(alpha W dt^2), "
      "W = 1/m_a + 1/m_b.",
      .choice = 1 },
    { "tangential", &key_positive, AT(tangential), "N/m", "2/7 of that", "3e4",
      "Tangential force per displacement; not with a compliance." },
    { 0 },
};
static int finish_stiffness(jnode o, struct scene *s, void *out)
{
    const struct scene_law *l = out;
    (void)s;
    if (!stiffness_given(l)) return json_node_fault(o, "compliance: must be at least 1e-9");
    if (l->pair_law.soft > 0 && l->tangential > 0)
        return json_node_fault(o, "a compliance is that of both directions: leave out tangential");
    return 0;
}

static const struct keys stiffness_keys = { "stiffness", stiffness_key,
                                            .finish = finish_stiffness };

static int read_stiffness(jnode n, const struct key *k, struct scene *s, void *member)
{
    struct scene_law *l = member;
    (void)k;
    l->pair_law.kn = l->pair_law.soft = l->young = l->tangential = 0;
    if (json_is_object(n.json)) return keys_read(n, &stiffness_keys, s, l);
    if (!json_is_string(n.json)) return json_node_number(n, J_POSITIVE, &l->pair_law.kn);
    l->pair_law.soft = COMPLIANCE_AUTO;
    return strcmp(json_string_value(n.json), "auto")
               ? json_node_fault(n, "needs a number of N/m, an object, or \"auto\"")
               : 0;
}

static const struct key_type key_stiffness = {
    "number or object",
    "{'anyOf': [{'type': 'number', 'exclusiveMinimum': 0}, {'const': 'auto'}, {'$ref': "
    "'stiffness'}]}",
    read_stiffness, NULL, &stiffness_keys
};

/* Unit, default, example and help of the numbers of state/pair_columns.h */
#define TEXT_mu "-", "0", "0.4", "Coulomb friction coefficient of every pair of materials."
#define TEXT_en "-", "0", "0.3", "Normal restitution coefficient of every pair."
#define TEXT_et "-", "0", "0", "Tangential restitution coefficient of every pair."
#define TEXT_mu_s                                                                                  \
    "-", "mu", "0.6", "Static friction coefficient of every pair, at least mu; it requires v_s."
#define TEXT_v_s                                                                                   \
    "m/s", "none", "1e-3",                                                                         \
        "Sliding speed up to which a contact has the friction mu_s; a faster contact has mu, see " \
        "nsd-methods(7), \"Static and kinetic friction\"."
#define ROW(member, document, unit, key, most, range)                                              \
    { key, (most) == 1 ? &key_share : &key_not_negative, AT(member), TEXT_##member },

static const struct key law_key[] = {
    EACH_PAIR_NUMBER(ROW){ "impact", &key_word, AT(pair_law.impact), "-", "by shape", "\"bounded\"",
                           "\"bounded\" reduces restitution where an impact with friction would "
                           "gain energy; \"newton\" does not, see nsd-methods(7), \"Impact\". "
                           "Default: newton for balls and discs, bounded for other shapes.",
                           .words = impacts, .read = read_impact },
    { "cohesion", &key_object, AT(pair_law), "-", "none", "{\"force\": 1e-3}",
      "Constant attraction.", .object = &cohesion_keys },
    { "capillary", &key_object, AT(pair_law), "-", "none", "see below", "Liquid bridges.",
      .object = &capillary_keys },
    { "rolling", &key_object, AT(pair_law), "-", "none", "{\"mu_r\": 1e-4}",
      "Rolling and pivoting friction.", .object = &rolling_keys },
    { "adhesion", &key_object, AT(pair_law), "-", "none", "see below", "Bonds with damage.",
      .object = &adhesion_keys },
    { "stiffness", &key_stiffness, 0, "N/m", "rigid", "1e5",
      "Stiffness of contacts along the normal (in the plane for each metre of thickness), or an "
      "object. \"auto\": that which makes the solves of any time step easy. Without it contacts "
      "are "
      "rigid, see nsd-methods(7), \"Contacts with a stiffness\"." },
    { 0 },
};
#undef ROW

static int finish_law(jnode o, struct scene *s, void *out)
{
    const struct scene_law *l = out;
    (void)s;
    if ((l->mu_s > 0) != (l->v_s > 0))
        return json_node_fault(
            o, "mu_s, static friction, and v_s, the sliding speed up to which it holds (m/s), "
               "are given together");
    if (l->mu_s > 0 && l->mu_s < l->mu)
        return json_node_fault(o, "mu_s, static friction, must not be below mu");
    return 0;
}

const struct keys scene_law_keys = { "law", law_key, .finish = finish_law };

/* ---- "pairs" ---- */

struct pair_read {
    int32_t material[2];
    bool acts;
    struct scene_law law;
};

#undef AT
#define AT(member) offsetof(struct pair_read, member)

static const struct key_type key_two_materials = { ARRAY("two materials", &key_material, 2,
                                                         sizeof(int32_t)) };

static const struct key pair_key[] = {
    { "pair", &key_two_materials, AT(material), "-", REQUIRED, "[\"steel\", \"ball\"]",
      "The two materials." },
    { "acts", &key_bool, AT(acts), "-", "true", "false",
      "false: the pair has no contacts, and no other key." },
    { "", &key_include, AT(law), .object = &scene_law_keys },
    { 0 },
};

/* A pair that does not act has no law. */
static int finish_pair(jnode o, struct scene *s, void *out)
{
    struct pair_read *p = out;
    (void)s;
    if (p->acts) return 0;
    if (json_object_size(o.json) > 2 + (size_t)keys_has(&o, "comment"))
        return json_node_fault(o, "a pair with \"acts\": false has no contacts, and no other key");
    p->law = (struct scene_law){ .inert = 1 };
    return 0;
}

const struct keys scene_pair_keys = { "pair", pair_key, .keeps = true, .finish = finish_pair };

static int read_pair(jnode o, struct scene *s, void *out)
{
    bool *given = out;
    struct pair_read p = { .acts = true, .law = s->common };
    if (keys_read(o, &scene_pair_keys, s, &p)) return 1;
    const int32_t ab = p.material[0] * s->materials + p.material[1],
                  ba = p.material[1] * s->materials + p.material[0];
    if (given[ab]) return json_node_fault(json_node_key(&o, "pair"), "this pair was given before");
    given[ab] = given[ba] = true;
    s->law[ab] = s->law[ba] = p.law;
    return 0;
}

int scene_read_pairs(jnode a, struct scene *s, void *out)
{
    const size_t k2 = (size_t)s->materials * (size_t)s->materials;
    bool *given = scene_alloc(a, k2, sizeof *given);
    (void)out;
    if (!given || !(s->law = scene_alloc(a, k2, sizeof *s->law))) return free(given), 1;
    for (size_t i = 0; i < k2; i++) s->law[i] = s->common;
    int bad = keys_each(a, s, given, read_pair);
    free(given);
    return bad;
}

/* Names of walls, of parts of their surfaces and of groups of bodies, from their JSON. */

static int read_name(jnode n, const struct key *k, struct scene *s, void *member)
{
    const char **out = member;
    (void)k;
    if (json_node_text(n, out)) return 1;
    const char *trouble = name_trouble(*out, strlen(*out));
    if (trouble) return json_node_fault(n, "a name %s", trouble);
    for (int32_t i = 0; i < s->materials; i++)
        if (!strcmp(s->material[i].name, *out))
            return json_node_fault(n, "\"%s\" is a material: walls and groups have other names",
                                   *out);
    return 0;
}

const struct key_type key_name = { "string", "{'type': 'string'}", read_name, NULL };

/* That of a group, added to the scene's */
static int scene_material_read_group(jnode n, const struct key *k, struct scene *s, void *member)
{
    const char *name = NULL;
    int32_t which = -1;
    if (read_name(n, k, s, &name) || names_add(&s->names, name, &which, n.in->failure)) return 1;
    *(int32_t *)member = which + 1;
    return 0;
}

const struct key_type key_group = { "string", "{'type': 'string'}", scene_material_read_group,
                                    NULL };

static int read_face(jnode n, const struct key *k, struct scene *s, void *member)
{
    (void)k, (void)s;
    return json_node_integer(n, 0, INT32_MAX - 1, member);
}

static const struct key_type key_face = {
    "integer", "{'type': 'integer', 'minimum': 0, 'maximum': 2147483646}", read_face
};
const struct key_type key_faces = { ARRAY("[first, last]", &key_face, 2, sizeof(int64_t)) };

int scene_check_faces(jnode o, const int64_t face[2])
{
    return face[0] <= face[1]
               ? 0
               : json_node_fault(json_node_key(&o, "faces"), "its first face is behind its last");
}

/* ---- "parts" of a surface ---- */

struct part {
    const char *name;
    int64_t face[2];
};

#undef AT
#define AT(member) offsetof(struct part, member)

static const struct key part_key[] = {
    { "name", &key_name, AT(name), "-", REQUIRED, "\"blade\"",
      "Name of the part; several ranges may have the same name." },
    { "faces", &key_faces, AT(face), "-", REQUIRED, "[0, 11]",
      "Range of triangles or segments, counted from 0 in the order of the file, without those of "
      "zero area." },
    { 0 },
};
const struct keys scene_part_keys = { "part", part_key };

static int read_part(jnode o, struct scene *s, void *out)
{
    struct part p = { 0 };
    (void)out;
    return keys_read(o, &scene_part_keys, s, &p) || scene_check_faces(o, p.face) ||
           names_give(&s->names, p.name, s->walls, (int32_t)p.face[0],
                      (int32_t)(p.face[1] - p.face[0] + 1), o.in->failure);
}

int scene_read_parts(jnode a, struct scene *s, void *out)
{
    return keys_each(a, s, out, read_part);
}

int scene_read_mesh_parts(jnode a, struct scene *s, void *groups)
{
    if (json_is_string(a.json) && !strcmp(json_string_value(a.json), "groups")) {
        *(bool *)groups = true;
        return 0;
    }
    if (!json_is_array(a.json))
        return json_node_fault(a, "needs \"groups\" or a list [{name, faces}, ...]");
    return keys_each(a, s, NULL, read_part);
}

const struct key_type key_mesh_parts = { "array or \"groups\"",
                                         "{'anyOf': [{'const': 'groups'}, {'type': 'array', "
                                         "'items': {'$ref': 'part'}}]}",
                                         NULL, NULL, &scene_part_keys };
