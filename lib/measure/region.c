#include "measure/region.h"

#include "measure/ball_part.h"

#include <math.h>

void reach_of_planes(const struct packing *p, int axis, double *lo, double *hi)
{
    double from = -INFINITY, to = INFINITY;
    for (int32_t w = 0; w < p->walls; w++) {
        const struct wall *wall = &p->wall[w];
        const vec3 at = wall_at(p, wall, p->t), up = wall_normal(p, wall, p->t);
        if (wall->shape != WALL_PLANE || !wall_there(wall, p->t)) continue;
        const double n[3] = { up.x, up.y, up.z }, x[3] = { at.x, at.y, at.z };
        if (n[axis] > 1 - 1e-12) from = fmax(from, x[axis]);
        if (n[axis] < -1 + 1e-12) to = fmin(to, x[axis]);
    }
    if (isfinite(from)) *lo = from;
    if (isfinite(to)) *hi = to;
    if (*hi < *lo) *hi = *lo;
}

/* ---- images ---- */

/* The fewest and most whole edges k for which x + sum k edge[k] may be within `margin` (m) of the
   region. Edges along which it has no bounds are not looked along. */
struct region_walk region_walk(const struct region *r, vec3 x, double margin)
{
    struct region_walk s = { { 0, 0, 0 }, { 0, 0, 0 }, { 0, 0, 0 } };
    const double far = 1e15; // beyond it the position of an image is lost to rounding
    for (int k = 0; r->period.any && !r->all && k < 3; k++) {
        if (!r->period.cell->repeats[k]) continue;
        vec3 row = r->period.inverse[k];
        const double w[3] = { row.x, row.y, row.z };
        double least = 0, most = 0, at = v3_dot(row, x), more = margin * v3_norm(row);
        bool bounded = true;
        for (int j = 0; j < 3; j++) {
            if (w[j] == 0) continue;
            bounded = bounded && isfinite(r->lo[j]) && isfinite(r->hi[j]);
            least += fmin(w[j] * r->lo[j], w[j] * r->hi[j]);
            most += fmax(w[j] * r->lo[j], w[j] * r->hi[j]);
        }
        least = ceil(least - more - at), most = floor(most + more - at);
        if (bounded && !(most - least < far))
            least = 0, most = far; // region_check_images() refuses it
        if (bounded && fabs(least) <= far && fabs(most) <= far)
            s.from[k] = (int64_t)least, s.to[k] = (int64_t)most;
        s.at[k] = s.from[k];
    }
    return s;
}

static vec3 shifted(const struct region *r, vec3 x, int64_t i, int64_t j, int64_t k)
{
    if (!i && !j && !k) return x;
    const vec3 *e = r->period.edge;
    return v3_axpy(v3_axpy(v3_axpy(x, (double)i, e[0]), (double)j, e[1]), (double)k, e[2]);
}

int region_check_images(const struct region *r, int64_t n, double margin, const char *what,
                        struct failure *failure)
{
    const double few = 1000, most = 1e7; // of one body, where there may be millions of them; of all
    double images = 1;
    struct region_walk w =
        region_walk(r, v3(r->lo[0], r->lo[1], r->dim == 3 ? r->lo[2] : 0), margin);
    for (int k = 0; k < 3; k++) images *= (double)(w.to[k] - w.from[k] + 1);
    if (images <= few || images * (double)n <= most) return 0;
    return failure_set(failure, EX_DATAERR, "%s %.3g images of each body in the periodic cell",
                       what, images);
}

bool region_next(struct region_walk *w, const struct region *r, vec3 x, vec3 *image)
{
    if (w->at[2] > w->to[2]) w->at[2] = w->from[2], w->at[1]++;
    if (w->at[1] > w->to[1]) w->at[1] = w->from[1], w->at[0]++;
    for (int k = 0; k < 3; k++)
        if (w->at[k] > w->to[k]) return false;
    *image = shifted(r, x, w->at[0], w->at[1], w->at[2]++);
    return true;
}

vec3 region_rate(const struct region_walk *w, const struct region *r)
{
    const int64_t edges[3] = { w->at[0], w->at[1], w->at[2] - 1 };
    vec3 rate = v3(0, 0, 0);
    for (int k = 0; k < 3; k++)
        if (edges[k]) rate = v3_axpy(rate, (double)edges[k], r->period.cell->rate[k]);
    return rate;
}

/* ---- making regions ---- */

