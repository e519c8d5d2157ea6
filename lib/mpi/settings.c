/* mpi/settings.c: what a packing has besides its bodies [mpi/settings.h]. */
#include "mpi/settings.h"

#include "state/part.h"

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

/* Does a rank get the array from the first? */
static bool is_sent(const struct part *a)
{
    return a->traits & PART_SETTING && !(a->traits & PART_AGAIN);
}

static void put_part(struct comm *t, struct parcel *o, const struct part *a,
                     const struct packing *p)
{
    const int64_t n = part_count(a, p);
    const char *rows = part_array(a, p);
    const int8_t there = rows != NULL;
    parcel_put(t, o, &there, 1);
    for (int64_t i = 0; there && a->traits & PART_TEXT && i < n; i++)
        put_text(t, o, ((char *const *)(const void *)rows)[i]);
    if (there && !(a->traits & PART_TEXT)) parcel_put(t, o, rows, (size_t)n * a->bytes);
}

static void take_part(struct comm *t, struct parcel *o, const struct part *a, struct packing *p)
{
    const int64_t n = part_count(a, p);
    int8_t there;
    parcel_take(t, o, &there, 1);
    if (!there) return;
    void *rows = comm_new(t, n, a->bytes);
    for (int64_t i = 0; a->traits & PART_TEXT && i < n; i++) ((char **)rows)[i] = take_text(t, o);
    if (!(a->traits & PART_TEXT)) parcel_take(t, o, rows, (size_t)n * a->bytes);
    part_set_array(a, p, rows);
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

static void settings_put(struct comm *t, struct parcel *o, const struct packing *p)
{
    const struct packing settings = packing_settings(p);
    uint32_t columns = 0;
    for (int k = 0; k < BODY_COLUMNS; k++)
        columns |= field_array(&body_columns[k], p) ? 1u << k : 0;
    parcel_put(t, o, &settings, sizeof settings); // with pointers, of which no other rank makes use
    parcel_put(t, o, &columns, sizeof columns);
    put_shapes(t, o, &p->shapes);
    for (const struct part *a = packing_parts; a->name; a++)
        if (is_sent(a)) put_part(t, o, a, p);
}

static void settings_take(struct comm *t, struct parcel *o, struct packing *p)
{
    struct failure failure = { 0 };
    uint32_t columns;
    packing_free(p);
    parcel_take(t, o, p, sizeof *p), parcel_take(t, o, &columns, sizeof columns);
    packing_disown(p);
    p->memory.on = false, p->outside = (struct external_force){ 0 };
    settings_take_shapes(t, o, &p->shapes, p->dim);
    for (const struct part *a = packing_parts; a->name; a++)
        if (is_sent(a)) take_part(t, o, a, p);
    if (packing_alloc_optional(p, columns, &failure)) settings_fail(t, &failure);
}

void settings_spread(struct comm *t, struct packing *p)
{
    struct parcel o = { 0 };
    if (!t->me) settings_put(t, &o, p);
    comm_spread(t, &o);
    if (t->me) settings_take(t, &o, p);
    parcel_free(&o);
}

/* Is an array one of numbers, which all ranks may have? */
static bool is_copied(const struct part *a)
{
    return !(a->traits & PART_AGAIN) && a->how != PART_ONE_TEXT;
}

void settings_spread_all(struct comm *t, struct packing *p)
{
    struct parcel o = { 0 };
    if (!t->me) {
        parcel_put(t, &o, p, sizeof *p); // with pointers, of which no other rank makes use
        put_shapes(t, &o, &p->shapes);
        for (const struct part *a = packing_parts; a->name; a++)
            if (is_copied(a)) put_part(t, &o, a, p);
    }
    comm_spread(t, &o);
    if (t->me) {
        packing_free(p);
        parcel_take(t, &o, p, sizeof *p);
        packing_disown(p);
        settings_take_shapes(t, &o, &p->shapes, p->dim);
        for (const struct part *a = packing_parts; a->name; a++) {
            if (!is_copied(a)) continue;
            take_part(t, &o, a, p);
            if (a->room) memcpy((char *)p + a->room, (char *)p + a->count, sizeof(int64_t));
        }
    }
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
    const size_t pairs = (size_t)p->materials * (size_t)p->materials * sizeof *p->mu;
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
