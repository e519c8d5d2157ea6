/* state/freedom.c: the freedoms of a step, from loads and back [state/freedom.h]. */
#include "state/freedom.h"

#include "state/kinematics.h"
#include "state/servo_box.h"

#include <stdlib.h>

enum { EDGE = FREEDOM_EDGE, SIZE = FREEDOM_SIZE, ROOM = FREEDOM_ROOM };

bool freedoms_in(const struct packing *p)
{
    if (cell_yields(&p->cell)) return true;
    for (int32_t w = 0; w < p->walls; w++)
        if (p->wall[w].load.way) return true;
    return false;
}

/* s: of the step */
static double middle(const struct packing *p, bool ended)
{
    return ended ? p->t - p->dt / 2 : p->t + p->dt / 2;
}

/* t: the middle of the step, s */
static struct freedom wall_freedom(const struct packing *p, int32_t w, double t)
{
    const struct load *l = &p->wall[w].load;
    return (struct freedom){ .wall = w,
                             .turns = l->way == LOAD_TURNS,
                             .axis = l->axis,
                             .point = l->point,
                             .mass = l->mass,
                             .force = wall_force(p, &p->wall[w], t),
                             .speed = l->speed };
}

/* Component i of edge k, where the face across is area[k] */
static struct freedom edge_freedom(const struct packing *p, int k, int i, const vec3 inverse[3],
                                   const vec3 area[3], double t)
{
    const struct cell *c = &p->cell;
    const double *row = c->stress[i], rate[3] = { c->rate[k].x, c->rate[k].y, c->rate[k].z };
    struct freedom f = { .wall = EDGE,
                         .edge = k,
                         .inverse = inverse[k],
                         .axis = v3(i == 0, i == 1, i == 2),
                         .mass = c->mass[k][i],
                         .force = -v3_dot(v3(row[0], row[1], row[2]), area[k]),
                         .speed = rate[i] };
    if (c->factors) f.force *= cell_factor_at(c, t);
    f.gain[k] = f.axis;
    return f;
}

/* Loads of walls that each move by themselves */
static bool moves_alone(const struct wall *w)
{
    return w->load.way && !servo_box_has(w);
}

/* The size of the room with these levers */
static struct freedom room_freedom(const struct packing *p, const double *lever, double t)
{
    return (struct freedom){ .wall = ROOM,
                             .mass = servo_box_mass(p),
                             .force = servo_box_force(p, lever, t),
                             .speed = servo_box_growth(p),
                             .lever = lever };
}

/* Of the room where the contacts act; NULL: there is none, or *good is false */
static double *levers_of(const struct packing *p, bool ended, bool *good)
{
    bool any = false;
    *good = true;
    for (int32_t w = 0; w < p->walls; w++) any = any || servo_box_has(&p->wall[w]);
    if (!any) return NULL;
    double *lever = malloc((size_t)p->walls * sizeof *lever);
    if (!(*good = lever)) return NULL;
    servo_box_levers(p, p->t + (ended ? -step_after(p) : step_ahead(p)), lever);
    return lever;
}

/* m^3, of discs m^2 */
static double freedom_volume_of(const struct packing *p, const vec3 edge[3])
{
    double volume = v3_dot(edge[0], v3_cross(edge[1], edge[2]));
    if (p->dim == 2) volume /= v3_norm(edge[2]); // which only closes the cell
    return fabs(volume);
}

/* The size, where the edges are edge[] */
static struct freedom size_freedom(const struct packing *p, const vec3 edge[3], double t)
{
    const struct cell *c = &p->cell;
    struct freedom f = { .wall = SIZE, .mass = c->size_mass };
    f.force = -p->dim * freedom_volume_of(p, edge) * c->mean * cell_factor_at(c, t);
    f.speed = cell_growth(c, step_after(p));
    for (int k = 0; k < p->dim; k++) f.gain[k] = edge[k];
    return f;
}

/* m^2, of discs m: the faces across the edges, to the side that they go */
static void face_areas(const struct packing *p, const vec3 edge[3], const vec3 inverse[3],
                       vec3 area[3])
{
    double volume = freedom_volume_of(p, edge);
    for (int k = 0; k < 3; k++) area[k] = v3_scale(volume, inverse[k]);
}

