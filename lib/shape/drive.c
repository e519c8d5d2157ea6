/* shape/drive.c: signals, and the motions that they make [shape/drive.h]. */
#include "shape/drive.h"

#include <stdlib.h>
#include <string.h>

int drives_alloc(struct drives *d, int32_t n, int32_t rows, struct failure *failure)
{
    drives_free(d);
    d->drive = calloc((size_t)n + 1, sizeof *d->drive);
    d->row = calloc((size_t)rows + 1, sizeof *d->row);
    if (!d->drive || !d->row) {
        drives_free(d);
        return failure_set(failure, EX_SOFTWARE, "no memory for %d drives", n);
    }
    d->n = n, d->rows = rows;
    return 0;
}

void drives_free(struct drives *d)
{
    free(d->drive), free(d->row);
    *d = (struct drives){ 0 };
}

int drives_copy(struct drives *to, const struct drives *from, struct failure *failure)
{
    *to = (struct drives){ 0 };
    if (!from->n) return 0;
    if (drives_alloc(to, from->n, from->rows, failure)) return failure->status;
    memcpy(to->drive, from->drive, (size_t)from->n * sizeof *to->drive);
    if (from->rows) memcpy(to->row, from->row, (size_t)from->rows * sizeof *to->row);
    return 0;
}

static const char *table_trouble(const struct drives *d, const struct drive *k)
{
    if (k->first < 0 || k->rows < 1 || k->first > d->rows || k->rows > d->rows - k->first)
        return "its table is not there";
    for (int32_t i = 0; i < k->rows; i++) {
        const struct drive_row *r = &d->row[k->first + i];
        if (!isfinite(r->t) || !isfinite(r->s)) return "its table is not finite";
        if (i && !(r->t > r[-1].t)) return "the times of its table do not rise";
    }
    return NULL;
}

static const char *drive_trouble(const struct drives *d, int32_t k, int32_t walls, int dim)
{
    const struct drive *s = &d->drive[k];
    if (s->wall < 0 || s->wall >= walls) return "its wall does not exist";
    if (k && s->wall < s[-1].wall) return "drives are not in the order of the walls";
    if (s->turns != 0 && s->turns != 1) return "it neither rotates nor translates";
    if (s->signal < 0 || s->signal >= DRIVE_SIGNALS) return "no such signal";
    if (!(fabs(v3_dot(s->axis, s->axis) - 1) < 1e-6)) return "its axis is not a unit vector";
    if (!v3_finite(s->point) || !isfinite(s->value) || !isfinite(s->frequency) ||
        !isfinite(s->phase) || !isfinite(s->clock))
        return "it is not finite";
    if (!(s->from <= s->until) || s->from == INFINITY || s->until == -INFINITY)
        return "it ends before it begins";
    if (s->signal == DRIVE_SPEED && !isfinite(s->from)) return "it has no beginning";
    bool leaves = s->turns ? s->axis.x != 0 || s->axis.y != 0 : s->axis.z != 0;
    if (dim == 2 && (leaves || s->point.z != 0)) return "it leaves the plane, and dim is 2";
    return s->signal == DRIVE_TABLE ? table_trouble(d, s) : NULL;
}

int drives_check(const struct drives *d, int32_t walls, int dim, const char *what,
                 struct failure *failure)
{
    int64_t rows = 0; // of all tables: none is another's, too
    for (int32_t k = 0, of_one = 0; k < d->n; k++) {
        const struct drive *s = &d->drive[k];
        of_one = k && s->wall == s[-1].wall ? of_one + 1 : 1;
        rows += s->signal == DRIVE_TABLE && s->rows > 0 ? s->rows : 0;
        const char *trouble = of_one > DRIVES_MOST ? "more than a wall may have"
                              : rows > d->rows     ? "its table is missing or another drive's"
                                                   : drive_trouble(d, k, walls, dim);
        if (trouble) return failure_set(failure, EX_DATAERR, "%s %d: %s", what, k, trouble);
    }
    return 0;
}

/* Not libm's, whose last bits differ between machines */
static double sine(double x)
{
    return quat_rotation(v3(2 * fmod(x, 2 * M_PI), 0, 0)).x;
}

