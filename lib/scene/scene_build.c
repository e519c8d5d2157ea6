/* scene/scene_build.c: tables, random lattices, the check for overlaps: a packing from a scene. */
#include "scene/scene_build.h"

#include "bodies/detect.h"
#include "bodies/tidy.h"

#include <ctype.h>
#include <errno.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* ---- tables ---- */

enum {
    LINE = 4096,         /* bytes of a line, a comment's too */
    MOST_ROWS = 1 << 27, /* bodies of a table: 4 GiB of rows, 100 GiB of packing */
};

struct row {
    double x[4]; /* m: x y z r; in the plane x y r */
};

struct table {
    int64_t n, room;
    struct row *row;
};

/* Reads the numbers of a line up to its end or a '#'; returns how many, -1 if there is anything
   else. */
static int parse_numbers(const char *s, double out[4])
{
    for (int n = 0;; n++) {
        char *end;
        while (isspace((unsigned char)*s)) s++;
        if (*s == 0 || *s == '#') return n;
        double x = strtod(s, &end);
        if (end == s || (*end && *end != '#' && !isspace((unsigned char)*end)) || n == 4) return -1;
        out[n] = x, s = end;
    }
}

static int add_row(struct table *t, const struct row *row, struct why *why)
{
    if (t->n == MOST_ROWS)
        return why_set(why, EX_DATAERR, "a table of more than %d bodies (endless?)", MOST_ROWS);
    if (t->n == t->room) {
        int64_t more = t->room ? 2 * t->room : 256;
        struct row *wider = realloc(t->row, (size_t)more * sizeof *wider);
        if (!wider) return why_set(why, EX_SOFTWARE, "no memory for a table");
        t->row = wider, t->room = more;
    }
    t->row[t->n++] = *row;
    return 0;
}

static int read_line(struct table *t, int dim, const char *line, const char *name, int64_t at,
                     struct why *why)
{
    struct row row = { 0 };
    int n = parse_numbers(line, row.x);
    if (n == 0) return 0;
    if (n != dim + 1)
        return why_set(why, EX_DATAERR, "%s:%lld: wants %s", name, (long long)at,
                       dim == 2 ? "x y r" : "x y z r");
    for (int i = 0; i < n; i++)
        if (!isfinite(row.x[i]))
            return why_set(why, EX_DATAERR, "%s:%lld: not finite", name, (long long)at);
    if (!(row.x[n - 1] > 0))
        return why_set(why, EX_DATAERR, "%s:%lld: the radius must be positive", name,
                       (long long)at);
    return add_row(t, &row, why);
}

/* A line of a table without its newline; false at the end, and where it is too long. */
static bool next_line(FILE *f, char line[LINE], const char *path, int64_t at, struct why *why)
{
    size_t n = 0;
    int c = 0;
    while (n < LINE - 1 && (c = getc(f)) != EOF && c != '\n') line[n++] = (char)c;
    line[n] = 0;
    if (n == LINE - 1)
        return why_set(why, EX_DATAERR, "%s:%lld: a line of more than %d bytes", path,
                       (long long)at, LINE - 2),
               false;
    return n || c != EOF;
}

static int read_table(struct table *t, int dim, const char *dir, const char *name, struct why *why)
{
    char path[4096], line[LINE] = "";
    struct stat st;
    int64_t at = 0;
    bool whole = *name == '/' || !dir;
    if ((size_t)snprintf(path, sizeof path, "%s%s%s", whole ? "" : dir, whole ? "" : "/", name) >=
        sizeof path)
        return why_set(why, EX_NOINPUT, "%.100s...: name too long", name);
    FILE *f = fopen(path, "r");
    if (!f) return why_set(why, EX_NOINPUT, "%s: %s", path, strerror(errno));
    if (!fstat(fileno(f), &st) && (S_ISCHR(st.st_mode) || S_ISBLK(st.st_mode)))
        why_set(why, EX_NOINPUT, "%s: a device is no table", path);
    while (!why->status && next_line(f, line, path, ++at, why))
        read_line(t, dim, line, path, at, why);
    if (!why->status && ferror(f)) why_set(why, EX_NOINPUT, "%s: %s", path, strerror(errno));
    fclose(f);
    return why->status;
}

/* ---- bodies ---- */

