/* scene/scene_flow.c: "pour" and "remove" from their JSON. */
#include "scene/scene_read.h"

#include <stdlib.h>
#include <string.h>

/* What a pour or a removal has done before the scene begins, as nsd-info --scene prints it */

static const struct key count_key[] = {
    { "bodies", &key_integer, offsetof(struct flow_count, bodies), "-", REQUIRED, "25",
      "Their number.", .most = 0x1p53 },
    { "mass", &key_not_negative, offsetof(struct flow_count, mass), "kg", REQUIRED, "0.4",
      "Their mass." },
    { 0 },
};
static const struct keys count_keys = { "count", count_key };

/* ---- pours ---- */

#define AT(member) offsetof(struct scene_pour, member)

static const struct key opening_disc_key[] = {
    { "center", &key_vector, AT(center), "m", REQUIRED, "[0, 0, 1]", "Centre." },
    { "normal", &key_direction, AT(normal), "-", REQUIRED, "[0, 0, 1]", "Direction of its axis." },
    { "radius", &key_positive, AT(radius), "m", REQUIRED, "0.1", "Radius." },
    { 0 },
};

static int finish_disc(jnode o, struct scene *s, void *out)
{
    (void)o, (void)s;
    ((struct scene_pour *)out)->disc = true;
    return 0;
}

static const struct keys opening_disc_keys = { "opening_disc", opening_disc_key,
                                               .finish = finish_disc };

static const struct key opening_key[] = {
    { "box", &key_box, AT(box), "m", "-", "{\"x\": [0, 1], ...}", "A closed box.", .choice = 1 },
    { "disc", &key_object, 0, "-", "-", "{\"center\": ...}", "A disc; in 2D a segment.",
      .choice = 1, .object = &opening_disc_keys },
    { 0 },
};

static int finish_opening(jnode o, struct scene *s, void *out)
{
    const struct scene_pour *p = out;
    for (int i = 0; i < s->dim && !p->disc; i++)
        if (!isfinite(p->box.hi[i] - p->box.lo[i]))
            return json_node_fault(json_node_key(&o, "box"),
                                   "an opening needs a closed box, %s is open", axis_name[i]);
    return 0;
}

static const struct keys opening_keys = { "opening", opening_key, .finish = finish_opening };

static int read_count(jnode n, struct scene *s, void *member)
{
    int64_t count = 0;
    (void)s;
    if (json_node_integer(n, 0, INT32_MAX, &count)) return 1;
    *(double *)member = (double)count;
    return 0;
}

static const struct key pour_key[] = {
    { "rate", &key_positive, AT(rate), "1/s", "-", "500", "Number of bodies per second.",
      .choice = 1 },
    { "mass_rate", &key_positive, AT(rate), "kg/s", "-", "0.1", "Mass per second, instead of rate.",
      .choice = 1 },
    { "opening", &key_object, 0, "m", REQUIRED, "{\"box\": BOX}", "Region in which centres appear.",
      .object = &opening_keys },
    { RADIUS_OF(struct scene_pour) },
    { SIZE_OF(struct scene_pour) },
    { SHAPE_OF(struct scene_pour) },
    { ORIENTATION_OF(struct scene_pour) },
    { "v", &key_vector, AT(v), "m/s", "0", "[0, 0, -1]", "Velocity." },
    { "w", &key_spin, AT(w), "rad/s", "0", "3", "Angular velocity." },
    { "name", &key_group, AT(group), "-", "none", "\"charge\"",
      "Name of the group that the new bodies belong to. Several pours and groups of bodies may "
      "have the same name." },
    { "material", &key_material, AT(material), "-", "\"ball\"", "\"steel\"", "Material." },
    { "density", &key_positive, AT(density), "kg/m^3", "of the material", "2600",
      "Density; in 2D in kg/m^2." },
    { "mass", &key_positive, AT(mass), "kg", "by density", "1e-3",
      "Mass of a body, instead of density.", .without = "density", .why = "density is given too" },
    { "from", &key_number, AT(from), "s", "start", "0", "Start of the pour." },
    { "until", &key_number, AT(until), "s", "never", "1", "End of the pour." },
    { "count", &key_integer, AT(count), "-", "no limit", "1000", "Largest number of bodies.",
      .most = INT32_MAX, .read = read_count },
    { "poured", &key_object, AT(poured), "-", "none", "see below",
      "Number and mass of the bodies that were added before the scene begins, as {\"bodies\": "
      "25, \"mass\": 0.4}: the pour continues with the next one. from is then the time at which "
      "the pour started.",
      .object = &count_keys },
    { 0 },
};

static int finish_pour(jnode o, struct scene *s, void *out)
{
    struct scene_pour *p = out;
    p->by_mass = keys_has(&o, "mass_rate");
    // nothing is due from before the scene begins, but to a pour that has begun
    if (!keys_has(&o, "poured")) p->from = fmax(p->from, s->t);
    if (!keys_has(&o, "density")) p->density = s->material[p->material].density;
    return scene_finish_grain(o, s, &p->form, &p->size);
}

