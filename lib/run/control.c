#include "run/control.h"

#include "state/servo_box.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void control_free(struct control *a)
{
    free(a->id);
    for (int t = 0; t < CONTROL_TERMS; t++) free(a->force[t]), free(a->torque[t]), free(a->push[t]);
    *a = (struct control){ 0 };
}

static int control_no_memory(struct failure *failure)
{
    return failure_set(failure, EX_SOFTWARE, "no memory for forces");
}

/* Arrays of n bodies, all zero; false: none, and nothing to free */
static bool control_make(struct control *a, int64_t n)
{
    size_t room = (size_t)n + 1;
    bool good = (a->id = calloc(room, sizeof *a->id));
    a->n = n;
    for (int t = 0; t < CONTROL_TERMS; t++) {
        a->force[t] = calloc(room, sizeof *a->force[t]);
        a->torque[t] = calloc(room, sizeof *a->torque[t]);
        good = good && a->force[t] && a->torque[t];
    }
    if (!good) control_free(a);
    return good;
}

static bool make_push(double **push, int32_t walls)
{
    if (!*push) *push = calloc((size_t)walls + 1, sizeof **push);
    return *push;
}

int control_copy(struct control *to, const struct control *from, int32_t walls,
                 struct failure *failure)
{
    size_t n = (size_t)from->n;
    *to = (struct control){ 0 };
    if (from->id && !control_make(to, from->n)) return control_no_memory(failure);
    if (from->id) memcpy(to->id, from->id, n * sizeof *to->id);
    for (int t = 0; t < CONTROL_TERMS; t++) {
        to->pushes[t] = from->pushes[t], to->twists[t] = from->twists[t];
        if (from->id) memcpy(to->force[t], from->force[t], n * sizeof *to->force[t]);
        if (from->id) memcpy(to->torque[t], from->torque[t], n * sizeof *to->torque[t]);
        if (!from->push[t]) continue;
        if (!make_push(&to->push[t], walls)) return control_free(to), control_no_memory(failure);
        memcpy(to->push[t], from->push[t], (size_t)walls * sizeof *to->push[t]);
    }
    return 0;
}

int64_t control_row(const struct packing *p, int32_t id)
{
    int64_t lo = 0, hi = p->n; // most packings have them in order, without a gap
    if (id >= 0 && id < p->n && p->id[id] == id) return id;
    while (lo < hi) {
        int64_t middle = lo + (hi - lo) / 2;
        *(p->id[middle] < id ? &lo : &hi) = p->id[middle] < id ? middle + 1 : middle;
    }
    if (lo < p->n && p->id[lo] == id) return lo;
    for (int64_t i = 0; i < p->n; i++) // a document may have them in any order
        if (p->id[i] == id) return i;
    return -1;
}

int control_arrays(struct control *a, const struct packing *p, struct failure *failure)
{
    struct control now = { 0 };
    if (a->id && a->n == p->n && !memcmp(a->id, p->id, (size_t)p->n * sizeof *p->id)) return 0;
    if (!control_make(&now, p->n)) return control_no_memory(failure);
    memcpy(now.id, p->id, (size_t)p->n * sizeof *p->id);
    for (int64_t j = 0; a->id && j < a->n; j++) {
        int64_t i = control_row(p, a->id[j]);
        for (int t = 0; t < CONTROL_TERMS && i >= 0; t++)
            now.force[t][i] = a->force[t][j], now.torque[t][i] = a->torque[t][j];
    }
    for (int t = 0; t < CONTROL_TERMS; t++) {
        now.push[t] = a->push[t], a->push[t] = NULL;
        now.pushes[t] = a->pushes[t], now.twists[t] = a->twists[t];
    }
    control_free(a);
    *a = now;
    return 0;
}

static bool any_number(const void *numbers, int64_t n)
{
    const double *x = numbers;
    for (int64_t i = 0; x && i < n; i++)
        if (x[i] != 0) return true;
    return false;
}

