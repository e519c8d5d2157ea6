#include "measure/snapshot.h"

#include "measure/near.h"
#include "measure/region.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct tensor of_columns(const vec3 e[3])
{
    return (struct tensor){
        { { e[0].x, e[1].x, e[2].x }, { e[0].y, e[1].y, e[2].y }, { e[0].z, e[1].z, e[2].z } }
    };
}

static struct tensor snapshot_times(const struct tensor *A, const struct tensor *B)
{
    struct tensor C;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            C.x[i][j] = A->x[i][0] * B->x[0][j] + A->x[i][1] * B->x[1][j] + A->x[i][2] * B->x[2][j];
    return C;
}

static struct tensor inverse_of(const struct tensor *A)
{
    vec3 column[3], row[3];
    for (int k = 0; k < 3; k++) column[k] = v3(A->x[0][k], A->x[1][k], A->x[2][k]);
    cell_inverse(column, row);
    return (struct tensor){ { { row[0].x, row[0].y, row[0].z },
                              { row[1].x, row[1].y, row[1].z },
                              { row[2].x, row[2].y, row[2].z } } };
}

static double determinant(const struct tensor *A)
{
    const vec3 row[3] = { v3(A->x[0][0], A->x[0][1], A->x[0][2]),
                          v3(A->x[1][0], A->x[1][1], A->x[1][2]),
                          v3(A->x[2][0], A->x[2][1], A->x[2][2]) };
    return v3_dot(row[0], v3_cross(row[1], row[2]));
}

/* 1 + s L, L the velocity gradient of the edges' rates */
static struct tensor snapshot_grown(const struct deformed *d, double s)
{
    const struct tensor E = of_columns(d->span), V = of_columns(d->rate), I = inverse_of(&E);
    struct tensor G = snapshot_times(&V, &I);
    tensor_scale(&G, s);
    for (int k = 0; k < 3; k++) G.x[k][k] += 1;
    return G;
}

/* Where everything is now */
static void snapshot_look(struct deformed *d, const struct packing *p)
{
    struct region all;
    region_whole(&all, p);
    for (int k = 0; k < 3; k++) {
        double far = k < p->dim && p->n ? all.hi[k] - all.lo[k] : 1;
        vec3 along = v3((k == 0) * far, (k == 1) * far, (k == 2) * far);
        d->span[k] = p->cell.repeats[k] ? p->cell.edge[k] : along;
        d->rate[k] = p->cell.repeats[k] ? p->cell.rate[k] : v3(0, 0, 0);
    }
    d->t = p->t;
}

/* The whole numbers by which the edges of `now` differ from those of `then` deformed; false: no such */
static bool recut(const struct deformed *then, const struct deformed *now, struct tensor *N)
{
    double half = (now->t - then->t) / 2;
    struct tensor ahead = snapshot_grown(then, half), back = snapshot_grown(now, -half),
                  E = of_columns(then->span);
    struct tensor to = of_columns(now->span), from = snapshot_times(&ahead, &E);
    // the rates say how far the edges have gone by half a span of time from either end
    to = snapshot_times(&back, &to);
    from = inverse_of(&from);
    *N = snapshot_times(&from, &to);
    for (int k = 0; k < 9; k++) N->x[k / 3][k % 3] = rint(N->x[k / 3][k % 3]);
    return fabs(determinant(N)) == 1;
}

