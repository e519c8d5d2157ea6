#include "scene/breaking.h"

#include "base/array.h"
#include "base/random.h"
#include "scene/grains.h"
#include "scene/inlet.h"
#include "shape/fracture.h"
#include "state/breakable.h"
#include "state/rotation.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    ATTEMPTS = 8
}; /* at a tessellation whose pieces are shapes; the first one is, but for rounding */

/* A fragment, as it is until its grain is gone */
struct fragment {
    vec3 x;
    quat q;
    double radius, mass, inertia;
    int32_t shape;
    int64_t of; /* which of the grains that break it is of */
};

/* What breaks in a step */
struct breaking {
    struct packing *p;
    gsl_rng *rng;
    struct fragment *fragment;
    int64_t n, room;
    int64_t grains; /* that break */
    int64_t next;   /* the id of the first fragment */
    int32_t *row;   /* [p->n] -1: it breaks; else 0 */
};

/* The mean moment of inertia of a shape of mass 1 and radius 1 */
static double breaking_moment(int dim, const struct shape *s)
{
    if (!s) return dim == 2 ? 0.5 : 0.4;
    return dim == 2 ? s->moment[2] : (s->moment[0] + s->moment[1] + s->moment[2]) / 3;
}

static int breaking_add(struct breaking *b, const struct fragment *f, struct failure *failure)
{
    if (!array_grow(&b->fragment, &b->room, b->n + 1, sizeof *b->fragment))
        return failure_set(failure, EX_SOFTWARE, "no memory for fragments");
    b->fragment[b->n++] = *f;
    return 0;
}

/* ---- into pieces ---- */

/* A sharp hull that a grain is cut as, and its volume without what is dust */
struct breaking_hull {
    const struct shape *shape;
    struct shape own; /* to be freed */
};

static int hull_of(struct breaking_hull *h, const struct packing *p, int64_t i,
                   struct failure *failure)
{
    struct solid_frame was;
    *h = (struct breaking_hull){ .shape = packing_shape(p, i) };
    if (h->shape) return 0;
    if (fracture_inscribe(&h->own, p->dim, failure)) return failure->status;
    if (!solid_settle(&h->own, p->dim, &was, failure)) shape_finish(&h->own, p->dim, failure);
    h->shape = &h->own;
    return failure->status;
}

/* Pieces that are shapes, and where they were in the hull; EX_DATAERR: none were found */
static int breaking_cut(struct breaking *b, const struct shape *hull, int64_t i, int n,
                        struct shape *piece, struct solid_frame *was, struct failure *failure)
{
    const struct packing *p = b->p;
    vec3 point[FRACTURE_MOST];
    for (uint64_t attempt = 0; attempt < ATTEMPTS; attempt++) {
        struct failure trouble = { 0 };
        counter_start(b->rng, p->seed, COUNTER_FRACTURE, (uint64_t)p->id[i], attempt, 0);
        fracture_draw(point, n, hull, p->dim, b->rng);
        if (!fracture_cut(piece, n, point, hull, p->dim, &trouble)) {
            for (int k = 0; k < n && !trouble.status; k++)
                if (!solid_settle(&piece[k], p->dim, &was[k], &trouble))
                    shape_finish(&piece[k], p->dim, &trouble);
            if (!trouble.status) return 0;
            fracture_free(piece, n);
        }
        if (trouble.status == EX_SOFTWARE)
            return failure_set(failure, EX_SOFTWARE, "%s", trouble.text);
    }
    return failure_set(failure, EX_DATAERR, "no tessellation whose pieces are shapes");
}

/* The fragment of a piece, whose shape the packing takes, unless it is dust: its mass */
static double take_piece(struct breaking *b, int64_t i, struct shape *piece,
                         const struct solid_frame *was, double unit_volume, struct failure *failure)
{
    struct packing *p = b->p;
    const double R = p->radius[i], size = pow(was->reach, p->dim);
    struct fragment f = { .x = v3_axpy(p->x[i], R, quat_turn(p->q[i], was->centre)),
                          .q = quat_unit(quat_mul(p->q[i], was->turn)),
                          .radius = R * was->reach,
                          .mass = p->mass[i] * (piece->volume * size / unit_volume),
                          .shape = p->shapes.n,
                          .of = b->grains };
    char name[32];
    f.inertia = f.mass * f.radius * f.radius * breaking_moment(p->dim, piece);
    if (breakage_diameter_of(p->dim, piece, f.radius) < p->breakage[p->material[i]].dust) {
        shape_free(piece);
        return f.mass;
    }
    snprintf(name, sizeof name, BREAKAGE_FRAGMENT, (int)(b->next + b->n));
    piece->name = strdup(name);
    if (!shapes_add(&p->shapes, p->dim, piece, failure)) breaking_add(b, &f, failure);
    return 0;
}