/* sum[n] = what lasts and what acts once; are all numbers finite? */
static bool add_both(vec3 *sum, const vec3 *lasting, const vec3 *once, int64_t n)
{
    double *s = (double *)sum;
    const double *x = (const double *)lasting, *y = (const double *)once;
    int bad = 0;
    for (int64_t i = 0; i < 3 * n; i++) { // a loop for vectors of the processor
        s[i] = x[i] + y[i];
        bad |= !(fabs(s[i]) <= DBL_MAX);
    }
    return !bad;
}

/* sum[n] = x, whose squares over those of mass[n] are at most *most^2; are all squares finite? In one pass: it costs what
   memory takes */
static bool control_copy_first(vec3 *sum, const vec3 *x, const double *mass, int64_t n,
                               double *most)
{
    int bad = 0;
    double most2 = 0;
    for (int64_t i = 0; i < n; i++) {
        double f2 = v3_dot(x[i], x[i]), m2 = mass[i] * mass[i];
        sum[i] = x[i];
        bad |= !(f2 <= DBL_MAX);
        if (m2 > 0 && f2 > most2 * m2) most2 = f2 / m2;
    }
    *most = sqrt(most2);
    return !bad;
}

/* What is known of a sum */
struct summed {
    bool finite; /* all numbers, or their squares, are */
    double most; /* as outside.most, had this mass; -1: not found */
};

/* *sum = the terms that may be other than 0, added; NULL: none is. */
static int sum_terms(vec3 **sum, vec3 *const term[CONTROL_TERMS], const bool may[CONTROL_TERMS],
                     const struct packing *p, struct summed *of, struct failure *failure)
{
    const int64_t n = p->n;
    bool is[CONTROL_TERMS];
    *of = (struct summed){ true, 0 };
    for (int t = 0; t < CONTROL_TERMS; t++) is[t] = may[t] && any_number(term[t], 3 * n);
    if (!is[CONTROL_LASTING] && !is[CONTROL_ONCE]) return free(*sum), *sum = NULL, 0;
    if (external_force_alloc(sum, n, failure)) return failure->status;
    const vec3 *x = term[is[CONTROL_LASTING] ? CONTROL_LASTING : CONTROL_ONCE],
               *y = term[CONTROL_ONCE];
    const bool both = is[CONTROL_LASTING] && is[CONTROL_ONCE];
    of->finite =
        both ? add_both(*sum, x, y, n) : control_copy_first(*sum, x, p->mass, n, &of->most);
    if (both) of->most = -1;
    return 0;
}

/* The sums of the bodies' forces, which are all to be finite */
static int sum_forces(const struct control *a, struct packing *p, struct failure *failure)
{
    struct external_force *o = &p->outside;
    struct summed force, torque;
    if (sum_terms(&o->force, a->force, a->pushes, p, &force, failure) ||
        sum_terms(&o->torque, a->torque, a->twists, p, &torque, failure))
        return failure->status;
    const bool good = force.finite && torque.finite;
    for (int64_t i = 0; i < p->n && (!good || p->dim == 2); i++) {
        vec3 f = o->force ? o->force[i] : v3(0, 0, 0), m = o->torque ? o->torque[i] : v3(0, 0, 0);
        if (!v3_finite(f) || !v3_finite(m))
            return failure_set(failure, EX_DATAERR, "the force or torque of body %d is not finite",
                               p->id[i]);
        if (p->dim == 2 && (f.z != 0 || m.x != 0 || m.y != 0))
            return failure_set(failure, EX_DATAERR,
                               "the force or torque of body %d leaves the plane, and dim is 2",
                               p->id[i]);
    }
    o->most = force.most;
    if (force.most < 0) external_force_measure(o, p->mass, p->n);
    return 0;
}

int control_begin(struct control *a, struct packing *p, struct failure *failure)
{
    struct external_force *o = &p->outside;
    bool pushes = a->push[CONTROL_LASTING] || a->push[CONTROL_ONCE];
    if (a->id && (control_arrays(a, p, failure) || sum_forces(a, p, failure)))
        return failure->status;
    if (pushes && external_force_alloc_push(o, p->walls, failure)) return failure->status;
    for (int32_t w = 0; pushes && w < p->walls; w++) {
        o->push[w] = 0;
        for (int t = 0; t < CONTROL_TERMS; t++) o->push[w] += a->push[t] ? a->push[t][w] : 0;
    }
    return 0;
}