int freedoms_init(struct freedoms *list, const struct packing *p, const vec3 half[3], bool ended,
                  struct failure *failure)
{
    const double t = middle(p, ended);
    *list = (struct freedoms){ 0 };
    if (!freedoms_in(p)) return 0;
    bool good;
    list->f = calloc((size_t)p->walls + 11, sizeof *list->f);
    list->lever = levers_of(p, ended, &good);
    if (!list->f || !good) {
        freedoms_free(list);
        return failure_set(failure, EX_SOFTWARE, "no memory for the loads");
    }
    for (int32_t w = 0; w < p->walls; w++)
        if (moves_alone(&p->wall[w])) list->f[list->n++] = wall_freedom(p, w, t);
    if (list->lever && servo_box_mass(p) > 0) list->f[list->n++] = room_freedom(p, list->lever, t);
    vec3 inverse[3], area[3];
    cell_inverse(half, inverse);
    face_areas(p, half, inverse, area);
    for (int k = 0; k < 9; k++)
        if (p->cell.mass[k / 3][k % 3] > 0)
            list->f[list->n++] = edge_freedom(p, k / 3, k % 3, inverse, area, t);
    if (p->cell.size_mass > 0) list->f[list->n++] = size_freedom(p, half, t);
    return 0;
}

/* m/s: the same of the wall of the room that is farthest from its centre */
static double fastest_of_room(const struct packing *p, bool had, double t)
{
    const double mass = servo_box_mass(p);
    double force = 0, farthest = 0;
    if (!(mass > 0)) return 0;
    for (int32_t w = 0; w < p->walls; w++) {
        if (!servo_box_has(&p->wall[w])) continue;
        double lever = wall_lever(p, &p->wall[w], p->t);
        force += lever * wall_force(p, &p->wall[w], t);
        farthest = dmax(farthest, fabs(lever));
    }
    return farthest * (had * fabs(servo_box_growth(p)) + p->dt * fabs(force) / mass);
}

/* m/s: |had speed| + dt |force|/mass, the most of all that glide */
static double freedom_fastest(const struct packing *p, bool had)
{
    const double t = middle(p, false);
    double most = 0;
    vec3 inverse[3], area[3];
    for (int32_t w = 0; w < p->walls; w++) {
        if (p->wall[w].load.way != LOAD_GLIDES) continue;
        struct freedom f = wall_freedom(p, w, t);
        most = dmax(most, had * fabs(f.speed) + p->dt * fabs(f.force) / f.mass);
    }
    most = dmax(most, fastest_of_room(p, had, t));
    if (!cell_yields(&p->cell)) return most;
    cell_inverse(p->cell.edge, inverse);
    face_areas(p, p->cell.edge, inverse, area);
    for (int k = 0; k < 9; k++) {
        if (!(p->cell.mass[k / 3][k % 3] > 0)) continue;
        struct freedom f = edge_freedom(p, k / 3, k % 3, inverse, area, t);
        most = dmax(most, had * fabs(f.speed) + p->dt * fabs(f.force) / f.mass);
    }
    if (!(p->cell.size_mass > 0)) return most;
    struct freedom f = size_freedom(p, p->cell.edge, t);
    for (int k = 0; k < p->dim; k++)
        most = dmax(most, v3_norm(p->cell.edge[k]) *
                              (had * fabs(f.speed) + p->dt * fabs(f.force) / f.mass));
    return most;
}

double freedoms_speed(const struct packing *p)
{
    return freedom_fastest(p, true);
}

double freedoms_calm(const struct packing *p)
{
    return 2 * (packing_most_fall(p) + freedom_fastest(p, false));
}

void freedoms_free(struct freedoms *list)
{
    free(list->f), free(list->lever);
    *list = (struct freedoms){ 0 };
}

/* Edges from the cell's origin to body i where contacts act; 0 of one that does not follow */
static double edges_to(const struct freedom *f, const struct packing *p, int32_t i, double ahead)
{
    if (i < 0 || !(p->mass[i] > 0)) return 0;
    return v3_dot(f->inverse, v3_sub(v3_axpy(p->x[i], ahead, p->v[i]), p->cell.origin));
}