/* kg: the dust; below 0: the grain cannot break, and there is no failure */
static double into_pieces(struct breaking *b, int64_t i, struct failure *failure)
{
    struct packing *p = b->p;
    const int n = (int)p->breakage[p->material[i]].pieces;
    struct shape piece[FRACTURE_MOST];
    struct solid_frame was[FRACTURE_MOST];
    struct breaking_hull hull;
    struct failure trouble = { 0 };
    double dust = 0;
    const double ball = p->dim == 2 ? M_PI : 4 * M_PI / 3;
    if (p->shapes.n + n > SHAPES_MOST) return -1;
    if (hull_of(&hull, p, i, failure)) return shape_free(&hull.own), 0;
    const double volume = packing_shape(p, i) ? hull.shape->volume : ball;
    if (volume != hull.shape->volume) dust = p->mass[i] * (1 - hull.shape->volume / volume);
    if (breaking_cut(b, hull.shape, i, n, piece, was, &trouble)) {
        shape_free(&hull.own);
        if (trouble.status == EX_SOFTWARE) failure_set(failure, EX_SOFTWARE, "%s", trouble.text);
        return -1;
    }
    for (int k = 0; k < n; k++)
        if (failure->status)
            shape_free(&piece[k]);
        else
            dust += take_piece(b, i, &piece[k], &was[k], volume, failure);
    shape_free(&hull.own);
    return dust;
}

/* ---- into balls ---- */

static double into_balls(struct breaking *b, int64_t i, struct failure *failure)
{
    const struct packing *p = b->p;
    vec3 centre[FRACTURE_BALLS];
    const int n = fracture_balls(centre, p->dim);
    const double share = pow(1. / 3, p->dim), R = p->radius[i];
    counter_start(b->rng, p->seed, COUNTER_FRACTURE, (uint64_t)p->id[i], 0, 0);
    const quat q = quat_draw(p->dim, b->rng);
    struct fragment f = {
        .q = p->q[i], .radius = R / 3, .mass = p->mass[i] * share, .of = b->grains
    };
    f.inertia = f.mass * f.radius * f.radius * breaking_moment(p->dim, NULL);
    if (2 * f.radius < p->breakage[p->material[i]].dust) return p->mass[i];
    for (int k = 0; k < n && !failure->status; k++) {
        f.x = v3_axpy(p->x[i], R, quat_turn(q, centre[k]));
        breaking_add(b, &f, failure);
    }
    return p->mass[i] * (1 - n * share);
}

/* ---- the account ---- */

/* J, N s: of a body, or of what is left of it */
struct breaking_motion {
    double kinetic, potential;
    vec3 momentum;
};

static void add_motion(struct breaking_motion *m, const struct packing *p, int64_t i, double sign)
{
    m->momentum = v3_axpy(m->momentum, sign * p->mass[i], p->v[i]);
    m->kinetic +=
        sign * 0.5 *
        (p->mass[i] * v3_dot(p->v[i], p->v[i]) + rotation_energy2(p, i, p->q[i], p->w[i]));
    m->potential -= sign * p->mass[i] * v3_dot(p->g, p->x[i]);
}

static void add_dust(struct broken *k, const struct breaking_motion *m)
{
    k->momentum[0] += m->momentum.x, k->momentum[1] += m->momentum.y,
        k->momentum[2] += m->momentum.z;
    k->kinetic += m->kinetic, k->potential += m->potential;
    k->taken += m->kinetic + m->potential;
}

/* ---- the step ---- */

/* Body i breaks, or waits. */
static void break_grain(struct breaking *b, int64_t i, struct failure *failure)
{
    const struct packing *p = b->p;
    struct broken *k = &p->broken[p->material[i]];
    const int64_t had = b->n;
    const double dust = p->breakage[p->material[i]].into == INTO_BALLS ? into_balls(b, i, failure)
                                                                       : into_pieces(b, i, failure);
    if (failure->status) return;
    if (dust < 0) {
        k->waiting++;
        return;
    }
    b->row[i] = -1, b->grains++;
    k->grains++, k->fragments += b->n - had, k->dust += dust;
    if (!p->generation[i]) k->originals++, k->mass += p->mass[i];
}

