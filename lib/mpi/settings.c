/* mpi/settings.c: what a packing has besides its bodies [mpi/settings.h]. */
#include "mpi/settings.h"

#include <stdlib.h>
#include <string.h>

static void put_text(struct comm *t, struct parcel *o, const char *text)
{
    parcel_put_array(t, o, text, text ? (int64_t)strlen(text) + 1 : 0, 1);
}

static char *take_text(struct comm *t, struct parcel *o)
{
    char *text;
    if (parcel_take_array(t, o, &text, 1)) return text;
    free(text);
    return NULL;
}

static void put_drives(struct comm *t, struct parcel *o, const struct drives *d)
{
    parcel_put_array(t, o, d->drive, d->n, sizeof *d->drive);
    parcel_put_array(t, o, d->row, d->rows, sizeof *d->row);
}

static void take_drives(struct comm *t, struct parcel *o, struct drives *d)
{
    drives_free(d);
    d->n = (int32_t)parcel_take_array(t, o, &d->drive, sizeof *d->drive);
    d->rows = (int32_t)parcel_take_array(t, o, &d->row, sizeof *d->row);
}

static void settings_put_names(struct comm *t, struct parcel *o, const struct names *names)
{
    parcel_put(t, o, &names->n, sizeof names->n);
    for (int32_t k = 0; k < names->n; k++) put_text(t, o, names->text[k]);
    parcel_put_array(t, o, names->row, names->rows, sizeof *names->row);
}

static void take_names(struct comm *t, struct parcel *o, struct names *names)
{
    int32_t n;
    names_free(names);
    parcel_take(t, o, &n, sizeof n);
    names->text = comm_new(t, n, sizeof *names->text);
    for (; names->n < n; names->n++) names->text[names->n] = take_text(t, o);
    names->rows = (int32_t)parcel_take_array(t, o, &names->row, sizeof *names->row);
}

static void put_shapes(struct comm *t, struct parcel *o, const struct shapes *list)
{
    parcel_put(t, o, &list->n, sizeof list->n);
    for (int32_t k = 1; k < list->n; k++) {
        const struct shape *s = &list->s[k];
        const int32_t faces = s->faces, corners = s->corners;
        put_text(t, o, s->name);
        parcel_put(t, o, &s->form, sizeof s->form), parcel_put(t, o, &s->round, sizeof s->round);
        parcel_put(t, o, &s->volume, sizeof s->volume);
        parcel_put(t, o, s->moment, sizeof s->moment);
        parcel_put_array(t, o, s->vertex, s->vertices, sizeof *s->vertex);
        parcel_put_array(t, o, s->ball, s->vertices, sizeof *s->ball);
        parcel_put_array(t, o, s->first, faces ? faces + 1 : 0, sizeof *s->first);
        parcel_put_array(t, o, s->corner, corners, sizeof *s->corner);
    }
}

static void settings_fail(struct comm *t, const struct failure *failure)
{
    comm_fail(t, failure->status, failure->text);
}

static void settings_take_shapes(struct comm *t, struct parcel *o, struct shapes *list, int dim)
{
    int32_t n;
    struct failure failure = { 0 };
    shapes_free(list);
    parcel_take(t, o, &n, sizeof n);
    for (int32_t k = 1; k < n; k++) {
        struct shape s = { 0 };
        s.name = take_text(t, o);
        parcel_take(t, o, &s.form, sizeof s.form), parcel_take(t, o, &s.round, sizeof s.round);
        parcel_take(t, o, &s.volume, sizeof s.volume);
        parcel_take(t, o, s.moment, sizeof s.moment);
        s.vertices = (int32_t)parcel_take_array(t, o, &s.vertex, sizeof *s.vertex);
        parcel_take_array(t, o, &s.ball, sizeof *s.ball);
        s.faces = (int32_t)parcel_take_array(t, o, &s.first, sizeof *s.first);
        s.faces -= s.faces > 0;
        s.corners = (int32_t)parcel_take_array(t, o, &s.corner, sizeof *s.corner);
        const double volume = s.volume, moment[3] = { s.moment[0], s.moment[1], s.moment[2] };
        if (shape_finish(&s, dim, &failure) || shapes_add(list, dim, &s, &failure))
            settings_fail(t, &failure);
        struct shape *made = &list->s[list->n - 1];
        made->volume = volume;
        for (int j = 0; j < 3; j++) made->moment[j] = moment[j];
    }
}