static void region_reach(const struct packing *p, double lo[3], double hi[3])
{
    for (int k = 0; k < 3; k++) lo[k] = INFINITY, hi[k] = -INFINITY;
    for (int64_t i = 0; i < p->n; i++) {
        const double x[3] = { p->x[i].x, p->x[i].y, p->x[i].z };
        for (int k = 0; k < 3; k++) {
            lo[k] = fmin(lo[k], x[k] - p->radius[i]), hi[k] = fmax(hi[k], x[k] + p->radius[i]);
        }
    }
    for (int k = 0; k < 3; k++)
        if (!(lo[k] <= hi[k]) || k >= p->dim) lo[k] = hi[k] = 0;
}

/* The bounds of the box that the cell's edges reach along the axes */
static void reach_cell(const struct period *m, int axis, double *lo, double *hi)
{
    const vec3 o = m->cell->origin;
    const double origin[3] = { o.x, o.y, o.z };
    *lo = *hi = origin[axis];
    for (int k = 0; k < 3; k++) {
        const double e[3] = { m->edge[k].x, m->edge[k].y, m->edge[k].z };
        if (m->cell->repeats[k]) *lo += fmin(e[axis], 0), *hi += fmax(e[axis], 0);
    }
}

void region_whole(struct region *r, const struct packing *p)
{
    *r = (struct region){ .dim = p->dim, .all = true };
    period_of(&r->period, &p->cell);
    region_reach(p, r->lo, r->hi);
    r->volume = p->n ? r->period.volume : 0;
    for (int k = 0; k < 3 && k < p->dim; k++) {
        if (p->n) reach_of_planes(p, k, &r->lo[k], &r->hi[k]);
        if (r->period.any && p->cell.repeats[k])
            reach_cell(&r->period, k, &r->lo[k], &r->hi[k]);
        else
            r->volume *= r->hi[k] - r->lo[k];
    }
}

void region_box(struct region *r, const struct packing *p, const double lo[3], const double hi[3])
{
    *r = (struct region){ .dim = p->dim, .volume = 1 };
    period_of(&r->period, &p->cell);
    for (int k = 0; k < 3; k++) {
        bool bound = k < p->dim;
        r->lo[k] = bound ? lo[k] : -INFINITY, r->hi[k] = bound ? hi[k] : INFINITY;
        if (bound) r->volume *= hi[k] - lo[k];
    }
}

/* How many edges that repeat have a part along the axis; *edge is the last of them. */
static int region_edges_along(const struct packing *p, int axis, int *edge)
{
    int n = 0;
    for (int k = 0; k < 3; k++) {
        const double e[3] = { p->cell.edge[k].x, p->cell.edge[k].y, p->cell.edge[k].z };
        if (p->cell.repeats[k] && e[axis] != 0) *edge = k, n++;
    }
    return n;
}

bool region_layers(struct region *layer, int64_t n, const struct region *in,
                   const struct packing *p, int axis, const char **reason)
{
    int edge = axis, leaning = region_edges_along(p, axis, &edge);
    double lo = in->lo[axis], hi = in->hi[axis];
    if (in->all && leaning > 1) {
        *reason = "several edges of the cell lean along the layers' axis";
        return false;
    }
    if (!(hi > lo)) {
        *reason = "the region has no extent along the layers' axis";
        return false;
    }
    for (int64_t i = 0; i < n; i++) {
        layer[i] = *in;
        layer[i].all = false;
        for (int k = 0; in->all && k < 3; k++)
            layer[i].lo[k] = -INFINITY, layer[i].hi[k] = INFINITY;
        layer[i].lo[axis] = lo + (hi - lo) * (double)i / (double)n;
        layer[i].hi[axis] = i + 1 == n ? hi : lo + (hi - lo) * (double)(i + 1) / (double)n;
        layer[i].volume = in->volume / (double)n;
    }
    return true;
}

/* m^2, m: of the ring times the height of the region */
static double shell_volume(const struct region *in, double inner, double outer)
{
    double ring = M_PI * (outer - inner) * (outer + inner);
    return in->dim == 2 ? ring : ring * (in->hi[2] - in->lo[2]);
}

bool region_shells(struct region *shell, int64_t n, const struct region *in,
                   const struct packing *p, vec3 centre, const char **reason)
{
    double dx = fmax(fabs(in->lo[0] - centre.x), fabs(in->hi[0] - centre.x));
    double dy = fmax(fabs(in->lo[1] - centre.y), fabs(in->hi[1] - centre.y));
    double R = fmin(dx, dy);
    if (cell_repeats(&p->cell)) {
        *reason = "shells do not fit a periodic cell";
        return false;
    }
    if (!(R > 0)) {
        *reason = "the region has no extent around the shells' axis";
        return false;
    }
    for (int64_t i = 0; i < n; i++) {
        shell[i] = *in;
        shell[i].all = false;
        for (int k = 0; k < 2; k++) shell[i].lo[k] = -INFINITY, shell[i].hi[k] = INFINITY;
        if (in->all || in->dim == 2) shell[i].lo[2] = -INFINITY, shell[i].hi[2] = INFINITY;
        shell[i].centre = centre;
        shell[i].inner = R * (double)i / (double)n,
        shell[i].outer = R * (double)(i + 1) / (double)n;
        shell[i].volume = shell_volume(in, shell[i].inner, shell[i].outer);
    }
    return true;
}

