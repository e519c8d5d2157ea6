#include "measure/snapshot.h"

#include <math.h>

void snapshot_init(struct snapshot *s, const struct packing *p, const struct contacts *contacts,
                   bool moved, const struct asked *asked)
{
    *s = (struct snapshot){ .p = p, .s = contacts, .moved = moved, .asked = asked };
    region_whole(&s->whole, p);
    s->region = s->whole;
    if (asked->boxed) region_box(&s->region, p, asked->lo, asked->hi);
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

bool snapshot_layers(const struct snapshot *s, struct region *layer, const char **reason)
{
    int axis = snapshot_axis(s);
    if (axis < 3 && axis >= s->p->dim) {
        *reason = "in the plane there are no layers along z";
        return false;
    }
    if (axis == 3)
        return region_shells(layer, s->asked->layers, &s->region, s->p, s->asked->point, reason);
    return region_layers(layer, s->asked->layers, &s->region, s->p, axis, reason);
}
