/* bodies/packing.c: memory for a packing, and the check of its numbers. */
#include "bodies/packing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const overlap_name[OVERLAP_COUNT] = { "",     "keep",    "gap",
                                                  "push", "project", "gap-project" };
/* Boundaries that bodies may have: each body asks each, which takes up to 40 ns; for many bodies, and for few */
enum { BOUNDARIES_BODY = 4096, BOUNDARIES_LEAST = 1 << 26 };
enum { IMAGES_MOST = 1 << 30 }; /* so that sums and differences of images are numbers too */

static void *array(int64_t n, size_t size)
{
    return calloc(n > 0 ? (size_t)n : 1, size);
}

int packing_init(struct packing *p, int dim, int64_t n, struct why *why)
{
    *p = (struct packing){ .dim = dim, .n = n, .theta = 0.5, .cell = cell_none() };
    p->radius = array(n, sizeof *p->radius);
    p->mass = array(n, sizeof *p->mass);
    p->inertia = array(n, sizeof *p->inertia);
    p->id = array(n, sizeof *p->id);
    p->kind = array(n, sizeof *p->kind);
    p->x = array(n, sizeof *p->x);
    p->q = array(n, sizeof *p->q);
    p->v = array(n, sizeof *p->v);
    p->w = array(n, sizeof *p->w);
    bool allocated =
        p->radius && p->mass && p->inertia && p->id && p->kind && p->x && p->q && p->v && p->w;
    if (!allocated || packing_alloc_walls(p, 0, why) || packing_alloc_kinds(p, 1, why)) {
        packing_free(p);
        return why_set(why, EX_SOFTWARE, "no memory for %lld bodies", (long long)n);
    }
    for (int64_t i = 0; i < n; i++) p->id[i] = (int32_t)i, p->q[i].w = 1;
    return 0;
}

static void kinds_free(struct packing *p)
{
    for (int32_t k = 0; p->kind_name && k < p->kinds; k++) free(p->kind_name[k]);
    free(p->kind_name), free(p->mu), free(p->en), free(p->et), free(p->law);
    p->kind_name = NULL, p->mu = p->en = p->et = NULL, p->law = NULL, p->kinds = 0;
}

void packing_free(struct packing *p)
{
    free(p->radius), free(p->mass), free(p->inertia), free(p->id), free(p->kind);
    free(p->x), free(p->q), free(p->v), free(p->w);
    free(p->wall), free(p->scene), free(p->image), free(p->shape);
    shapes_free(&p->shapes);
    drives_free(&p->drives), drives_free(&p->pushes), mesh_free(&p->mesh);
    free(p->poured), free(p->removed);
    events_free(&p->events);
    bonds_free(&p->bonds);
    memory_free(&p->memory);
    outside_free(&p->outside);
    cell_free(&p->cell);
    kinds_free(p);
    memset(p, 0, sizeof *p);
}

int packing_alloc_walls(struct packing *p, int32_t k, struct why *why)
{
    free(p->wall);
    p->walls = k;
    p->wall = array(k, sizeof *p->wall);
    for (int32_t w = 0; p->wall && w < k; w++) p->wall[w].until = INFINITY;
    return p->wall ? 0 : why_set(why, EX_SOFTWARE, "no memory for %d walls", k);
}

int packing_alloc_kinds(struct packing *p, int32_t k, struct why *why)
{
    kinds_free(p);
    p->kind_name = array(k, sizeof *p->kind_name);
    p->mu = array((int64_t)k * k, sizeof *p->mu);
    p->en = array((int64_t)k * k, sizeof *p->en);
    p->et = array((int64_t)k * k, sizeof *p->et);
    bool allocated = p->kind_name && p->mu && p->en && p->et;
    for (p->kinds = 0; allocated && p->kinds < k; p->kinds++) {
        char name[16];
        snprintf(name, sizeof name, "%d", p->kinds);
        allocated = (p->kind_name[p->kinds] = strdup(name));
    }
    return allocated ? 0 : why_set(why, EX_SOFTWARE, "no memory for %d kinds", k);
}