/* Edges from a to b, as far as they follow: along the branch, if both do */
static double edges_between(const struct freedom *f, const struct packing *p,
                            const struct contact *c, double ahead, const vec3 edge[3])
{
    if (c->a >= 0 && p->mass[c->a] > 0 && p->mass[c->b] > 0) {
        struct arms o = arm_vectors(p, c, ahead, edge);
        return v3_dot(f->inverse, v3_sub(o.a, o.b));
    }
    return c->shift[f->edge] + edges_to(f, p, c->b, ahead) - edges_to(f, p, c->a, ahead);
}

/* m: the branch, as far as its ends follow the cell's size */
static vec3 branch_of(const struct packing *p, const struct contact *c, double ahead,
                      const vec3 edge[3])
{
    if (c->a >= 0 && p->mass[c->a] > 0 && p->mass[c->b] > 0) {
        struct arms o = arm_vectors(p, c, ahead, edge);
        return v3_sub(o.a, o.b);
    }
    vec3 d = cell_shift(edge, c->shift), origin = p->cell.origin;
    for (int end = 0; end < 2; end++) {
        int32_t i = end ? c->b : c->a;
        if (i < 0 || !(p->mass[i] > 0)) continue;
        vec3 x = v3_sub(v3_axpy(p->x[i], ahead, p->v[i]), origin);
        d = v3_axpy(d, end ? 1 : -1, x);
    }
    return d;
}

vec3 freedom_direction(const struct freedom *f, const struct packing *p, const struct contact *c,
                       double ahead, const vec3 edge[3])
{
    if (f->wall == SIZE) return branch_of(p, c, ahead, edge);
    if (f->wall == ROOM && c->a < 0)
        return v3_scale(-f->lever[-1 - c->a], p->wall[-1 - c->a].load.axis);
    if (f->wall == ROOM) return v3(0, 0, 0);
    if (freedom_common(f)) return v3_scale(edges_between(f, p, c, ahead, edge), f->axis);
    if (c->a != -1 - f->wall) return v3(0, 0, 0);
    return v3_scale(-1, f->turns ? v3_cross(f->axis, v3_sub(c->x, f->point)) : f->axis);
}

static void wall_move(const struct packing *p, struct load *l, double change, bool back)
{
    double after = step_after(p) * change;
    if (back) l->speed -= change;
    double way = p->dt * l->speed + after;
    l->travel += back ? -way : way;
    if (!back) l->speed += change;
}

static void edge_move(struct packing *p, const struct freedom *f, double change, bool back)
{
    double sign = back ? -1 : 1;
    for (int k = 0; k < 3; k++) {
        vec3 *rate = &p->cell.rate[k], *edge = &p->cell.edge[k];
        if (v3_dot(f->gain[k], f->gain[k]) == 0) continue;
        *edge = v3_axpy(*edge, sign * step_after(p) * change, f->gain[k]);
        *rate = v3_axpy(*rate, sign * change, f->gain[k]);
    }
}

void freedom_move(const struct freedom *f, struct packing *p, double change, bool back)
{
    if (freedom_of_cell(f))
        edge_move(p, f, change, back);
    else if (f->wall == ROOM)
        servo_box_move(p, f->lever, change, back);
    else
        wall_move(p, &p->wall[f->wall].load, change, back);
}

void freedoms_move_rates(const struct freedoms *list, struct packing *p, bool back)
{
    if (list->lever && !(servo_box_mass(p) > 0)) servo_box_move(p, list->lever, 0, back);
}

void freedoms_displace(const struct freedoms *list, struct packing *p, const double *way)
{
    vec3 gain[3] = { 0 };
    struct cell_flow flow;
    for (int32_t k = 0; k < list->n; k++) {
        const struct freedom *f = &list->f[k];
        if (freedom_of_cell(f))
            freedom_gain(f, way[k], gain);
        else if (f->wall == ROOM)
            servo_box_displace(p, f->lever, way[k]);
        else
            p->wall[f->wall].load.travel += way[k];
    }
    cell_flow_init(&flow, &p->cell, p->cell.edge, gain);
    for (int64_t i = 0; flow.changes && i < p->n; i++)
        if (p->mass[i] > 0) p->x[i] = v3_add(p->x[i], cell_flow_gain(&flow, p->x[i]));
    for (int k = 0; k < 3; k++) p->cell.edge[k] = v3_add(p->cell.edge[k], gain[k]);
}
