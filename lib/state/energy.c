#include "state/energy.h"

#include "state/top.h"

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
