#include "scene/inlet.h"

#include "base/random.h"
#include "contact/detect.h"
#include "scene/grains.h"

#include <stdlib.h>
#include <string.h>

enum {
    TRIES = 16,        /* places for a grain in a step */
    POURED_MOST = 2000 /* grains of a pour in a step, each of which looks at all others */
};

/* The scene's shapes are the first of the packing's. */
static bool same_shapes(const struct scene *s, const struct packing *p)
{
    if (s->shapes.n > p->shapes.n) return false;
    for (int32_t k = 1; k < s->shapes.n; k++)
        if (!shape_same(&s->shapes.s[k], &p->shapes.s[k])) return false;
    return true;
}

/* 1 + the packing's row of a name instead of the scene's, for documents of bodies bring names of their own. Returns 0,
   or 1: the packing does not have it. */
static int find_group(int32_t *group, const struct scene *s, const struct packing *p)
{
    if (!*group) return 0;
    const char *name = s->names.text[*group - 1];
    *group = 1 + names_find(&p->names, name, strlen(name));
    return !*group;
}

static int find_groups(struct scene *s, const struct packing *p)
{
    for (int32_t k = 0; k < s->pours; k++)
        if (find_group(&s->pour[k].group, s, p) || (s->pour[k].group && !p->group)) return 1;
    for (int32_t k = 0; k < s->removals; k++)
        if (find_group(&s->removal[k].group, s, p)) return 1;
    return 0;
}

int flow_read(struct flow *f, const struct packing *p, struct failure *failure)
{
    *f = (struct flow){ 0 };
    if (!packing_flows(p)) return 0;
    if (!p->scene)
        return failure_set(failure, EX_DATAERR,
                           "inlets or outlets, but no scene that describes them");
    if (scene_parse(&f->scene, p->scene, strlen(p->scene), NULL, failure)) return failure->status;
    if (f->scene.pours == p->pours && f->scene.removals == p->removals &&
        f->scene.materials == p->materials && f->scene.dim == p->dim && same_shapes(&f->scene, p) &&
        !find_groups(&f->scene, p))
        return 0;
    flow_free(f);
    return failure_set(
        failure, EX_DATAERR,
        "the scene's pours, removals, materials, shapes or names are not the packing's");
}

void flow_free(struct flow *f)
{
    scene_free(&f->scene);
}

static void inlet_note(struct packing *p, int64_t i, bool came, int32_t which,
                       struct failure *failure)
{
    struct event e = { p->step,      p->t,       p->id[i], came,   which,
                       p->radius[i], p->mass[i], p->x[i],  p->v[i] };
    events_add(&p->events, &e, failure);
}

/* ---- removals ---- */

static bool in_box(const struct scene_box *b, vec3 x, int dim)
{
    const double at[3] = { x.x, x.y, x.z };
    for (int k = 0; k < 3; k++) /* in the plane the third axis does not count */
        if (k < dim && (at[k] < b->lo[k] || at[k] > b->hi[k])) return false;
    return true;
}

static int inlet_by_number(const void *a, const void *b)
{
    int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return x < y ? -1 : x > y;
}

/* x: m, the body's place */
static bool takes(const struct scene_removal *r, const struct packing *p, int64_t i, vec3 x)
{
    if (p->t < r->from || p->t > r->until) return false;
    if (r->material >= 0 && p->material[i] != r->material) return false;
    if (r->group && (!p->group || p->group[i] != r->group)) return false;
    if (r->ids && !bsearch(&p->id[i], r->id, (size_t)r->ids, sizeof *r->id, inlet_by_number))
        return false;
    if (r->region == REGION_ALL) return true;
    if (r->region == REGION_BELOW) return v3_dot(v3_sub(x, r->point), r->normal) < 0;
    return in_box(&r->box, x, p->dim) == (r->region == REGION_INSIDE);
}

/* The removal that takes body i; -1: none does. inverse: of the cell's edges, where it repeats */
static int32_t taken_by(const struct flow *f, const struct packing *p, const vec3 inverse[3],
                        int64_t i)
{
    vec3 x = p->x[i];
    int32_t w[3] = { 0, 0, 0 };
    // a body that has left the cell in the last step is its image inside
    if (cell_repeats(&p->cell)) cell_wraps(&p->cell, inverse, x, w);
    for (int k = 0; k < 3; k++)
        if (w[k]) x = v3_axpy(x, -w[k], p->cell.edge[k]);
    for (int32_t k = 0; k < f->scene.removals; k++)
        if (takes(&f->scene.removal[k], p, i, x)) return k;
    return -1;
}

