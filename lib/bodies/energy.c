#include "bodies/energy.h"

#include "bodies/top.h"

struct energy energy_of(const struct packing *p)
{
    struct energy e = { 0 };
    for (int64_t i = 0; i < p->n; i++) {
        double v2 = v3_dot(p->v[i], p->v[i]);
        e.kinetic += 0.5 * (p->mass[i] * v2 + top_energy2(p, i, p->q[i], p->w[i]));
        e.potential -= p->mass[i] * v3_dot(p->g, p->x[i]);
        e.fastest = fmax(e.fastest, sqrt(v2));
    }
    return e;
}
