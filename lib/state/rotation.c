#include "state/rotation.h"

/* q (D (q^-1 a)), D diagonal */
static vec3 apply_diagonal(quat q, vec3 d, vec3 a)
{
    vec3 b = quat_turn_back(q, a);
    return quat_turn(q, v3(d.x * b.x, d.y * b.y, d.z * b.z));
}

vec3 rotation_momentum(const struct packing *p, int64_t i, quat q, vec3 w)
{
    if (!rotation_is(p, i)) return v3_scale(p->inertia[i], w);
    return apply_diagonal(q, rotation_moments(p, i), w);
}

vec3 rotation_spin(const struct packing *p, int64_t i, quat q, vec3 L)
{
    if (!rotation_is(p, i)) return v3_scale(1 / p->inertia[i], L);
    vec3 m = rotation_moments(p, i);
    return apply_diagonal(q, v3(1 / m.x, 1 / m.y, 1 / m.z), L);
}

vec3 rotation_root(const struct packing *p, int64_t i, quat q, vec3 a)
{
    vec3 m = rotation_moments(p, i);
    if (!rotation_is(p, i)) return v3_scale(sqrt(m.x), a);
    return apply_diagonal(q, v3(sqrt(m.x), sqrt(m.y), sqrt(m.z)), a);
}

vec3 rotation_inverse_root(const struct packing *p, int64_t i, quat q, vec3 a)
{
    vec3 m = rotation_moments(p, i);
    if (!rotation_is(p, i)) return v3_scale(1 / sqrt(m.x), a);
    return apply_diagonal(q, v3(1 / sqrt(m.x), 1 / sqrt(m.y), 1 / sqrt(m.z)), a);
}

/* About axis k of the body, by the part (1/I_k - 1/I_m) of its motion */
static quat turn_about(quat q, vec3 L, int k, double rate, double dt)
{
    vec3 b = quat_turn_back(q, L), axis = v3(k == 0, k == 1, k == 2);
    return quat_mul(q, quat_rotation(v3_scale(dt * rate * v3_dot(axis, b), axis)));
}

quat rotation_turn(const struct packing *p, int64_t i, quat q, vec3 L, double dt)
{
    vec3 moments = rotation_moments(p, i);
    double m[3] = { moments.x, moments.y, moments.z };
    if (!rotation_is(p, i)) return quat_mul(quat_rotation(v3_scale(dt / m[0], L)), q);
    int middle = 0;
    for (int k = 0; k < 3; k++)
        if ((m[k] - m[(k + 1) % 3]) * (m[k] - m[(k + 2) % 3]) <= 0) middle = k;
    int a = (middle + 1) % 3, b = (middle + 2) % 3;
    double rate_a = 1 / m[a] - 1 / m[middle], rate_b = 1 / m[b] - 1 / m[middle];
    q = turn_about(q, L, a, rate_a, dt / 2);
    q = turn_about(q, L, b, rate_b, dt);
    q = turn_about(q, L, a, rate_a, dt / 2);
    return quat_unit(quat_mul(quat_rotation(v3_scale(dt / m[middle], L)), q));
}

quat rotation_predict(const struct packing *p, int64_t i)
{
    double ahead = step_ahead(p);
    if (rotation_is(p, i))
        return rotation_turn(p, i, p->q[i], rotation_momentum(p, i, p->q[i], p->w[i]), ahead);
    return quat_mul(quat_rotation(v3_scale(ahead, p->w[i])), p->q[i]);
}

vec3 rotation_predict_spin(const struct packing *p, int64_t i, quat predicted)
{
    if (!rotation_is(p, i)) return p->w[i];
    return rotation_spin(p, i, predicted, rotation_momentum(p, i, p->q[i], p->w[i]));
}

struct energy energy_of(const struct packing *p)
{
    struct energy e = { 0 };
    for (int64_t i = 0; i < p->n; i++) {
        double v2 = v3_dot(p->v[i], p->v[i]);
        e.kinetic += 0.5 * (p->mass[i] * v2 + rotation_energy2(p, i, p->q[i], p->w[i]));
        e.potential -= p->mass[i] * v3_dot(p->g, p->x[i]);
        e.fastest = fmax(e.fastest, sqrt(v2));
    }
    return e;
}

double energy_peculiar(const struct packing *p, const bool *own)
{
    double sum = 0;
    struct cell_flow flow;
    cell_flow_init(&flow, &p->cell, p->cell.edge, p->cell.rate);
    for (int64_t i = 0; i < p->n; i++) {
        double m = !own || own[i] ? p->mass[i] : 0;
        vec3 v = p->v[i];
        if (!(m > 0)) continue;
        if (flow.changes) v = v3_sub(v, cell_flow_gain(&flow, p->x[i]));
        sum += 0.5 * m * v3_dot(v, v);
    }
    return sum;
}

bool energy_has_peculiar(const struct packing *p)
{
    bool moves = false;
    for (int k = 0; k < 3; k++) moves = moves || (p->cell.repeats[k] && cell_moves(&p->cell, k));
    return moves;
}