int packing_alloc_laws(struct packing *p, struct why *why)
{
    free(p->law);
    p->law = array((int64_t)p->kinds * p->kinds, sizeof *p->law);
    return p->law ? 0 : why_set(why, EX_SOFTWARE, "no memory for %d kinds", p->kinds);
}

bool packing_rolls(const struct packing *p)
{
    for (int32_t k = 0; p->law && k < p->kinds * p->kinds; k++)
        if (law_rolls(&p->law[k])) return true;
    return false;
}

bool packing_may_gain(const struct packing *p)
{
    for (int32_t k = 0; k < p->kinds * p->kinds; k++)
        if (p->mu[k] > 0 && p->en[k] > 0) return true;
    return false;
}

bool packing_bounds(const struct packing *p, const struct contact *c)
{
    const int32_t k = packing_pair(p, c->a, c->b);
    const double law = p->law ? p->law[k].impact : IMPACT_DEFAULT;
    bool shaped = p->shape && (p->shape[c->b] > 0 || (c->a >= 0 && p->shape[c->a] > 0));
    return p->mu[k] > 0 && p->en[k] > 0 &&
           (law == IMPACT_BOUNDED || (law == IMPACT_DEFAULT && shaped));
}

int packing_alloc_passages(struct packing *p, int32_t pours, int32_t removals, struct why *why)
{
    free(p->poured), free(p->removed);
    p->poured = array(pours, sizeof *p->poured);
    p->removed = array(removals, sizeof *p->removed);
    p->pours = p->poured ? pours : 0, p->removals = p->removed ? removals : 0;
    return p->poured && p->removed ? 0 : why_set(why, EX_SOFTWARE, "no memory for passages");
}

/* The array that *at points to has n elements of `size` bytes, those from `had` on zero; false: it
   is as it was. */
static bool resize(void *at, int64_t had, int64_t n, size_t size)
{
    void *old;
    memcpy(&old, at, sizeof old);
    char *more = realloc(old, (n > 0 ? (size_t)n : 1) * size);
    if (!more) return false;
    if (n > had) memset(more + (size_t)had * size, 0, (size_t)(n - had) * size);
    memcpy(at, &more, sizeof more);
    return true; // cppcheck-suppress memleak ; it is *at now
}

int packing_resize(struct packing *p, int64_t n, struct why *why)
{
    int64_t had = p->n;
    if (!resize(&p->radius, had, n, sizeof *p->radius) ||
        !resize(&p->mass, had, n, sizeof *p->mass) ||
        !resize(&p->inertia, had, n, sizeof *p->inertia) ||
        !resize(&p->id, had, n, sizeof *p->id) || !resize(&p->kind, had, n, sizeof *p->kind) ||
        !resize(&p->x, had, n, sizeof *p->x) || !resize(&p->q, had, n, sizeof *p->q) ||
        !resize(&p->v, had, n, sizeof *p->v) || !resize(&p->w, had, n, sizeof *p->w))
        return why_set(why, EX_SOFTWARE, "no memory for %lld bodies", (long long)n);
    if (p->shape && !resize(&p->shape, had, n, sizeof *p->shape))
        return why_set(why, EX_SOFTWARE, "no memory for %lld bodies", (long long)n);
    if (outside_resize(&p->outside, had, n, why)) return why->status;
    for (int64_t i = had; i < n; i++) p->id[i] = -1, p->q[i].w = 1;
    p->n = n;
    return 0;
}

int packing_alloc_images(struct packing *p, struct why *why)
{
    free(p->image);
    p->image = array(p->n, sizeof *p->image);
    return p->image ? 0 : why_set(why, EX_SOFTWARE, "no memory for the images");
}

int packing_alloc_shapes(struct packing *p, struct why *why)
{
    free(p->shape);
    p->shape = array(p->n, sizeof *p->shape);
    return p->shape ? 0 : why_set(why, EX_SOFTWARE, "no memory for the shapes");
}