int control_take(struct control *a, struct packing *p, struct failure *failure)
{
    struct lasting *s = &p->outside.lasts;
    const size_t n = (size_t)p->n;
    if ((s->force || s->torque) && control_arrays(a, p, failure)) return failure->status;
    if (s->force) memcpy(a->force[CONTROL_LASTING], s->force, n * sizeof *s->force);
    if (s->torque) memcpy(a->torque[CONTROL_LASTING], s->torque, n * sizeof *s->torque);
    a->pushes[CONTROL_LASTING] = s->force, a->twists[CONTROL_LASTING] = s->torque;
    free(a->push[CONTROL_LASTING]), free(s->force), free(s->torque);
    a->push[CONTROL_LASTING] = s->push;
    *s = (struct lasting){ 0 };
    return 0;
}

struct lasting control_lend(const struct control *a, int32_t walls)
{
    const int t = CONTROL_LASTING;
    return (struct lasting){
        .force = a->pushes[t] && any_number(a->force[t], 3 * a->n) ? a->force[t] : NULL,
        .torque = a->twists[t] && any_number(a->torque[t], 3 * a->n) ? a->torque[t] : NULL,
        .push = any_number(a->push[t], walls) ? a->push[t] : NULL
    };
}

static void zero(struct control *a, int term, int32_t walls)
{
    if (a->pushes[term]) memset(a->force[term], 0, (size_t)a->n * sizeof *a->force[term]);
    if (a->twists[term]) memset(a->torque[term], 0, (size_t)a->n * sizeof *a->torque[term]);
    if (a->push[term]) memset(a->push[term], 0, (size_t)walls * sizeof *a->push[term]);
}

void control_end(struct control *a, int32_t walls)
{
    zero(a, CONTROL_ONCE, walls);
}

void control_clear(struct control *a, int32_t walls)
{
    for (int t = 0; t < CONTROL_TERMS; t++) zero(a, t, walls);
}

bool control_any(const struct control *a)
{
    return a->id || a->push[CONTROL_LASTING] || a->push[CONTROL_ONCE];
}

int control_force(struct control *a, const struct packing *p, int32_t id, struct wrench w,
                  enum control_lasting term, struct failure *failure)
{
    const vec3 force = w.force, torque = w.torque;
    int64_t i = control_row(p, id);
    if (i < 0) return failure_set(failure, EX_DATAERR, "there is no body %d", id);
    if (!v3_finite(force) || !v3_finite(torque))
        return failure_set(failure, EX_DATAERR, "the force or torque of body %d is not finite", id);
    if (p->dim == 2 && (force.z != 0 || torque.x != 0 || torque.y != 0))
        return failure_set(failure, EX_DATAERR,
                           "the force or torque of body %d leaves the plane, and dim is 2", id);
    if (control_arrays(a, p, failure)) return failure->status;
    a->force[term][i] = force, a->torque[term][i] = torque;
    a->pushes[term] = true, a->twists[term] = a->twists[term] || v3_norm(torque) > 0;
    return 0;
}

/* The wall of that number, or NULL with the reason */
static struct wall *wall_of(const struct packing *p, int64_t wall, struct failure *failure)
{
    if (wall >= 0 && wall < p->walls) return &p->wall[wall];
    failure_set(failure, EX_DATAERR, "there is no wall %lld: walls are numbered from 0 to %d",
                (long long)wall, p->walls - 1);
    return NULL;
}

int control_push(struct control *a, const struct packing *p, int64_t wall, double force,
                 enum control_lasting term, struct failure *failure)
{
    const struct wall *w = wall_of(p, wall, failure);
    if (!w) return failure->status;
    if (w->load.way == LOAD_NONE || (w->load.way == LOAD_ROOM && !(servo_box_mass(p) > 0)))
        return failure_set(failure, EX_DATAERR,
                           "wall %lld is not load-controlled: give it a load in the scene",
                           (long long)wall);
    if (!isfinite(force))
        return failure_set(failure, EX_DATAERR, "the force of wall %lld is not finite",
                           (long long)wall);
    if (!make_push(&a->push[term], p->walls)) return control_no_memory(failure);
    a->push[term][wall] = force;
    return 0;
}

