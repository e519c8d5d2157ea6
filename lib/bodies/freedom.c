/* bodies/freedom.c: the freedoms of a step, from loads and back [bodies/freedom.h]. */
#include "bodies/freedom.h"

#include <stdlib.h>

bool freedoms_in(const struct packing *p)
{
    for (int32_t w = 0; w < p->walls; w++)
        if (p->wall[w].load.way) return true;
    return false;
}

static struct freedom wall_freedom(const struct packing *p, int32_t w)
{
    const struct load *l = &p->wall[w].load;
    return (struct freedom){ .boundary = w,
                             .turns = l->way == LOAD_TURNS,
                             .axis = l->axis,
                             .point = l->point,
                             .mass = l->mass,
                             .force = l->force,
                             .speed = l->speed };
}

int freedoms_init(struct freedoms *list, const struct packing *p, struct why *why)
{
    *list = (struct freedoms){ .f = calloc((size_t)p->walls + 3, sizeof *list->f) };
    if (!list->f) return why_set(why, EX_SOFTWARE, "no memory for the loads");
    for (int32_t w = 0; w < p->walls; w++)
        if (p->wall[w].load.way) list->f[list->n++] = wall_freedom(p, w);
    return 0;
}

void freedoms_free(struct freedoms *list)
{
    free(list->f);
    *list = (struct freedoms){ 0 };
}

vec3 freedom_direction(const struct freedom *f, const struct contact *c)
{
    vec3 none = v3(0, 0, 0);
    if (f->boundary < 0) return c->shift[f->edge] ? v3_scale(c->shift[f->edge], f->axis) : none;
    if (c->a != -1 - f->boundary) return none;
    return v3_scale(-1, f->turns ? v3_cross(f->axis, v3_sub(c->x, f->point)) : f->axis);
}

static void wall_move(const struct packing *p, struct load *l, double change, bool back)
{
    double after = p->theta * p->dt * change;
    if (back) l->speed -= change;
    double way = p->dt * l->speed + after;
    l->travel += back ? -way : way;
    if (!back) l->speed += change;
}

static void edge_move(struct packing *p, const struct freedom *f, double change, bool back)
{
    double sign = back ? -1 : 1;
    vec3 *rate = &p->cell.rate[f->edge], *edge = &p->cell.edge[f->edge];
    *edge = v3_axpy(*edge, sign * p->theta * p->dt * change, f->axis);
    *rate = v3_axpy(*rate, sign * change, f->axis);
}

void freedom_move(const struct freedom *f, struct packing *p, double change, bool back)
{
    if (f->boundary < 0)
        edge_move(p, f, change, back);
    else
        wall_move(p, &p->wall[f->boundary].load, change, back);
}