int packing_copy(struct packing *to, const struct packing *p, struct why *why)
{
    if (packing_init(to, p->dim, p->n, why)) return why->status;
    if (packing_alloc_walls(to, p->walls, why) || packing_alloc_kinds(to, p->kinds, why)) goto fail;
    size_t n = (size_t)p->n, k2 = (size_t)p->kinds * (size_t)p->kinds;
    to->step = p->step, to->t = p->t, to->dt = p->dt, to->theta = p->theta, to->g = p->g;
    to->t0 = p->t0, to->step0 = p->step0, to->adapts = p->adapts, to->halved = p->halved;
    to->overlap = p->overlap;
    to->seed = p->seed;
    if (cell_copy(&to->cell, &p->cell) || (p->image && packing_alloc_images(to, why))) goto fail;
    if (p->image) memcpy(to->image, p->image, n * sizeof *p->image);
    if (shapes_copy(&to->shapes, &p->shapes, why) || (p->shape && packing_alloc_shapes(to, why)))
        goto fail;
    if (p->shape) memcpy(to->shape, p->shape, n * sizeof *p->shape);
    memcpy(to->radius, p->radius, n * sizeof *p->radius);
    memcpy(to->mass, p->mass, n * sizeof *p->mass);
    memcpy(to->inertia, p->inertia, n * sizeof *p->inertia);
    memcpy(to->id, p->id, n * sizeof *p->id);
    memcpy(to->kind, p->kind, n * sizeof *p->kind);
    memcpy(to->x, p->x, n * sizeof *p->x);
    memcpy(to->q, p->q, n * sizeof *p->q);
    memcpy(to->v, p->v, n * sizeof *p->v);
    memcpy(to->w, p->w, n * sizeof *p->w);
    memcpy(to->wall, p->wall, (size_t)p->walls * sizeof *p->wall);
    if (drives_copy(&to->drives, &p->drives, why) || drives_copy(&to->pushes, &p->pushes, why) ||
        mesh_copy(&to->mesh, &p->mesh, why))
        goto fail;
    memcpy(to->mu, p->mu, k2 * sizeof *p->mu);
    memcpy(to->en, p->en, k2 * sizeof *p->en);
    memcpy(to->et, p->et, k2 * sizeof *p->et);
    if (p->law && packing_alloc_laws(to, why)) goto fail;
    if (p->law) memcpy(to->law, p->law, k2 * sizeof *p->law);
    if (bonds_copy(&to->bonds, &p->bonds, why) || memory_copy(&to->memory, &p->memory, why))
        goto fail;
    if (outside_copy(&to->outside, &p->outside, p->n, p->walls, why)) goto fail;
    for (int32_t i = 0; i < p->kinds; i++) {
        free(to->kind_name[i]);
        if (!(to->kind_name[i] = strdup(p->kind_name[i]))) goto fail;
    }
    if (p->scene && !(to->scene = strdup(p->scene))) goto fail;
    if (packing_alloc_passages(to, p->pours, p->removals, why)) goto fail;
    to->first_id = p->first_id;
    for (int32_t k = 0; k < p->pours; k++) to->poured[k] = p->poured[k];
    for (int32_t k = 0; k < p->removals; k++) to->removed[k] = p->removed[k];
    for (int64_t i = 0; i < p->events.n; i++)
        if (events_add(&to->events, &p->events.e[i], why)) goto fail;
    return 0;
fail:
    packing_free(to);
    return why_set(why, EX_SOFTWARE, "no memory for a copy of the packing");
}

void packing_count_from(struct packing *p, double t0, int64_t step0)
{
    p->t0 = t0, p->step0 = step0;
    if (packing_time(p, p->step) != p->t) p->t0 = p->t, p->step0 = p->step;
}

/* Is the step n steps before this one exact as a double? */
static bool packing_step_fits(int64_t step, double n)
{
    return fabs((double)step - n) <= (double)((int64_t)1 << STEPS_LOG2);
}

