/* scene/scene_flow.c: "pour" and "remove" from their JSON. */
#include "scene/scene_read.h"

#include <stdlib.h>
#include <string.h>

static int scene_flow_read_disc(jnode o, int dim, struct scene_pour *p)
{
    p->disc = true;
    return json_node_only(o, "center normal radius") ||
           json_node_need(&o, "center normal radius") ||
           json_node_vector(json_node_key(&o, "center"), dim, &p->center) ||
           scene_read_direction(json_node_key(&o, "normal"), dim, &p->normal) ||
           json_node_number(json_node_key(&o, "radius"), J_POSITIVE, &p->radius);
}

static int read_opening(jnode o, int dim, struct scene_pour *p)
{
    int which = json_node_choice(o, "box disc");
    if (which < 0 || json_node_only(o, "box disc")) return 1;
    if (which == 1) return scene_flow_read_disc(json_node_key(&o, "disc"), dim, p);
    jnode box = json_node_key(&o, "box");
    if (scene_read_box(box, dim, &p->box)) return 1;
    for (int i = 0; i < dim; i++)
        if (!isfinite(p->box.hi[i] - p->box.lo[i]))
            return json_node_fault(box, "an opening needs a closed box, %s is open", axis_name[i]);
    return 0;
}

/* What a pour or a removal has done before the scene begins, as nsd-info --scene prints it */
static int read_passage(jnode o, struct flow_count *p)
{
    if (!o.json) return 0;
    return json_node_only(o, "bodies mass") || json_node_need(&o, "bodies mass") ||
           json_node_integer(json_node_key(&o, "bodies"), 0, INT64_MAX, &p->bodies) ||
           json_node_number(json_node_key(&o, "mass"), J_NOT_NEGATIVE, &p->mass);
}

static int read_pour(jnode o, struct scene *s, struct scene_pour *p)
{
    int64_t count = -1;
    *p = (struct scene_pour){ .until = INFINITY, .count = INFINITY };
    int which = json_node_choice(o, "rate mass_rate");
    if (which < 0 ||
        json_node_only(
            o, "rate mass_rate opening radius size shape orientation v w name kind density mass "
               "from until count poured") ||
        read_passage(json_node_key(&o, "poured"), &p->poured) || json_node_need(&o, "opening") ||
        scene_read_form(o, s, &p->form))
        return 1;
    p->by_mass = which == 1;
    if (json_node_number(json_node_key(&o, which ? "mass_rate" : "rate"), J_POSITIVE, &p->rate) ||
        read_opening(json_node_key(&o, "opening"), s->dim, p) ||
        scene_read_sizes(o, s, &p->form, &p->size) ||
        json_node_vector(json_node_key(&o, "v"), s->dim, &p->v) ||
        scene_read_spin(json_node_key(&o, "w"), s->dim, &p->w) ||
        scene_read_group(json_node_key(&o, "name"), s, &p->group) ||
        scene_read_kind(json_node_key(&o, "kind"), s, &p->kind) ||
        json_node_number(json_node_key(&o, "from"), J_ANY, &p->from) ||
        json_node_number(json_node_key(&o, "until"), J_ANY, &p->until) ||
        json_node_integer(json_node_key(&o, "count"), 0, INT32_MAX, &count))
        return 1;
    if (count >= 0) p->count = (double)count;
    // nothing is due from before the scene begins, but to a pour that has begun
    if (!json_node_key(&o, "poured").json) p->from = fmax(p->from, s->t);
    p->density = s->kind[p->kind].density;
    return scene_read_mass(&o, &p->density, &p->mass);
}

int scene_read_pours(jnode a, struct scene *s)
{
    size_t n;
    if (json_node_array(a, &n) || !(s->pour = scene_alloc(a, n, sizeof *s->pour))) return 1;
    if (n > 1000) return json_node_fault(a, "more than 1000 pours");
    for (size_t i = 0; i < n; i++)
        if (read_pour(json_node_item(&a, i), s, &s->pour[s->pours++])) return 1;
    return 0;
}

static int scene_flow_by_number(const void *a, const void *b)
{
    int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return x < y ? -1 : x > y;
}

/* One number of a body, or several */
static int read_ids(jnode a, struct scene_removal *r)
{
    bool many = json_is_array(a.json);
    size_t n = 1;
    int64_t id = 0;
    if (!a.json) return 0;
    if (many && json_node_array(a, &n)) return 1;
    if (!n || n > INT32_MAX) return json_node_fault(a, "needs the numbers of bodies");
    if (!(r->id = scene_alloc(a, n, sizeof *r->id))) return 1;
    for (size_t k = 0; k < n; k++) {
        if (json_node_integer(many ? json_node_item(&a, k) : a, 0, INT32_MAX, &id)) return 1;
        r->id[r->ids++] = (int32_t)id;
    }
    qsort(r->id, n, sizeof *r->id, scene_flow_by_number);
    return 0;
}

/* Which bodies go, wherever they are */
static int read_which(jnode o, struct scene *s, struct scene_removal *r)
{
    return scene_read_kind(json_node_key(&o, "kind"), s, &r->kind) ||
           scene_read_group(json_node_key(&o, "name"), s, &r->group) ||
           read_ids(json_node_key(&o, "id"), r);
}

static int read_removal(jnode o, struct scene *s, struct scene_removal *r)
{
    static const char *const key[] = { "outside", "inside", "below" };
    bool anywhere = true, any = !json_node_key(&o, "kind").json && !json_node_key(&o, "id").json &&
                                !json_node_key(&o, "name").json;
    *r = (struct scene_removal){ .kind = -1, .from = -INFINITY, .until = INFINITY };
    for (int k = 0; k < 3; k++) anywhere = anywhere && !json_node_key(&o, key[k]).json;
    if (json_node_only(o, "outside inside below kind id name from until removed") ||
        read_passage(json_node_key(&o, "removed"), &r->removed))
        return 1;
    if (anywhere && any)
        return json_node_fault(o, "needs one of outside, inside, below, kind, id or name: which "
                                  "bodies go");
    int which = anywhere ? REGION_ALL : json_node_choice(o, "outside inside below");
    if (which < 0 || read_which(o, s, r) ||
        json_node_number(json_node_key(&o, "from"), J_ANY, &r->from) ||
        json_node_number(json_node_key(&o, "until"), J_ANY, &r->until))
        return 1;
    if (!(r->from <= r->until))
        return json_node_fault(json_node_key(&o, "until"), "must not lie before its beginning");
    r->region = (enum scene_region)which;
    if (anywhere) return 0;
    jnode where = json_node_key(&o, key[which]);
    if (r->region != REGION_BELOW) return scene_read_box(where, s->dim, &r->box);
    return json_node_only(where, "point normal") || json_node_need(&where, "point normal") ||
           json_node_vector(json_node_key(&where, "point"), s->dim, &r->point) ||
           scene_read_direction(json_node_key(&where, "normal"), s->dim, &r->normal);
}

int scene_read_removals(jnode a, struct scene *s)
{
    size_t n;
    if (json_node_array(a, &n) || !(s->removal = scene_alloc(a, n, sizeof *s->removal))) return 1;
    if (n > 1000) return json_node_fault(a, "more than 1000 removals");
    for (size_t i = 0; i < n; i++)
        if (read_removal(json_node_item(&a, i), s, &s->removal[s->removals++])) return 1;
    return 0;
}
