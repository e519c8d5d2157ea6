#include "measure/snapshot.h"

#include <math.h>
#include <stdlib.h>

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

int snapshot_layers(const struct snapshot *s, struct table *t, layer_function *add,
                    const void *with, struct why *why)
{
    const char *reason = NULL;
    int64_t n = s->asked->layers;
    int axis = snapshot_axis(s);
    struct region *layer = calloc((size_t)n + 1, sizeof *layer);
    if (!layer) return why_set(why, EX_SOFTWARE, "no memory for layers");
    if (axis == 3)
        region_shells(layer, n, &s->region, s->p, s->asked->point, &reason);
    else if (axis < s->p->dim)
        region_layers(layer, n, &s->region, s->p, axis, &reason);
    else
        reason = "in the plane there are no layers along z";
    if (reason) table_null(t, "%s", reason);
    for (int64_t i = 0; !reason && i < n; i++) {
        double *at = table_row(t, why);
        if (!at) break;
        put(&at, axis == 3 ? layer[i].inner : layer[i].lo[axis]);
        put(&at, axis == 3 ? layer[i].outer : layer[i].hi[axis]);
        add(t, s, &layer[i], at, with);
    }
    free(layer);
    return why->status;
}