static void settings_put_cell(struct comm *t, struct parcel *o, const struct cell *c)
{
    parcel_put(t, o, c, sizeof *c);
    parcel_put_array(t, o, c->gradient, c->gradients, sizeof *c->gradient);
    parcel_put_array(t, o, c->factor, c->factors, sizeof *c->factor);
}

static void settings_take_cell(struct comm *t, struct parcel *o, struct cell *c)
{
    cell_free(c);
    parcel_take(t, o, c, sizeof *c);
    c->gradients = (int32_t)parcel_take_array(t, o, &c->gradient, sizeof *c->gradient);
    c->factors = (int32_t)parcel_take_array(t, o, &c->factor, sizeof *c->factor);
}

/* Numbers that are not pointers */
struct settings_numbers {
    int64_t step;
    double t, dt, theta, t0, pulls_most;
    int64_t step0;
    vec3 g;
    uint64_t seed;
    int32_t dim, overlap, kinds, has_law, first_id;
    uint32_t optional; /* packing_optional() */
};

static void settings_put(struct comm *t, struct parcel *o, const struct packing *p)
{
    struct settings_numbers n;
    int64_t k2 = (int64_t)p->kinds * p->kinds;
    memset(&n, 0, sizeof n); // its gaps, too: parcels are compared by nobody, but read by valgrind
    n.step = p->step, n.t = p->t, n.dt = p->dt, n.theta = p->theta, n.g = p->g, n.seed = p->seed;
    n.pulls_most = p->pulls_most;
    n.t0 = p->t0, n.step0 = p->step0;
    n.dim = p->dim, n.overlap = (int32_t)p->overlap, n.kinds = p->kinds, n.first_id = p->first_id;
    n.has_law = p->law != NULL, n.optional = packing_optional(p);
    parcel_put(t, o, &n, sizeof n);
    parcel_put_array(t, o, p->wall, p->walls, sizeof *p->wall);
    put_drives(t, o, &p->drives), put_drives(t, o, &p->pushes);
    put_drives(t, o, &p->pulls);
    parcel_put_array(t, o, p->mesh.vertex, p->mesh.vertices, sizeof *p->mesh.vertex);
    parcel_put_array(t, o, p->mesh.element, p->mesh.elements, sizeof *p->mesh.element);
    settings_put_names(t, o, &p->names);
    settings_put_cell(t, o, &p->cell);
    put_shapes(t, o, &p->shapes);
    for (int32_t k = 0; k < p->kinds; k++) put_text(t, o, p->kind_name[k]);
#define PUT(member, ...) parcel_put_array(t, o, p->member, k2, sizeof *p->member);
    EVERY_PAIR_COLUMN(PUT)
#undef PUT
    if (p->law) parcel_put_array(t, o, p->law, k2, sizeof *p->law);
}

static void settings_take(struct comm *t, struct parcel *o, struct packing *p)
{
    struct settings_numbers n;
    struct failure failure = { 0 };
    parcel_take(t, o, &n, sizeof n);
    packing_free(p);
    if (packing_init(p, n.dim, 0, &failure) || packing_alloc_kinds(p, n.kinds, &failure))
        settings_fail(t, &failure);
    p->step = n.step, p->t = n.t, p->dt = n.dt, p->theta = n.theta, p->g = n.g, p->seed = n.seed;
    p->pulls_most = n.pulls_most;
    p->t0 = n.t0, p->step0 = n.step0;
    p->overlap = (enum overlap)n.overlap, p->first_id = n.first_id;
    free(p->wall);
    p->walls = (int32_t)parcel_take_array(t, o, &p->wall, sizeof *p->wall);
    take_drives(t, o, &p->drives), take_drives(t, o, &p->pushes);
    take_drives(t, o, &p->pulls);
    p->mesh.vertices = (int32_t)parcel_take_array(t, o, &p->mesh.vertex, sizeof *p->mesh.vertex);
    p->mesh.elements = (int32_t)parcel_take_array(t, o, &p->mesh.element, sizeof *p->mesh.element);
    take_names(t, o, &p->names);
    settings_take_cell(t, o, &p->cell);
    settings_take_shapes(t, o, &p->shapes, p->dim);
    for (int32_t k = 0; k < p->kinds; k++) free(p->kind_name[k]), p->kind_name[k] = take_text(t, o);
#define TAKE(member, ...) free(p->member), parcel_take_array(t, o, &p->member, sizeof *p->member);
    EVERY_PAIR_COLUMN(TAKE)
#undef TAKE
    if (n.has_law) parcel_take_array(t, o, &p->law, sizeof *p->law);
    if (packing_alloc_optional(p, n.optional, &failure)) settings_fail(t, &failure);
}