void deformed_follow(struct deformed *d, const struct packing *p)
{
    struct deformed now = { .known = true };
    struct tensor N;
    snapshot_look(&now, p);
    now.lost = d->lost;
    if (!d->known) {
        now.F = (struct tensor){ { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
    } else if (!recut(d, &now, &N)) {
        now.lost = true, now.F = d->F;
    } else {
        struct tensor E = of_columns(d->span), EN = snapshot_times(&E, &N),
                      to = of_columns(now.span);
        EN = inverse_of(&EN);
        struct tensor step = snapshot_times(&to, &EN);
        now.F = snapshot_times(&step, &d->F);
    }
    *d = now;
}

static int snapshot_by_id(const void *a, const void *b)
{
    const struct frame_memory_body *one = a, *other = b;
    return one->id < other->id ? -1 : one->id > other->id;
}

int frame_memory_set(struct frame_memory *k, const struct packing *p, struct failure *failure)
{
    struct frame_memory_body *body = realloc(k->body, ((size_t)p->n + 1) * sizeof *body);
    if (!body) return failure_set(failure, EX_SOFTWARE, "no memory to remember a frame");
    deformed_follow(&k->form, p);
    k->body = body, k->n = p->n, k->step = p->step, k->t = p->t;
    bool sorted = true;
    for (int64_t i = 0; i < p->n; i++) {
        body[i] = (struct frame_memory_body){ p->id[i], p->mass[i], frame_memory_place(p, i),
                                              NAN,      false,      false };
        sorted = sorted && (!i || body[i - 1].id < body[i].id);
    }
    sums_free(&k->sums);
    if (sums_copy(&k->sums, &p->sums, failure)) return failure->status;
    if (!sorted) qsort(body, (size_t)p->n, sizeof *body, snapshot_by_id);
    return 0;
}

void frame_memory_free(struct frame_memory *k)
{
    free(k->body), free(k->pair), free(k->cover);
    sums_free(&k->sums);
    *k = (struct frame_memory){ 0 };
}

const struct frame_memory_body *frame_memory_find(const struct frame_memory *k, int32_t id)
{
    const struct frame_memory_body wanted = { .id = id };
    return bsearch(&wanted, k->body, (size_t)k->n, sizeof wanted, snapshot_by_id);
}

int frame_memory_pair_order(const void *a, const void *b)
{
    const struct frame_memory_pair *x = a, *y = b;
    if (x->a != y->a) return x->a < y->a ? -1 : 1;
    return x->b < y->b ? -1 : x->b > y->b;
}

const struct frame_memory_pair *frame_memory_pair_find(const struct frame_memory *k,
                                                       const struct frame_memory_pair *pair)
{
    if (!k || !k->pair) return NULL;
    return bsearch(pair, k->pair, (size_t)k->pairs, sizeof *pair, frame_memory_pair_order);
}

vec3 frame_memory_place(const struct packing *p, int64_t i)
{
    vec3 x = p->x[i];
    for (int k = 0; p->image && k < 3; k++) x = v3_axpy(x, p->image[i][k], p->cell.edge[k]);
    return x;
}

vec3 frame_memory_way(const struct packing *p, vec3 from, vec3 to)
{
    struct period period;
    return period_shortest(period_of(&period, &p->cell), v3_sub(to, from));
}

/* Is --tracer a material of this document? Returns 0 or EX_DATAERR. */
static int check_tracer(const struct packing *p, const char *tracer, struct failure *failure)
{
    char materials[200];
    size_t at = 0;
    if (!*tracer || !strcmp(tracer, "large")) return 0;
    for (int32_t k = 0; k < p->materials; k++) {
        if (!strcmp(tracer, p->material_name[k])) return 0;
        if (at < sizeof materials)
            at += (size_t)snprintf(materials + at, sizeof materials - at, ", %s",
                                   p->material_name[k]);
    }
    return failure_set(failure, EX_DATAERR, "--tracer: no material '%s' here, but large%s%s",
                       tracer, materials, at < sizeof materials ? "" : "...");
}

int snapshot_init(struct snapshot *s, const struct packing *p, const struct contacts *contacts,
                  bool moved, const struct asked *asked, struct failure *failure)
{
    *s = (struct snapshot){
        .p = p, .s = contacts, .moved = moved, .asked = asked, .unconverged = NAN
    };
    region_whole(&s->whole, p);
    s->region = s->whole;
    if (asked->boxed) region_box(&s->region, p, asked->lo, asked->hi);
    if (region_check_images(&s->region, p->n, 0, "--box: it holds", failure) ||
        check_tracer(p, asked->tracer, failure))
        return failure->status;
    return selection_init(&s->only, p, "--only", *asked->only ? asked->only : NULL, failure);
}

void snapshot_free(struct snapshot *s)
{
    selection_free(&s->only);
}

bool snapshot_body(const struct snapshot *s, int64_t i)
{
    return !s->only.bodies || selection_body(&s->only, s->p, i);
}

bool snapshot_wall(const struct snapshot *s, int32_t wall)
{
    return !s->only.walls || selection_wall(&s->only, s->p, wall);
}

bool snapshot_face(const struct snapshot *s, int32_t wall, int32_t face)
{
    return !s->only.walls || selection_face(&s->only, s->p, wall, face);
}

int snapshot_axis(const struct snapshot *s)
{
    const double g[3] = { fabs(s->p->g.x), fabs(s->p->g.y), fabs(s->p->g.z) };
    int axis = s->p->dim == 2 ? 1 : 2;
    if (s->asked->axis >= 0) return s->asked->axis;
    for (int k = 0; k < 3 && k < s->p->dim; k++)
        if (g[k] > g[axis]) axis = k;
    return axis;
}

int snapshot_layers(const struct snapshot *s, struct table *t, layer_function *add,
                    const void *with, struct failure *failure)
{
    const char *reason = NULL;
    int64_t n = s->asked->layers;
    int axis = snapshot_axis(s);
    struct region *layer = calloc((size_t)n + 1, sizeof *layer);
    if (!layer) return failure_set(failure, EX_SOFTWARE, "no memory for layers");
    if (axis == 3)
        region_shells(layer, n, &s->region, s->p, s->asked->point, &reason);
    else if (axis < s->p->dim)
        region_layers(layer, n, &s->region, s->p, axis, &reason);
    else
        reason = "in the plane there are no layers along z";
    if (reason) table_null(t, "%s", reason);
    for (int64_t i = 0; !reason && i < n; i++) {
        double *at = table_row(t, failure);
        if (!at) break;
        put(&at, axis == 3 ? layer[i].inner : layer[i].lo[axis]);
        put(&at, axis == 3 ? layer[i].outer : layer[i].hi[axis]);
        add(t, s, &layer[i], at, with);
    }
    free(layer);
    return failure->status;
}