/* Fragment f becomes body `to`; was: the grains that have broken. */
static void set_fragment(struct packing *p, int64_t to, const struct fragment *f,
                         const struct packing *was, int64_t id)
{
    const int64_t i = f->of;
    packing_copy_body(p, to, was, i);
    p->x[to] = f->x, p->q[to] = f->q;
    p->v[to] = v3_add(was->v[i], v3_cross(was->w[i], v3_sub(f->x, was->x[i])));
    p->radius[to] = f->radius, p->mass[to] = f->mass, p->inertia[to] = f->inertia;
    if (p->shape) p->shape[to] = f->shape;
    p->parent[to] = was->id[i], p->generation[to] = was->generation[i] + 1;
    p->born[to] = p->t, p->damage[to] = 0, p->id[to] = (int32_t)id;
}

/* The grains that break, with the shapes that p has */
static int take_grains(struct packing *was, const struct breaking *b, struct failure *failure)
{
    const struct packing *p = b->p;
    int64_t k = 0;
    if (packing_init(was, p->dim, b->grains, failure)) return failure->status;
    if (packing_alloc_optional(was, packing_optional(p), failure)) {
        packing_free(was);
        return failure->status;
    }
    for (int64_t i = 0; i < p->n; i++)
        if (b->row[i] < 0) packing_copy_body(was, k++, p, i);
    was->g = p->g, was->shapes = p->shapes;
    return 0;
}

/* What the motion of the dust was: that of the grains less that of the fragments, from body `first` on */
static void account_for_dust(const struct breaking *b, const struct packing *was, int64_t first)
{
    int64_t k = 0;
    for (int64_t i = 0; i < b->grains; i++) {
        struct breaking_motion m = { 0 };
        add_motion(&m, was, i, 1);
        for (; k < b->n && b->fragment[k].of == i; k++) add_motion(&m, b->p, first + k, -1);
        add_dust(&b->p->broken[was->material[i]], &m);
    }
}

/* The grains that break are replaced by their fragments. */
static int replace(struct breaking *b, struct contacts *last, struct failure *failure)
{
    struct packing *p = b->p, was;
    int32_t kept = 0;
    if (take_grains(&was, b, failure)) return failure->status;
    for (int64_t i = 0; i < p->n; i++) b->row[i] = b->row[i] < 0 ? -1 : kept++;
    if (!flow_drop(p, last, b->row, failure)) packing_resize(p, kept + b->n, failure);
    for (int64_t k = 0; k < b->n && !failure->status; k++)
        set_fragment(p, kept + k, &b->fragment[k], &was, b->next + k);
    if (!failure->status) account_for_dust(b, &was, kept);
    p->first_id += (int32_t)b->n;
    was.shapes = (struct shapes){ 0 };
    packing_free(&was);
    return failure->status;
}

static bool any_due(const struct packing *p)
{
    for (int64_t i = 0; i < p->n; i++)
        if (p->damage[i] >= 1) return true;
    return false;
}

int breaking_step(struct packing *p, struct contacts *last, bool *changed, struct failure *failure)
{
    struct breaking b = { .p = p };
    if (!p->breakage) return 0;
    for (int32_t k = 0; k < p->materials; k++) p->broken[k].waiting = 0, p->broken[k].taken = 0;
    if (!any_due(p)) return 0;
    b.next = p->first_id;
    for (int32_t k = 0; k < p->pours; k++) b.next += p->poured[k].bodies;
    b.rng = counter_alloc(), b.row = calloc((size_t)p->n + 1, sizeof *b.row);
    if (!b.rng || !b.row) failure_set(failure, EX_SOFTWARE, "no memory for grains that break");
    for (int64_t i = 0; i < p->n && !failure->status; i++) {
        if (p->damage[i] < 1 || !breakage_of(p, i)) continue;
        if (b.grains < BREAKING_MOST)
            break_grain(&b, i, failure);
        else
            p->broken[p->material[i]].waiting++;
    }
    if (!failure->status && b.next + b.n >= INT32_MAX)
        failure_set(failure, EX_DATAERR, "more than %d bodies", INT32_MAX);
    if (!failure->status && b.grains && !replace(&b, last, failure)) *changed = true;
    free(b.fragment), free(b.row);
    if (b.rng) gsl_rng_free(b.rng);
    return failure->status;
}