/* Removes, and tells in row[i] where body i is now, -1: gone. */
static int remove_bodies(const struct flow *f, struct packing *p, int32_t *row,
                         struct failure *failure)
{
    int64_t kept = 0;
    vec3 inverse[3];
    cell_inverse(p->cell.edge, inverse);
    for (int64_t i = 0; i < p->n; i++) {
        int32_t k = taken_by(f, p, inverse, i);
        row[i] = k < 0 ? (int32_t)kept : -1;
        if (k < 0) {
            packing_copy_body(p, kept++, p, i);
            continue;
        }
        p->removed[k].bodies++, p->removed[k].mass += p->mass[i];
        inlet_note(p, i, false, k, failure);
        if (failure->status) return failure->status; // the tool ends here
    }
    external_force_follow(&p->outside, row, p->n);
    return packing_resize(p, kept, failure);
}

/* The contacts of bodies that are still there, in their new rows, in the same order */
static void inlet_follow(struct contacts *s, const int32_t *row)
{
    int64_t kept = 0;
    for (int64_t i = 0; i < s->n; i++) {
        struct contact *c = &s->c[i];
        int32_t a = c->a < 0 ? c->a : row[c->a], b = row[c->b];
        if (b < 0 || (c->a >= 0 && a < 0)) continue;
        s->c[kept] = *c;
        s->c[kept].a = a, s->c[kept].b = b;
        if (s->found) s->found[kept] = s->found[i];
        if (s->law) s->law[kept] = s->law[i];
        for (int k = 0; k < 3 && s->moment; k++) s->moment[kept][k] = s->moment[i][k];
        kept++;
    }
    s->n = kept;
}

/* The bonds of bodies that are still there, likewise */
static void follow_bonds(struct bonds *s, const int32_t *row)
{
    int64_t kept = 0;
    for (int64_t i = 0; i < s->n; i++) {
        struct bond x = s->bond[i];
        if (x.a >= 0) x.a = row[x.a];
        bool there = row[x.b] >= 0 && (s->bond[i].a < 0 || x.a >= 0);
        x.b = row[x.b];
        if (there) s->bond[kept++] = x;
    }
    s->n = kept;
}

int flow_drop(struct packing *p, struct contacts *last, const int32_t *row, struct failure *failure)
{
    int64_t kept = 0;
    for (int64_t i = 0; i < p->n; i++)
        if (row[i] >= 0) packing_copy_body(p, kept++, p, i);
    follow_bonds(&p->bonds, row);
    memory_follow(&p->memory, row);
    external_force_follow(&p->outside, row, p->n);
    if (last) inlet_follow(last, row);
    return packing_resize(p, kept, failure);
}

/* ---- pours ---- */

static bool inlet_is_due(const struct scene_pour *o, const struct flow_count *so_far, double t)
{
    if (t < o->from || t > o->until || (double)so_far->bodies >= o->count) return false;
    double had = o->by_mass ? so_far->mass : (double)so_far->bodies;
    return had <= o->rate * (t - o->from);
}

/* Two unit vectors across a normal; in the plane the first lies in it. */
static void inlet_across(vec3 n, int dim, vec3 *a, vec3 *b)
{
    double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
    vec3 least = x <= y && x <= z ? v3(1, 0, 0) : y <= z ? v3(0, 1, 0) : v3(0, 0, 1);
    vec3 t = dim == 2 ? v3(-n.y, n.x, 0) : v3_cross(n, least);
    *a = v3_scale(1 / v3_norm(t), t);
    *b = v3_cross(n, *a);
}

/* A place in the opening, each as likely */
static vec3 inlet_draw_place(const struct scene_pour *o, int dim, gsl_rng *rng)
{
    if (!o->disc) {
        double x[3] = { 0 };
        for (int k = 0; k < dim; k++)
            x[k] = o->box.lo[k] + (o->box.hi[k] - o->box.lo[k]) * gsl_rng_uniform(rng);
        return v3(x[0], x[1], x[2]);
    }
    double u, w;
    vec3 a, b;
    inlet_across(o->normal, dim, &a, &b);
    do {
        u = 2 * gsl_rng_uniform(rng) - 1, w = dim == 2 ? 0 : 2 * gsl_rng_uniform(rng) - 1;
    } while (u * u + w * w > 1);
    return v3_axpy(v3_axpy(o->center, o->radius * u, a), o->radius * w, b);
}