const struct keys scene_pour_keys = { "pour", pour_key, .finish = finish_pour };

static int read_pour(jnode o, struct scene *s, void *out)
{
    struct scene_pour *p = &s->pour[s->pours++];
    (void)out;
    *p = (struct scene_pour){ .until = INFINITY,
                              .count = INFINITY,
                              .form = { .turned = { 1, 0, 0, 0 }, .fill = 1 } };
    return keys_read(o, &scene_pour_keys, s, p);
}

int scene_read_pours(jnode a, struct scene *s, void *out)
{
    const size_t n = json_array_size(a.json);
    if (!(s->pour = scene_alloc(a, n, sizeof *s->pour))) return 1;
    return n > 1000 ? json_node_fault(a, "more than 1000 pours") : keys_each(a, s, out, read_pour);
}

/* ---- removals ---- */

static int scene_flow_by_number(const void *a, const void *b)
{
    int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return x < y ? -1 : x > y;
}

/* One number of a body, or several */
static int read_ids(jnode a, struct scene *s, void *out)
{
    struct scene_removal *r = out;
    bool many = json_is_array(a.json);
    size_t n = many ? json_array_size(a.json) : 1;
    int64_t id = 0;
    (void)s;
    if (!n || n > INT32_MAX) return json_node_fault(a, "needs the numbers of bodies");
    if (!(r->id = scene_alloc(a, n, sizeof *r->id))) return 1;
    for (size_t k = 0; k < n; k++) {
        if (json_node_integer(many ? json_node_item(&a, k) : a, 0, INT32_MAX, &id)) return 1;
        r->id[r->ids++] = (int32_t)id;
    }
    qsort(r->id, n, sizeof *r->id, scene_flow_by_number);
    return 0;
}

#undef AT
#define AT(member) offsetof(struct scene_removal, member)

static const struct key below_key[] = {
    { "point", &key_vector, AT(point), "m", REQUIRED, "[0, 0, 0]", "Point of the plane." },
    { "normal", &key_direction, AT(normal), "-", REQUIRED, "[0, 0, 1]", "Its normal." },
    { 0 },
};
static const struct keys below_keys = { "below", below_key };

static const struct key_type key_ids = { "integer or array", "{'$ref': 'ids'}", NULL, NULL };

static const struct key removal_key[] = {
    { "outside", &key_box, AT(box), "m", "-", "{\"x\": [-1, 1]}",
      "Remove bodies whose centre is outside this box.", .choice = -1, .some = true },
    { "inside", &key_box, AT(box), "m", "-", "{\"z\": [null, 0]}",
      "Remove bodies whose centre is inside this box.", .choice = -1, .some = true },
    { "below", &key_object, 0, "m", "-", "{\"point\": [0, 0, 0], ...}",
      "Remove bodies whose centre is below this plane, on the side away from its normal.",
      .choice = -1, .some = true, .object = &below_keys },
    { "material", &key_material, AT(material), "-", "all", "\"steel\"",
      "Remove bodies of this material only.", .some = true },
    { "id", &key_ids, 0, "-", "all", "[3, 17]", "Remove bodies with these ids only.", .some = true,
      .read = read_ids },
    { "name", &key_group, AT(group), "-", "all", "\"charge\"",
      "Remove bodies of this group only. It is the name of a group of bodies or of a pour; "
      "another name is an error.",
      .some = true },
    { FROM("Time of the first removals: steps that begin earlier remove nothing.") },
    { UNTIL("Time of the last removals.") },
    { "removed", &key_object, AT(removed), "-", "none", "see below",
      "Number and mass of the bodies that were removed before the scene begins, as {\"bodies\": "
      "3, \"mass\": 0.1}.",
      .object = &count_keys },
    { 0 },
};

static int finish_removal(jnode o, struct scene *s, void *out)
{
    struct scene_removal *r = out;
    (void)s;
    r->region = keys_has(&o, "outside")  ? REGION_OUTSIDE
                : keys_has(&o, "inside") ? REGION_INSIDE
                : keys_has(&o, "below")  ? REGION_BELOW
                                         : REGION_ALL;
    return scene_check_span(o, r->from, r->until);
}

const struct keys scene_removal_keys = { "remove", removal_key, .finish = finish_removal };

static int read_removal(jnode o, struct scene *s, void *out)
{
    struct scene_removal *r = &s->removal[s->removals++];
    (void)out;
    *r = (struct scene_removal){ .material = -1, .from = -INFINITY, .until = INFINITY };
    return keys_read(o, &scene_removal_keys, s, r);
}

int scene_read_removals(jnode a, struct scene *s, void *out)
{
    const size_t n = json_array_size(a.json);
    if (!(s->removal = scene_alloc(a, n, sizeof *s->removal))) return 1;
    return n > 1000 ? json_node_fault(a, "more than 1000 removals")
                    : keys_each(a, s, out, read_removal);
}