/* ---- what is in them ---- */

static double region_distance(const struct region *r, vec3 x)
{
    return hypot(x.x - r->centre.x, x.y - r->centre.y);
}

/* Bounds below are in it, bounds above are not, so that layers share nothing. */
static bool inside(const struct region *r, vec3 x)
{
    const double at[3] = { x.x, x.y, x.z };
    for (int k = 0; k < 3 && k < r->dim; k++)
        if (!(at[k] >= r->lo[k] && at[k] < r->hi[k])) return false;
    if (r->outer > 0) {
        double d = region_distance(r, x);
        return d >= r->inner && d < r->outer;
    }
    return true;
}

int region_holds(const struct region *r, vec3 x)
{
    int n = 0;
    if (r->all) return 1;
    struct region_walk w = region_walk(r, x, 0);
    for (vec3 y; region_next(&w, r, x, &y);) n += inside(r, y);
    return n;
}

vec3 region_velocities(const struct region *r, vec3 x, vec3 v)
{
    vec3 sum = v3(0, 0, 0);
    if (r->all) return v;
    struct region_walk w = region_walk(r, x, 0);
    for (vec3 y; region_next(&w, r, x, &y);)
        if (inside(r, y)) sum = v3_add(sum, v3_add(v, region_rate(&w, r)));
    return sum;
}

static double one_ball(const struct region *r, vec3 x, double radius)
{
    if (r->outer > 0) {
        double d = region_distance(r, x);
        double part = ball_in_cylinder(r->dim, d, radius, r->outer) -
                      ball_in_cylinder(r->dim, d, radius, r->inner);
        // of a ball that a bound cuts as well, by the product of the two parts
        if (r->dim == 2) return part;
        return part * (ball_in_box(3, x, radius, r->lo, r->hi) / ball_volume(3, radius));
    }
    return ball_in_box(r->dim, x, radius, r->lo, r->hi);
}

double region_ball(const struct region *r, vec3 x, double radius)
{
    double sum = 0;
    if (r->all) return ball_volume(r->dim, radius);
    struct region_walk w = region_walk(r, x, radius);
    for (vec3 y; region_next(&w, r, x, &y);) sum += one_ball(r, y, radius);
    return sum;
}

/* The s in [*from, *to] with |x + s l - centre| < R, both across z: what is left of them */
static double region_within(const struct region *r, vec3 x, vec3 l, double R, double from,
                            double to)
{
    double dx = x.x - r->centre.x, dy = x.y - r->centre.y;
    double a = l.x * l.x + l.y * l.y, b = dx * l.x + dy * l.y, c = dx * dx + dy * dy - R * R;
    if (!(to > from)) return 0;
    if (!(a > 0)) return c < 0 ? to - from : 0;
    double root = b * b - a * c;
    if (!(root > 0)) return 0;
    root = sqrt(root);
    return fmax(fmin(to, (-b + root) / a) - fmax(from, (-b - root) / a), 0);
}

static double one_way(const struct region *r, vec3 x, vec3 l)
{
    const double at[3] = { x.x, x.y, x.z }, by[3] = { l.x, l.y, l.z };
    double from = 0, to = 1;
    for (int k = 0; k < 3 && k < r->dim; k++) {
        if (by[k] == 0) {
            if (!(at[k] >= r->lo[k] && at[k] < r->hi[k])) return 0;
            continue;
        }
        double one = (r->lo[k] - at[k]) / by[k], other = (r->hi[k] - at[k]) / by[k];
        from = fmax(from, fmin(one, other)), to = fmin(to, fmax(one, other));
    }
    if (!(to > from)) return 0;
    if (r->outer > 0)
        return region_within(r, x, l, r->outer, from, to) -
               region_within(r, x, l, r->inner, from, to);
    return to - from;
}

double region_way(const struct region *r, vec3 x, vec3 l)
{
    double sum = 0;
    if (r->all) return 1;
    struct region_walk w = region_walk(r, x, v3_norm(l));
    for (vec3 y; region_next(&w, r, x, &y);) sum += one_way(r, y, l);
    return sum;
}