/* The bodies that a grain in the opening may meet, for whom nothing else moves, and the grain behind
   them: it is the only one with a mass, so that only its contacts are found. */
struct crowd {
    struct packing p; /* shares walls, materials and all else but the bodies */
    int64_t *body;    /* [p.n - 1] */
    vec3 *now;        /* [p.n] m: positions, and the predicted ones */
    vec3 *then;
};

static void crowd_free(struct crowd *c)
{
    free(c->p.radius), free(c->p.mass), free(c->p.material), free(c->p.v);
    free(c->now), free(c->then), free(c->body), free(c->p.q), free(c->p.shape);
}

/* Is x, or an image of it, this near to 0? The nearest image is at most one edge from the one that is nearest in
   edges, for these do not lean by more than one another's length [state/placement.h]. */
static bool inlet_is_near(const struct cell *c, const vec3 inverse[3], vec3 x, double most)
{
    int reach[3] = { 0, 0, 0 };
    for (int k = 2; k >= 0; k--) {
        if (!c->repeats[k]) continue;
        reach[k] = 1;
        x = v3_axpy(x, -rint(v3_dot(inverse[k], x)), c->edge[k]);
    }
    for (int a = -reach[0]; a <= reach[0]; a++)
        for (int b = -reach[1]; b <= reach[1]; b++)
            for (int e = -reach[2]; e <= reach[2]; e++) {
                vec3 d = v3_axpy(v3_axpy(v3_axpy(x, a, c->edge[0]), b, c->edge[1]), e, c->edge[2]);
                if (v3_dot(d, d) <= most * most) return true;
            }
    return false;
}

static bool may_meet(const struct scene_pour *o, const struct packing *p, const vec3 inverse[3],
                     int64_t i)
{
    vec3 middle = o->center;
    double far = o->radius;
    if (!o->disc) {
        const struct scene_box *b = &o->box;
        vec3 lo = v3(b->lo[0], b->lo[1], p->dim == 3 ? b->lo[2] : 0);
        vec3 hi = v3(b->hi[0], b->hi[1], p->dim == 3 ? b->hi[2] : 0);
        middle = v3_scale(0.5, v3_add(lo, hi)), far = 0.5 * v3_norm(v3_sub(hi, lo));
    }
    double way = p->dt * (v3_norm(o->v) + v3_norm(p->v[i]));
    for (int k = 0; k < 3; k++) // images have the edges' rates besides
        if (p->cell.repeats[k]) way += 2 * p->dt * v3_norm(p->cell.rate[k]);
    double most = (far + o->size.max + p->radius[i] + way) * (1 + 1e-9);
    return inlet_is_near(&p->cell, inverse, v3_sub(p->x[i], middle), most);
}

static int crowd_gather(struct crowd *c, const struct packing *p, const struct scene_pour *o,
                        struct failure *failure)
{
    size_t room = (size_t)p->n + 1;
    *c = (struct crowd){ .p = *p };
    c->p.n = 0;
    c->p.radius = calloc(room, sizeof *c->p.radius), c->p.mass = calloc(room, sizeof *c->p.mass);
    c->p.material = calloc(room, sizeof *c->p.material), c->p.v = calloc(room, sizeof *c->p.v);
    c->now = calloc(room, sizeof *c->now), c->then = calloc(room, sizeof *c->then);
    c->body = calloc(room, sizeof *c->body);
    c->p.q = calloc(room, sizeof *c->p.q);
    c->p.shape = p->shape ? calloc(room, sizeof *c->p.shape) : NULL;
    if (!c->p.radius || !c->p.mass || !c->p.material || !c->p.v || !c->now || !c->then ||
        !c->body || !c->p.q || (p->shape && !c->p.shape))
        return failure_set(failure, EX_SOFTWARE, "no memory to pour");
    vec3 inverse[3];
    cell_inverse(p->cell.edge, inverse);
    for (int64_t i = 0; i < p->n; i++) {
        if (!may_meet(o, p, inverse, i)) continue;
        int64_t k = c->p.n++;
        c->body[k] = i;
        c->p.radius[k] = p->radius[i], c->p.material[k] = p->material[i], c->p.q[k] = p->q[i];
        if (p->shape) c->p.shape[k] = p->shape[i];
        c->now[k] = p->x[i], c->then[k] = packing_predict(p, i);
    }
    c->p.n++;
    return 0;
}

/* A grain that is to be poured */
struct newcomer {
    vec3 x; /* m */
    quat q;
    double r; /* m: its radius */
};