void settings_spread(struct comm *t, struct packing *p)
{
    struct parcel o = { 0 };
    if (!t->me) settings_put(t, &o, p);
    comm_spread(t, &o);
    if (t->me) settings_take(t, &o, p);
    parcel_free(&o);
}

/* *x exists where it shall, for n bodies, all zero. */
static void keep_forces(struct comm *t, vec3 **x, bool wanted, int64_t n)
{
    struct failure failure = { 0 };
    if (!wanted) free(*x), *x = NULL;
    if (wanted && external_force_alloc(x, n, &failure)) settings_fail(t, &failure);
}

void settings_act(struct comm *t, struct packing *p, const struct packing *whole)
{
    struct parcel o = { 0 };
    struct external_force *to = &p->outside;
    const struct external_force *from = &whole->outside;
    const size_t pairs = (size_t)p->kinds * (size_t)p->kinds * sizeof *p->mu;
    const size_t walls = (size_t)p->walls;
    struct {
        vec3 g;
        double most;
        int32_t force, torque, push;
    } now;
    memset(&now, 0, sizeof now);
    if (!t->me) {
        now.g = whole->g, now.most = from->most;
        now.force = from->force != NULL, now.torque = from->torque != NULL;
        now.push = from->push != NULL;
        parcel_put(t, &o, &now, sizeof now);
        parcel_put(t, &o, whole->mu, pairs);
        parcel_put(t, &o, whole->wall, walls * sizeof *whole->wall);
        if (now.push) parcel_put(t, &o, from->push, walls * sizeof *from->push);
    }
    comm_spread(t, &o);
    parcel_take(t, &o, &now, sizeof now);
    parcel_take(t, &o, p->mu, pairs);
    parcel_take(t, &o, p->wall, walls * sizeof *p->wall);
    struct failure failure = { 0 };
    if (!now.push) free(to->push), to->push = NULL;
    if (now.push && external_force_alloc_push(to, p->walls, &failure)) settings_fail(t, &failure);
    if (now.push) parcel_take(t, &o, to->push, walls * sizeof *to->push);
    p->g = now.g, to->most = now.most;
    keep_forces(t, &to->force, now.force, p->n), keep_forces(t, &to->torque, now.torque, p->n);
    parcel_free(&o);
}

void settings_copy_motion(struct packing *to, const struct packing *from)
{
    to->step = from->step, to->t = from->t;
    for (int k = 0; k < 3; k++)
        to->cell.edge[k] = from->cell.edge[k], to->cell.rate[k] = from->cell.rate[k];
    to->cell.origin = from->cell.origin;
    for (int32_t w = 0; w < to->walls && w < from->walls; w++) to->wall[w] = from->wall[w];
}

void settings_follow(struct comm *t, struct packing *p)
{
    struct parcel o = { 0 };
    struct {
        int64_t step;
        double t;
        vec3 origin, edge[3], rate[3];
    } now;
    memset(&now, 0, sizeof now);
    if (!t->me) {
        now.step = p->step, now.t = p->t, now.origin = p->cell.origin;
        for (int k = 0; k < 3; k++) now.edge[k] = p->cell.edge[k], now.rate[k] = p->cell.rate[k];
        parcel_put(t, &o, &now, sizeof now);
        parcel_put(t, &o, p->wall, (size_t)p->walls * sizeof *p->wall);
    }
    comm_spread(t, &o);
    if (t->me) {
        parcel_take(t, &o, &now, sizeof now);
        p->step = now.step, p->t = now.t, p->cell.origin = now.origin;
        for (int k = 0; k < 3; k++) p->cell.edge[k] = now.edge[k], p->cell.rate[k] = now.rate[k];
        parcel_take(t, &o, p->wall, (size_t)p->walls * sizeof *p->wall);
    }
    parcel_free(&o);
}