static double table_way(const struct drive_row *row, int32_t rows, double t)
{
    if (t <= row[0].t) return row[0].s;
    if (t >= row[rows - 1].t) return row[rows - 1].s;
    int32_t lo = 0, hi = rows - 1; // row[lo].t <= t < row[hi].t
    while (hi - lo > 1) {
        int32_t middle = lo + (hi - lo) / 2;
        *(row[middle].t <= t ? &lo : &hi) = middle;
    }
    return row[lo].s + (row[hi].s - row[lo].s) * ((t - row[lo].t) / (row[hi].t - row[lo].t));
}

double drive_way(const struct drives *d, const struct drive *k, double t)
{
    t = fmin(fmax(t + k->clock, k->from), k->until);
    switch (k->signal) {
    case DRIVE_SPEED:
        return k->value * (t - k->from);
    case DRIVE_SINE:
        return k->value * sine(2 * M_PI * fmod(k->frequency * t, 1) + k->phase);
    default:
        return table_way(&d->row[k->first], k->rows, t);
    }
}

double drive_top_speed(const struct drives *d, const struct drive *k)
{
    if (k->signal == DRIVE_SPEED) return fabs(k->value);
    if (k->signal == DRIVE_SINE) return fabs(2 * M_PI * k->frequency * k->value);
    double most = 0;
    const struct drive_row *r = &d->row[k->first];
    for (int32_t i = 1; i < k->rows; i++)
        most = fmax(most, fabs((r[i].s - r[i - 1].s) / (r[i].t - r[i - 1].t)));
    return most;
}

static struct pose drive_pose(const struct drives *d, const struct drive *k, double t)
{
    double s = drive_way(d, k, t);
    if (!k->turns) return (struct pose){ { 1, 0, 0, 0 }, v3_scale(s, k->axis) };
    quat q = quat_rotation(v3_scale(fmod(s, 2 * M_PI), k->axis));
    return (struct pose){ q, v3_sub(k->point, quat_turn(q, k->point)) };
}

struct pose drives_pose(const struct drives *d, int32_t first, int32_t n, double t)
{
    struct pose all = { .q = { 1, 0, 0, 0 } };
    for (int32_t i = first; i < first + n; i++) {
        struct pose one = drive_pose(d, &d->drive[i], t);
        all.shift = pose_of(&one, all.shift);
        if (d->drive[i].turns) all.q = quat_unit(quat_mul(one.q, all.q));
    }
    return all;
}

/* rad/s or m/s: the mean over a step */
static double mean_speed(const struct drives *d, const struct drive *k, struct drive_step s)
{
    if (k->signal == DRIVE_SPEED && s.t + k->clock >= k->from && s.then + k->clock <= k->until)
        return k->value; // to the bit
    return (drive_way(d, k, s.then) - drive_way(d, k, s.t)) / s.dt;
}

/* The last drive is undone first: x is where its motion has brought the material. */
vec3 drives_velocity(const struct drives *d, int32_t first, int32_t n, struct drive_step step,
                     vec3 x)
{
    vec3 v = v3(0, 0, 0);
    quat later = { 1, 0, 0, 0 };
    for (int32_t i = first + n - 1; i >= first; i--) {
        const struct drive *k = &d->drive[i];
        double speed = mean_speed(d, k, step);
        vec3 axis = quat_turn(later, k->axis);
        struct pose one = drive_pose(d, k, step.t + step.dt / 2);
        if (k->turns) {
            vec3 arm = quat_turn(later, v3_sub(x, k->point));
            v = v3_axpy(v, speed, v3_cross(axis, arm));
            later = quat_mul(later, one.q);
            x = quat_turn_back(one.q, v3_sub(x, one.shift));
        } else {
            v = v3_axpy(v, speed, axis);
            x = v3_sub(x, one.shift);
        }
    }
    return v;
}

vec3 drives_spin(const struct drives *d, int32_t first, int32_t n, struct drive_step step)
{
    vec3 w = v3(0, 0, 0);
    quat later = { 1, 0, 0, 0 };
    for (int32_t i = first + n - 1; i >= first; i--) {
        const struct drive *k = &d->drive[i];
        if (!k->turns) continue;
        w = v3_axpy(w, mean_speed(d, k, step), quat_turn(later, k->axis));
        later = quat_mul(later, drive_pose(d, k, step.t + step.dt / 2).q);
    }
    return w;
}
