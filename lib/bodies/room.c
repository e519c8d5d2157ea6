#include "bodies/room.h"

#include <math.h>

static const double GROWTH_MOST =
    0.1; /* of the size in a step: grains would be crushed long before */

double room_mass(const struct packing *p)
{
    double mass = 0;
    for (int32_t w = 0; w < p->walls; w++)
        if (room_has(&p->wall[w])) mass += p->wall[w].load.mass;
    return mass;
}

double room_growth(const struct packing *p)
{
    for (int32_t w = 0; w < p->walls; w++)
        if (room_has(&p->wall[w])) return p->wall[w].load.speed;
    return 0;
}

void room_levers(const struct packing *p, double t, double *lever)
{
    for (int32_t w = 0; w < p->walls; w++)
        lever[w] = room_has(&p->wall[w]) ? wall_lever(p, &p->wall[w], t) : 0;
}

double room_force(const struct packing *p, const double *lever, double t)
{
    double force = 0;
    for (int32_t w = 0; w < p->walls; w++)
        if (room_has(&p->wall[w]) && lever[w] != 0)
            force += lever[w] * wall_force(p, &p->wall[w], t);
    return force;
}

void room_move(struct packing *p, const double *lever, double change, bool back)
{
    for (int32_t w = 0; w < p->walls; w++) {
        struct load *l = &p->wall[w].load;
        if (!room_has(&p->wall[w])) continue;
        if (back) l->speed -= change;
        double way = lever[w] * (p->dt * (l->speed + l->rate) + step_after(p) * change);
        l->travel += back ? -way : way;
        if (!back) l->speed += change;
    }
}

void room_displace(struct packing *p, const double *lever, double part)
{
    for (int32_t w = 0; w < p->walls; w++)
        if (room_has(&p->wall[w])) p->wall[w].load.travel += part * lever[w];
}

/* Of one wall, beside the first of the room */
static const char *wall_trouble(const struct packing *p, const struct wall *w,
                                const struct load *first)
{
    const struct load *l = &w->load;
    if (l->speed != first->speed || l->point.x != first->point.x || l->point.y != first->point.y ||
        l->point.z != first->point.z)
        return "its room has another centre or growth than that of the walls before";
    if (v3_dot(l->axis, w->n) < 1 - 1e-9) return "its room is not on the side of its normal";
    if (w->until < INFINITY) return "it belongs to a room, and vanishes";
    for (int32_t k = w->first_drive; k < w->first_drive + w->drives; k++)
        if (p->drives.drive[k].turns) return "it belongs to a room, and turns";
    if (!(fabs(l->speed + l->rate) * p->dt < GROWTH_MOST))
        return "its room changes by more than a tenth in a step: take a smaller dt, a larger mass "
               "or slower rates";
    return NULL;
}

int room_check(const struct packing *p, struct why *why)
{
    const struct load *first = NULL;
    for (int32_t i = 0; i < p->walls; i++) {
        const struct wall *w = &p->wall[i];
        if (!room_has(w)) continue;
        if (!first) first = &w->load;
        const char *trouble = wall_trouble(p, w, first);
        if (trouble) return why_set(why, EX_DATAERR, "wall %d: %s", i, trouble);
    }
    if (first && first->speed != 0 && !(room_mass(p) > 0))
        return why_set(why, EX_DATAERR, "the room of the walls grows, and has no mass");
    return 0;
}