/* Would it meet nothing, neither now nor at the predicted positions? */
static bool inlet_is_free(struct crowd *c, const struct scene_pour *o, const struct newcomer *g,
                          struct failure *failure)
{
    int64_t last = c->p.n - 1;
    struct contacts met = { 0 };
    double ahead = step_ahead(&c->p);
    c->p.radius[last] = g->r, c->p.mass[last] = 1, c->p.material[last] = o->material;
    c->p.q[last] = g->q;
    if (c->p.shape) c->p.shape[last] = o->form.shape;
    c->now[last] = g->x, c->then[last] = v3_axpy(g->x, ahead, o->v);
    bool clear = !detect_contacts_at(&met, &c->p, c->now, c->p.t, 0, failure) && !met.n &&
                 !detect_contacts_at(&met, &c->p, c->then, c->p.t + ahead, 0, failure) && !met.n;
    contacts_free(&met);
    return clear && !failure->status;
}

static int add_grain(struct packing *p, const struct scene_pour *o, int32_t which,
                     const struct newcomer *g, struct failure *failure)
{
    const double r = g->r;
    int64_t i = p->n, id = p->first_id;
    for (int32_t k = 0; k < p->pours; k++) id += p->poured[k].bodies;
    if (id >= INT32_MAX) return failure_set(failure, EX_DATAERR, "more than %d bodies", INT32_MAX);
    if (packing_resize(p, i + 1, failure)) return failure->status;
    const struct new_body body = { .x = g->x,
                                   .v = o->v,
                                   .w = o->w,
                                   .q = g->q,
                                   .radius = r,
                                   .density = o->density,
                                   .mass = o->mass,
                                   .weighed = o->mass > 0,
                                   .material = o->material,
                                   .shape = o->form.shape,
                                   .group = o->group };
    if (!packing_set_body(p, i, &body))
        return failure_set(failure, EX_DATAERR, "pour %d: a radius of %g m gives no mass", which,
                           r);
    p->id[i] = (int32_t)id;
    p->poured[which].bodies++, p->poured[which].mass += p->mass[i];
    inlet_note(p, i, true, which, failure);
    return failure->status;
}

/* The next grain of a pour, if it finds a place. */
static bool pour_one(const struct scene *s, struct packing *p, int32_t which, gsl_rng *rng,
                     struct failure *failure)
{
    const struct scene_pour *o = &s->pour[which];
    struct newcomer g = { .q = { 1, 0, 0, 0 } };
    struct crowd c;
    uint64_t k = (uint64_t)which, n = (uint64_t)p->poured[which].bodies;
    counter_start(rng, p->seed, COUNTER_GRAIN, k, n, 0);
    g.r = scene_size_draw(&o->size, rng);
    if (o->form.shape) {
        counter_start(rng, p->seed, COUNTER_TURN, UINT64_MAX - k, n, 0); // no group has that number
        g.q = orientation_draw(s, &o->form, rng);
    }
    counter_start(rng, p->seed, COUNTER_PLACE, k, n, (uint64_t)p->step);
    bool poured = false;
    crowd_gather(&c, p, o, failure);
    for (int try = 0; try < TRIES && !poured && !failure->status; try++) {
        g.x = inlet_draw_place(o, p->dim, rng);
        poured = inlet_is_free(&c, o, &g, failure) && !add_grain(p, o, which, &g, failure);
    }
    crowd_free(&c);
    return poured;
}

int flow_step(const struct flow *f, struct packing *p, struct contacts *last, bool *changed,
              struct failure *failure)
{
    *changed = false;
    if (!packing_flows(p)) return 0;
    int64_t before = p->events.n;
    int32_t *row = malloc(((size_t)p->n + 1) * sizeof *row);
    gsl_rng *rng = counter_alloc();
    if (!row || !rng)
        failure_set(failure, EX_SOFTWARE, "no memory for inlets and outlets");
    else if (!remove_bodies(f, p, row, failure)) {
        follow_bonds(&p->bonds, row);
        memory_follow(&p->memory, row);
        if (last) inlet_follow(last, row);
    }
    for (int32_t k = 0; k < f->scene.pours && !failure->status; k++)
        for (int n = 0; n < POURED_MOST && !failure->status; n++)
            if (!inlet_is_due(&f->scene.pour[k], &p->poured[k], p->t) ||
                !pour_one(&f->scene, p, k, rng, failure))
                break;
    *changed = p->events.n > before;
    free(row);
    gsl_rng_free(rng);
    return failure->status;
}