void packing_set_dt(struct packing *p, double dt)
{
    double n = nearbyint((p->t - p->t0) / dt);
    p->dt = dt;
    if (fabs(n) < (double)((int64_t)1 << STEPS_LOG2) && packing_step_fits(p->step, n))
        p->step0 = p->step - (int64_t)n;
    packing_count_from(p, p->t0, p->step0);
}

int packing_check_clock(const struct packing *p, struct why *why)
{
    double t = fmax(fabs(p->t), fabs(packing_next_time(p)));
    double grain = nextafter(t, INFINITY) - t;
    if (grain <= p->dt) return 0;
    return why_set(
        why, EX_DATAERR,
        "dt = %g s does not change a time of %g s, where numbers are %.2g s apart: begin "
        "at an earlier time, or with a longer dt",
        p->dt, p->t, grain);
}

double packing_mean_mass(const struct packing *p)
{
    double sum = 0;
    int64_t n = 0;
    for (int64_t i = 0; i < p->n; i++) sum += p->mass[i], n += p->mass[i] > 0;
    return n ? sum / (double)n : 1;
}

struct whole packing_whole(const struct packing *p)
{
    if (p->whole) return *p->whole;
    struct whole all = { .small = INFINITY, .apart = -INFINITY };
    for (int64_t i = 0; i < p->n; i++) {
        double speed = v3_norm(p->v[i]);
        all.speed = fmax(all.speed, speed);
        all.top_speed = fmax(all.top_speed, speed + p->radius[i] * v3_norm(p->w[i]));
        all.small = fmin(all.small, p->radius[i]), all.large = fmax(all.large, p->radius[i]);
    }
    for (int64_t i = 0; i < p->bonds.n; i++)
        if (p->bonds.bond[i].beta > 0 && !bond_anchored(&p->bonds.bond[i]))
            all.apart = fmax(all.apart, p->bonds.bond[i].gap);
    return all;
}

static const char *body_trouble(const struct packing *p, int64_t i)
{
    if (!(p->radius[i] > 0 && isfinite(p->radius[i]))) return "radius must be positive and finite";
    if (!(p->mass[i] >= 0 && isfinite(p->mass[i]))) return "mass must be finite and not negative";
    if (!(p->inertia[i] >= 0 && isfinite(p->inertia[i])))
        return "inertia must be finite and not negative";
    if (p->mass[i] > 0 && !(p->inertia[i] > 0)) return "inertia must be positive where mass is";
    if (!v3_finite(p->x[i])) return "position is not finite";
    if (!v3_finite(p->v[i])) return "velocity is not finite";
    if (!v3_finite(p->w[i])) return "angular velocity is not finite";
    quat q = p->q[i];
    if (!(fabs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1) < 1e-6))
        return "orientation is not a unit quaternion";
    if (p->dim == 2 && (p->x[i].z != 0 || p->v[i].z != 0 || p->w[i].x != 0 || p->w[i].y != 0))
        return "leaves the plane z = 0, and dim is 2";
    if (p->shape && (p->shape[i] < 0 || p->shape[i] >= p->shapes.n)) return "has no such shape";
    if (p->dim == 2 && packing_shape(p, i) && (q.x != 0 || q.y != 0))
        return "turns out of the plane, and dim is 2";
    if (p->kind[i] < 0 || p->kind[i] >= p->kinds) return "kind has no material";
    return NULL;
}

static const char *load_trouble(const struct packing *p, const struct wall *w)
{
    const struct load *l = &w->load;
    if (l->way == LOAD_NONE) return NULL;
    if (l->way < 0 || l->way >= LOAD_WAYS) return "its load neither glides nor turns";
    if (!(l->mass > 0 && isfinite(l->mass))) return "the mass of its load must be positive";
    if (!isfinite(l->force) || !isfinite(l->speed) || !isfinite(l->travel) || !v3_finite(l->point))
        return "its load is not finite";
    if (!(fabs(v3_dot(l->axis, l->axis) - 1) < 1e-6)) return "its load's axis is not a unit vector";
    bool turns = l->way == LOAD_TURNS;
    bool leaves = turns ? l->axis.x != 0 || l->axis.y != 0 : l->axis.z != 0;
    if (p->dim == 2 && (leaves || l->point.z != 0))
        return "its load leaves the plane, and dim is 2";
    if (turns && w->shape == BOUNDARY_PLANE && !(v3_norm(v3_cross(l->axis, w->n)) < 1e-6))
        return "it turns about another axis than its normal";
    return NULL;
}