static int set_body(struct packing *p, int64_t i, const struct scene_bodies *b, vec3 x, double r,
                    struct why *why)
{
    double mass, inertia;
    packing_solid(p->dim, r, b->density, &mass, &inertia);
    if (b->mass > 0) inertia *= b->mass / mass, mass = b->mass;
    if (!b->fixed && !(mass > 0 && inertia > 0))
        return why_set(why, EX_DATAERR, "body %lld: a radius of %g m gives no mass", (long long)i,
                       r);
    p->x[i] = x, p->v[i] = b->v, p->w[i] = b->w;
    p->radius[i] = r;
    p->mass[i] = b->fixed ? 0 : mass, p->inertia[i] = b->fixed ? 0 : inertia;
    p->kind[i] = b->kind;
    return 0;
}

/* A normal deviate rounded to float: the last bits of libm's logarithm and exponential, from which
   it is made, differ on machines without FMA. */
static double draw_normal(gsl_rng *rng, double sd)
{
    return (float)gsl_ran_gaussian(rng, sd);
}

static double draw_radius(const struct scene_size *z, gsl_rng *rng)
{
    double r;
    if (z->law == SIZE_UNIFORM) return z->min < z->max ? gsl_ran_flat(rng, z->min, z->max) : z->min;
    do {
        double z1 = draw_normal(rng, z->spread);
        r = z->law == SIZE_GAUSSIAN ? z->mid + z1 : z->mid * (float)exp(z1);
    } while (r < z->min || r > z->max); // ends: [min, max] has a share of 1e-3 at least (read_bell)
    return r;
}

/* The middle of cell k of the lattice, moved at random as far as the body stays in the cell; in the
   cell that repeats (else NULL) along its edges. */
static vec3 draw_place(const struct scene_bodies *b, const struct scene_lattice *l,
                       const struct cell *c, int dim, int64_t k, double r, gsl_rng *rng)
{
    double x[3] = { 0 }, rest = (double)k;
    for (int i = 0; i < dim; i++) {
        bool last = i == dim - 1; // the box may be open here: no end of cells
        double above = last ? 0 : floor(rest / l->cells[i]);
        double cell = last ? rest : rest - above * l->cells[i];
        double slack = b->jitter * (0.5 * l->edge[i] - r);
        x[i] = b->box.lo[i] + (cell + 0.5) * l->edge[i] + slack * (2 * gsl_rng_uniform(rng) - 1);
        rest = above;
    }
    if (!c) return v3(x[0], x[1], x[2]);
    vec3 place = c->origin;
    for (int i = 0; i < dim; i++) place = v3_axpy(place, x[i] / b->box.hi[i], c->edge[i]);
    return place;
}

static vec3 draw_velocity(double sd, int dim, gsl_rng *rng)
{
    double v[3] = { 0 };
    for (int i = 0; i < dim; i++) v[i] = draw_normal(rng, sd);
    return v3(v[0], v[1], v[2]);
}

static int fill_lattice(struct packing *p, int64_t first, const struct scene_bodies *b,
                        gsl_rng *rng, struct why *why)
{
    struct scene_lattice l = scene_lattice(b, p->dim);
    for (int64_t k = 0; k < b->count; k++) {
        double r = draw_radius(&b->size, rng);
        vec3 x = draw_place(b, &l, b->in_cell ? &p->cell : NULL, p->dim, k, r, rng);
        if (set_body(p, first + k, b, x, r, why)) return why->status;
        if (b->thermal > 0) p->v[first + k] = v3_add(b->v, draw_velocity(b->thermal, p->dim, rng));
    }
    return 0;
}

static int fill_table(struct packing *p, int64_t first, const struct scene_bodies *b,
                      const struct table *t, struct why *why)
{
    for (int64_t k = 0; k < t->n; k++) {
        const double *x = t->row[k].x;
        vec3 place = v3(x[0], x[1], p->dim == 3 ? x[2] : 0);
        if (set_body(p, first + k, b, place, x[p->dim], why)) return why->status;
    }
    return 0;
}

static int fill_groups(struct packing *p, const struct scene *s, const struct table *table,
                       gsl_rng *rng, struct why *why)
{
    int64_t first = 0;
    for (int64_t g = 0; g < s->groups; g++) {
        const struct scene_bodies *b = &s->bodies[g];
        int bad = b->from == SCENE_ONE       ? set_body(p, first, b, b->x, b->size.min, why)
                  : b->from == SCENE_LATTICE ? fill_lattice(p, first, b, rng, why)
                                             : fill_table(p, first, b, &table[g], why);
        if (bad) return bad;
        first += b->count + table[g].n;
    }
    return 0;
}