static bool is_across(vec3 v, vec3 axis)
{
    return v3_norm(v3_cross(v, axis)) > 1e-12 * v3_norm(v);
}

/* Does the wall rotate about an axis across v? A velocity along the axis commutes with the rotation. */
static bool turns_across(const struct packing *p, const struct wall *w, vec3 v)
{
    for (int32_t k = w->first_drive; k < w->first_drive + w->drives; k++)
        if (p->drives.drive[k].turns && is_across(v, p->drives.drive[k].axis)) return true;
    return w->load.way == LOAD_TURNS && is_across(v, w->load.axis);
}

int control_velocity(struct packing *p, int64_t wall, vec3 v, struct failure *failure)
{
    struct wall *w = wall_of(p, wall, failure);
    if (!w) return failure->status;
    if (!v3_finite(v) || (p->dim == 2 && v.z != 0))
        return failure_set(failure, EX_DATAERR, "the velocity of wall %lld is not finite%s",
                           (long long)wall, p->dim == 2 ? ", or leaves the plane" : "");
    if (turns_across(p, w, v))
        return failure_set(failure, EX_DATAERR,
                           "wall %lld rotates, so that its velocity has to be along its axis",
                           (long long)wall);
    struct wall was = *w;
    w->x = v3_axpy(w->x, p->t, v3_sub(w->v, v)); // x + v t is where it was
    w->v = v;
    const char *trouble = v3_finite(w->x) ? NULL : "would be beyond the range of numbers";
    for (int k = 0; k < 3 && !trouble; k++)
        if (!packing_wall_fits_edge(p, w, k, 0))
            trouble = "would move across a periodic edge of the cell";
    if (trouble) {
        *w = was;
        return failure_set(failure, EX_DATAERR, "wall %lld %s", (long long)wall, trouble);
    }
    p->outside.steered = true;
    return 0;
}

int control_motion(struct packing *p, int64_t i, bool turns, vec3 v, struct failure *failure)
{
    bool leaves = p->dim == 2 && (turns ? v.x != 0 || v.y != 0 : v.z != 0);
    if (!v3_finite(v) || leaves)
        return failure_set(failure, EX_DATAERR, "the %s of body %d %s",
                           turns ? "angular velocity" : "velocity", p->id[i],
                           leaves ? "leaves the plane, and dim is 2" : "is not finite");
    (turns ? p->w : p->v)[i] = v;
    return 0;
}

int control_gravity(struct packing *p, vec3 g, struct failure *failure)
{
    if (!v3_finite(g) || (p->dim == 2 && g.z != 0))
        return failure_set(failure, EX_DATAERR, "gravity is not finite%s",
                           p->dim == 2 ? ", or leaves the plane" : "");
    p->g = g;
    p->outside.steered = true;
    return 0;
}

static int32_t control_material_of(const struct packing *p, const char *name,
                                   struct failure *failure)
{
    for (int32_t k = 0; k < p->materials; k++)
        if (!strcmp(p->material_name[k], name)) return k;
    failure_set(failure, EX_DATAERR, "there is no material '%.100s'", name);
    return -1;
}

int control_friction(struct packing *p, const char *a, const char *b, double mu,
                     struct failure *failure)
{
    int32_t k = control_material_of(p, a, failure),
            l = k < 0 ? -1 : control_material_of(p, b, failure);
    if (l < 0) return failure->status;
    if (!(mu >= 0 && isfinite(mu)))
        return failure_set(failure, EX_DATAERR,
                           "a friction of %g is not a finite number of at least 0", mu);
    p->mu[k * p->materials + l] = p->mu[l * p->materials + k] = mu;
    p->outside.steered = true;
    return 0;
}