static const char *wall_trouble(const struct packing *p, const struct wall *w)
{
    const char *trouble = boundary_trouble(w, p->dim);
    if (trouble) return trouble;
    bool mesh = w->shape == BOUNDARY_MESH;
    if (mesh && (w->first_element < 0 || w->first_element > p->mesh.elements ||
                 w->elements > p->mesh.elements - w->first_element))
        return "its mesh is not there";
    if (w->kind < 0 || w->kind >= p->kinds) return "kind has no material";
    return load_trouble(p, w);
}

/* Is the wall the same after a shift by this edge? */
static bool repeats_along(const struct packing *p, const struct wall *w, vec3 edge)
{
    double tiny = 1e-9 * v3_norm(edge);
    for (int32_t k = w->first_drive; k < w->first_drive + w->drives; k++)
        if (p->drives.drive[k].turns && w->shape == BOUNDARY_PLANE) return false;
    if (w->shape == BOUNDARY_PLANE) return fabs(v3_dot(edge, w->n)) <= tiny;
    if (w->shape != BOUNDARY_CYLINDER || w->size[2] > 0) return false;
    return v3_norm(v3_cross(edge, w->n)) <= tiny;
}

static int check_images(const struct packing *p, int64_t first, struct why *why)
{
    for (int64_t i = 0; p->image && i < p->n; i++)
        for (int k = 0; k < 3; k++)
            if (p->image[i][k] < -IMAGES_MOST || p->image[i][k] > IMAGES_MOST)
                return why_set(why, EX_DATAERR, "body %lld: image is out of range",
                               (long long)(first + i));
    return 0;
}

/* The cell, which the largest body must fit into, and the images. */
static int check_cell(const struct packing *p, struct why *why)
{
    double most = 0;
    for (int64_t i = 0; cell_repeats(&p->cell) && i < p->n; i++) most = fmax(most, p->radius[i]);
    if (cell_check(&p->cell, p->dim, 2 * most, why)) return why->status;
    if (cell_repeats(&p->cell) != (p->image != NULL))
        return why_set(why, EX_DATAERR, "images without a cell that repeats, or the reverse");
    if (check_images(p, 0, why)) return why->status;
    for (int32_t i = 0; cell_repeats(&p->cell) && i < p->walls; i++)
        for (int k = 0; k < 3; k++) {
            if (p->cell.repeats[k] && !repeats_along(p, &p->wall[i], p->cell.edge[k]))
                return why_set(why, EX_DATAERR, "wall %d: the cell repeats across it", i);
            if (p->cell.repeats[k] && cell_moves(&p->cell, k))
                return why_set(why, EX_DATAERR,
                               "wall %d: the edges along it move, so that its bodies' images "
                               "would meet it at other speeds",
                               i);
        }
    return 0;
}

static int check_bodies(const struct packing *p, int64_t first, struct why *why)
{
    for (int64_t i = 0; i < p->n; i++) {
        const char *trouble = body_trouble(p, i);
        if (trouble)
            return why_set(why, EX_DATAERR, "body %lld: %s", (long long)(first + i), trouble);
    }
    return 0;
}

int packing_check_bodies(const struct packing *p, int64_t first, struct why *why)
{
    return check_bodies(p, first, why) || check_images(p, first, why) ? why->status : 0;
}