/* ---- the packing ---- */

static int set_parameters(struct packing *p, const struct scene *s, struct why *why)
{
    p->dt = s->dt, p->theta = s->theta, p->g = s->g, p->seed = s->seed;
    if (packing_alloc_walls(p, s->walls, why) || packing_alloc_kinds(p, s->kinds, why))
        return why->status;
    for (int32_t i = 0; i < s->walls; i++) p->wall[i] = s->wall[i];
    if (s->cell.given && (cell_copy(&p->cell, &s->cell.cell) || packing_alloc_images(p, why)))
        goto fail;
    for (int32_t k = 0; k < s->kinds; k++) {
        free(p->kind_name[k]);
        if (!(p->kind_name[k] = strdup(s->kind[k].name))) goto fail;
    }
    for (int32_t k = 0; k < s->kinds * s->kinds; k++)
        p->mu[k] = s->law[k].mu, p->en[k] = s->law[k].en, p->et[k] = s->law[k].et;
    if ((p->scene = strdup(s->text))) return 0;
fail:
    return why_set(why, EX_SOFTWARE, "no memory for the scene");
}

static int check_overlap(const struct packing *p, struct why *why)
{
    struct contacts found = { 0 };
    int e = detect_contacts_at(&found, p, p->x, p->t, 0, NULL, why);
    for (int64_t i = 0; !e && i < found.n; i++) {
        const struct contact *c = &found.c[i];
        double r = p->radius[c->b];
        if (c->a >= 0) r = fmin(r, p->radius[c->a]);
        if (c->gap >= -1e-6 * r)
            continue; // rounding: bodies that just touch may overlap by this much
        e = c->a < 0 ? why_set(why, EX_DATAERR, "body %d is %.3g m deep in wall %d", c->b, -c->gap,
                               -1 - c->a)
                     : why_set(why, EX_DATAERR, "bodies %d and %d overlap by %.3g m", c->a, c->b,
                               -c->gap);
    }
    contacts_free(&found);
    return e;
}

/* The flow that the cell's edges make, for the bodies that can move */
static void add_affine_flow(struct packing *p)
{
    struct cell_flow f;
    cell_flow_init(&f, &p->cell, p->cell.edge, p->cell.rate);
    for (int64_t i = 0; f.changes && i < p->n; i++)
        if (p->mass[i] > 0) p->v[i] = v3_add(p->v[i], cell_flow_gain(&f, p->x[i]));
}

/* Are the numbers in range, and do no bodies overlap, unless the scene allows it? */
static int check_packing(const struct packing *p, const struct scene *s, struct why *why)
{
    if (packing_check(p, why)) return why->status;
    return s->overlap ? 0 : check_overlap(p, why);
}

static int build_packing(struct packing *p, const struct scene *s, const struct table *table,
                         struct why *why)
{
    int64_t n = 0;
    for (int64_t g = 0; g < s->groups; g++) n += s->bodies[g].count + table[g].n;
    if (n > INT32_MAX) return why_set(why, EX_DATAERR, "more than %d bodies", INT32_MAX);
    if (packing_init(p, s->dim, n, why)) return why->status;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    if (!rng) why_set(why, EX_SOFTWARE, "no memory for random numbers");
    if (rng) gsl_rng_set(rng, s->seed);
    if (rng && !set_parameters(p, s, why) && !fill_groups(p, s, table, rng, why)) {
        if (s->cell.affine) add_affine_flow(p);
        packing_tidy(p, NULL);
        check_packing(p, s, why);
    }
    gsl_rng_free(rng);
    if (why->status) packing_free(p);
    return why->status;
}

int scene_build(struct packing *p, const struct scene *s, const char *dir, struct why *why)
{
    struct table *table = calloc(s->groups > 0 ? (size_t)s->groups : 1, sizeof *table);
    if (!table) return why_set(why, EX_SOFTWARE, "no memory for tables");
    for (int64_t g = 0; g < s->groups && !why->status; g++)
        if (s->bodies[g].from == SCENE_TABLE)
            read_table(&table[g], s->dim, dir, s->bodies[g].file, why);
    if (!why->status) build_packing(p, s, table, why);
    for (int64_t g = 0; g < s->groups; g++) free(table[g].row);
    free(table);
    return why->status;
}
