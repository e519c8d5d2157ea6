/* bodies/packing.c: memory for a packing, and the check of its numbers. */
#include "bodies/packing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const overlap_name[OVERLAP_COUNT] = { "",     "keep",    "gap",
                                                  "push", "project", "gap-project" };
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
    free(p->kind_name), free(p->mu), free(p->en), free(p->et);
    p->kind_name = NULL, p->mu = p->en = p->et = NULL, p->kinds = 0;
}

void packing_free(struct packing *p)
{
    free(p->radius), free(p->mass), free(p->inertia), free(p->id), free(p->kind);
    free(p->x), free(p->q), free(p->v), free(p->w);
    free(p->wall), free(p->scene), free(p->image);
    free(p->poured), free(p->removed);
    events_free(&p->events);
    cell_free(&p->cell);
    kinds_free(p);
    memset(p, 0, sizeof *p);
}

int packing_alloc_walls(struct packing *p, int32_t k, struct why *why)
{
    free(p->wall);
    p->walls = k;
    p->wall = array(k, sizeof *p->wall);
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

int packing_copy(struct packing *to, const struct packing *p, struct why *why)
{
    if (packing_init(to, p->dim, p->n, why)) return why->status;
    if (packing_alloc_walls(to, p->walls, why) || packing_alloc_kinds(to, p->kinds, why)) goto fail;
    size_t n = (size_t)p->n, k2 = (size_t)p->kinds * (size_t)p->kinds;
    to->step = p->step, to->t = p->t, to->dt = p->dt, to->theta = p->theta, to->g = p->g;
    to->overlap = p->overlap;
    to->seed = p->seed;
    if (cell_copy(&to->cell, &p->cell) || (p->image && packing_alloc_images(to, why))) goto fail;
    if (p->image) memcpy(to->image, p->image, n * sizeof *p->image);
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
    memcpy(to->mu, p->mu, k2 * sizeof *p->mu);
    memcpy(to->en, p->en, k2 * sizeof *p->en);
    memcpy(to->et, p->et, k2 * sizeof *p->et);
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
    if (p->dim == 2 && (l->axis.z != 0 || l->point.z != 0 || l->way == LOAD_TURNS))
        return "its load leaves the plane, and dim is 2";
    if (l->way == LOAD_TURNS && !(v3_norm(v3_cross(l->axis, w->n)) < 1e-6))
        return "it turns about another axis than its normal";
    return NULL;
}

static const char *wall_trouble(const struct packing *p, const struct wall *w)
{
    if (!v3_finite(w->x) || !v3_finite(w->v)) return "point or velocity is not finite";
    if (!(fabs(v3_dot(w->n, w->n) - 1) < 1e-6)) return "normal is not a unit vector";
    if (p->dim == 2 && (w->n.z != 0 || w->v.z != 0)) return "leaves the plane, and dim is 2";
    if (w->kind < 0 || w->kind >= p->kinds) return "kind has no material";
    return load_trouble(p, w);
}

/* The cell, which the largest body must fit into, and the images. */
static int check_cell(const struct packing *p, struct why *why)
{
    double most = 0;
    for (int64_t i = 0; cell_repeats(&p->cell) && i < p->n; i++) most = fmax(most, p->radius[i]);
    if (cell_check(&p->cell, p->dim, 2 * most, why)) return why->status;
    if (cell_repeats(&p->cell) != (p->image != NULL))
        return why_set(why, EX_DATAERR, "images without a cell that repeats, or the reverse");
    for (int64_t i = 0; p->image && i < p->n; i++)
        for (int k = 0; k < 3; k++)
            if (p->image[i][k] < -IMAGES_MOST || p->image[i][k] > IMAGES_MOST)
                return why_set(why, EX_DATAERR, "body %lld: image is out of range", (long long)i);
    for (int32_t i = 0; cell_repeats(&p->cell) && i < p->walls; i++)
        for (int k = 0; k < 3; k++) {
            const vec3 e = p->cell.edge[k];
            if (p->cell.repeats[k] && !(fabs(v3_dot(e, p->wall[i].n)) <= 1e-9 * v3_norm(e)))
                return why_set(why, EX_DATAERR, "wall %d: the cell repeats across it", i);
            if (p->cell.repeats[k] && cell_moves(&p->cell, k))
                return why_set(why, EX_DATAERR,
                               "wall %d: the edges along it move, so that its bodies' images "
                               "would meet it at other speeds",
                               i);
        }
    return 0;
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
    if (p->dim == 2 && p->g.z != 0)
        return why_set(why, EX_DATAERR, "gravity leaves the plane, and dim is 2");
    for (int32_t i = 0; i < p->kinds * p->kinds; i++) {
        const char *pair = "the material of kinds %s and %s: %s";
        const char *a = p->kind_name[i / p->kinds], *b = p->kind_name[i % p->kinds];
        if (!(p->mu[i] >= 0 && isfinite(p->mu[i])))
            return why_set(why, EX_DATAERR, pair, a, b, "mu must not be negative");
        if (!(p->en[i] >= 0 && p->en[i] <= 1 && p->et[i] >= 0 && p->et[i] <= 1))
            return why_set(why, EX_DATAERR, pair, a, b, "restitution must lie in [0, 1]");
    }
    for (int64_t i = 0; i < p->n; i++) {
        const char *trouble = body_trouble(p, i);
        if (trouble) return why_set(why, EX_DATAERR, "body %lld: %s", (long long)i, trouble);
    }
    for (int32_t i = 0; i < p->walls; i++) {
        const char *trouble = wall_trouble(p, &p->wall[i]);
        if (trouble) return why_set(why, EX_DATAERR, "wall %d: %s", i, trouble);
    }
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