int packing_check(const struct packing *p, struct why *why)
{
    if (p->dim != 2 && p->dim != 3)
        return why_set(why, EX_DATAERR, "dim is %d, not 2 or 3", p->dim);
    if (!(p->dt > 0 && isfinite(p->dt))) return why_set(why, EX_DATAERR, "dt must be positive");
    if (!isfinite(p->t)) return why_set(why, EX_DATAERR, "time is not finite");
    if (!(p->theta >= 0 && p->theta <= 1))
        return why_set(why, EX_DATAERR, "theta must lie in [0, 1]");
    if (!v3_finite(p->g)) return why_set(why, EX_DATAERR, "gravity is not finite");
    if (outside_check(&p->outside, p->dim, p->n, p->walls, why)) return why->status;
    if (p->dim == 2 && p->g.z != 0)
        return why_set(why, EX_DATAERR, "gravity leaves the plane, and dim is 2");
    for (int32_t i = 0; i < p->kinds * p->kinds; i++) {
        const char *pair = "the material of kinds %s and %s: %s";
        const char *a = p->kind_name[i / p->kinds], *b = p->kind_name[i % p->kinds];
        if (!(p->mu[i] >= 0 && isfinite(p->mu[i])))
            return why_set(why, EX_DATAERR, pair, a, b, "mu must not be negative");
        if (!(p->en[i] >= 0 && p->en[i] <= 1 && p->et[i] >= 0 && p->et[i] <= 1))
            return why_set(why, EX_DATAERR, pair, a, b, "restitution must lie in [0, 1]");
        const char *trouble = p->law ? law_trouble(&p->law[i]) : NULL;
        if (trouble) return why_set(why, EX_DATAERR, pair, a, b, trouble);
    }
    if (check_bodies(p, 0, why)) return why->status;
    if (p->walls > BOUNDARIES_BODY && (p->walls - BOUNDARIES_BODY) * p->n > BOUNDARIES_LEAST)
        return why_set(
            why, EX_DATAERR,
            "%lld bodies and %d boundaries: more than %d for each body: make a mesh of them",
            (long long)p->n, p->walls, BOUNDARIES_BODY);
    for (int32_t i = 0; i < p->walls; i++) {
        const char *trouble = wall_trouble(p, &p->wall[i]);
        if (trouble) return why_set(why, EX_DATAERR, "wall %d: %s", i, trouble);
    }
    if (drives_check(&p->drives, p->walls, p->dim, "drive", why) ||
        drives_check(&p->pushes, p->walls, p->dim, "push", why))
        return why->status;
    for (int32_t i = 0; i < p->pushes.n; i++)
        if (!p->wall[p->pushes.drive[i].boundary].load.way)
            return why_set(why, EX_DATAERR, "push %d: its boundary yields to no load", i);
    if (mesh_check(&p->mesh, p->dim, why)) return why->status;
    if (bonds_check(&p->bonds, p->dim, p->n, p->walls, why)) return why->status;
    return check_cell(p, why);
}

struct cell_flow packing_flow(const struct packing *p)
{
    struct cell_flow f;
    vec3 half[3], gain[3];
    cell_predict(&p->cell, (1 - p->theta) * p->dt, half);
    cell_next_rate(&p->cell, p->t, p->dt, p->theta, gain);
    for (int k = 0; k < 3; k++) gain[k] = v3_sub(gain[k], p->cell.rate[k]);
    cell_flow_init(&f, &p->cell, half, gain);
    return f;
}

void packing_solid_shape(int dim, const struct shape *s, double radius, double density,
                         double *mass, double *inertia)
{
    const double *m = s->moment;
    double mean = dim == 2 ? m[2] : (m[0] + m[1] + m[2]) / 3;
    *mass = density * s->volume * (dim == 2 ? radius * radius : radius * radius * radius);
    *inertia = *mass * radius * radius * mean;
}

void packing_solid(int dim, double radius, double density, double *mass, double *inertia)
{
    double r2 = radius * radius;
    if (dim == 2) {
        *mass = density * M_PI * r2;
        *inertia = 0.5 * *mass * r2;
        return;
    }
    *mass = density * 4.0 / 3 * M_PI * r2 * radius;
    *inertia = 0.4 * *mass * r2;
}
