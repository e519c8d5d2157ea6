#include "state/servo_box.h"

double servo_box_mass(const struct packing *p)
{
    double mass = 0;
    for (int32_t w = 0; w < p->walls; w++)
        if (servo_box_has(&p->wall[w])) mass += p->wall[w].load.mass;
    return mass;
}

double servo_box_growth(const struct packing *p)
{
    for (int32_t w = 0; w < p->walls; w++)
        if (servo_box_has(&p->wall[w])) return p->wall[w].load.speed;
    return 0;
}

void servo_box_levers(const struct packing *p, double t, double *lever)
{
    for (int32_t w = 0; w < p->walls; w++)
        lever[w] = servo_box_has(&p->wall[w]) ? wall_lever(p, &p->wall[w], t) : 0;
}

double servo_box_force(const struct packing *p, const double *lever, double t)
{
    double force = 0;
    for (int32_t w = 0; w < p->walls; w++)
        if (servo_box_has(&p->wall[w]) && lever[w] != 0)
            force += lever[w] * wall_force(p, &p->wall[w], t);
    return force;
}

void servo_box_move(struct packing *p, const double *lever, double change, bool back)
{
    for (int32_t w = 0; w < p->walls; w++) {
        struct load *l = &p->wall[w].load;
        if (!servo_box_has(&p->wall[w])) continue;
        if (back) l->speed -= change;
        double way = lever[w] * (p->dt * (l->speed + l->rate) + step_after(p) * change);
        l->travel += back ? -way : way;
        if (!back) l->speed += change;
    }
}

void servo_box_displace(struct packing *p, const double *lever, double part)
{
    for (int32_t w = 0; w < p->walls; w++)
        if (servo_box_has(&p->wall[w])) p->wall[w].load.travel += part * lever[w];
}

int servo_box_check_growth(const struct packing *p, struct failure *failure)
{
    for (int32_t w = 0; w < p->walls; w++)
        if (servo_box_has(&p->wall[w]) && load_grows_too_fast(&p->wall[w].load, p->dt))
            return failure_set(
                failure, EX_DATAERR,
                "the room of the walls changes by %.2g of its size in step %lld, and a "
                "tenth is the most: take a smaller dt, a larger mass or slower rates",
                (p->wall[w].load.speed + p->wall[w].load.rate) * p->dt, (long long)p->step);
    return 0;
}
