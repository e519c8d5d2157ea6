#include "scene.h"
#include "jnode.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char axis_name[3][2] = { "x", "y", "z" };

static void *room(jnode n, size_t count, size_t size)
{
    void *p = calloc(count ? count : 1, size);
    if (!p) why_set(n.in->why, EX_SOFTWARE, "no memory for the scene");
    return p;
}

/* ---- material ---- */

static int read_law(const jnode *o, struct scene_law *l)
{
    return jnode_number(jnode_key(o, "mu"), J_NOT_NEGATIVE, &l->mu) ||
           jnode_number(jnode_key(o, "e_n"), J_UNIT, &l->en) ||
           jnode_number(jnode_key(o, "e_t"), J_UNIT, &l->et);
}

static int32_t find_kind(const struct scene *s, const char *name)
{
    for (int32_t k = 0; k < s->kinds; k++)
        if (!strcmp(s->kind[k].name, name)) return k;
    return -1;
}

static int read_kind(jnode n, const struct scene *s, int32_t *kind)
{
    const char *name = NULL;
    if (jnode_text(n, &name)) return 1;
    if (!name) return 0;
    *kind = find_kind(s, name);
    return *kind < 0 ? jnode_fault(n, "no kind \"%s\"; name it under \"kinds\"", name) : 0;
}

static int add_kind(jnode n, struct scene *s, const char *name, double density)
{
    bool printable = *name; // documents keep names line by line
    for (const char *c = name; *c; c++) printable &= (unsigned char)*c >= ' ';
    if (!printable) return jnode_fault(n, "a kind wants a name without control characters");
    s->kind[s->kinds] = (struct scene_kind){ strdup(name), density };
    if (!s->kind[s->kinds].name) return why_set(n.in->why, EX_SOFTWARE, "no memory for a kind");
    s->kinds++;
    return 0;
}

static int read_kinds(jnode o, struct scene *s, double density)
{
    const char *name;
    json_t *value;
    size_t most = 1000, count = json_object_size(o.json);
    if (o.json && !json_is_object(o.json)) return jnode_fault(o, "wants an object {...}");
    if (count > most) return jnode_fault(o, "more than %zu kinds", most);
    if (!(s->kind = room(o, count + 2, sizeof *s->kind))) return 1;
    if (add_kind(o, s, "ball", density) || add_kind(o, s, "wall", density)) return 1;
    json_object_foreach(o.json, name, value)
    {
        jnode n = jnode_key(&o, name);
        if (!strcmp(name, "comment")) continue;
        if (jnode_only(n, "density")) return 1;
        if (find_kind(s, name) < 0 && add_kind(o, s, name, density)) return 1;
        double *d = &s->kind[find_kind(s, name)].density;
        if (jnode_number(jnode_key(&n, "density"), J_POSITIVE, d)) return 1;
    }
    return 0;
}

static int read_pair(jnode o, struct scene *s, bool *given)
{
    size_t n;
    int32_t k[2] = { 0 };
    if (jnode_only(o, "pair mu e_n e_t") || jnode_need(&o, "pair")) return 1;
    jnode pair = jnode_key(&o, "pair");
    if (jnode_array(pair, &n)) return 1;
    if (n != 2) return jnode_fault(pair, "wants two kinds");
    for (size_t i = 0; i < 2; i++) {
        jnode name = jnode_item(&pair, i);
        if (read_kind(name, s, &k[i])) return 1;
    }
    int32_t ab = k[0] * s->kinds + k[1], ba = k[1] * s->kinds + k[0];
    if (given[ab]) return jnode_fault(pair, "this pair was given before");
    given[ab] = given[ba] = true;
    if (read_law(&o, &s->law[ab])) return 1;
    s->law[ba] = s->law[ab];
    return 0;
}

static int read_pairs(jnode a, struct scene *s, struct scene_law law)
{
    size_t n, k2 = (size_t)s->kinds * (size_t)s->kinds;
    if (jnode_array(a, &n) || !(s->law = room(a, k2, sizeof *s->law))) return 1;
    for (size_t i = 0; i < k2; i++) s->law[i] = law;
    bool *given = room(a, k2, sizeof *given);
    int bad = !given;
    for (size_t i = 0; i < n && !bad; i++) bad = read_pair(jnode_item(&a, i), s, given);
    free(given);
    return bad;
}

/* ---- places ---- */

static int read_side(jnode n, double lo_hi[2])
{
    size_t count;
    if (!n.json) return 0;
    if (jnode_array(n, &count)) return 1;
    if (count != 2) return jnode_fault(n, "wants [from, to]");
    for (size_t i = 0; i < 2; i++) {
        jnode end = jnode_item(&n, i);
        if (!json_is_null(end.json) && jnode_number(end, J_ANY, &lo_hi[i])) return 1;
    }
    return lo_hi[0] < lo_hi[1] ? 0 : jnode_fault(n, "its end must lie above its beginning");
}

static int read_box(jnode o, int dim, struct scene_box *b)
{
    if (jnode_only(o, dim == 2 ? "x y" : "x y z")) return 1;
    for (int i = 0; i < 3; i++) {
        double side[2] = { -INFINITY, INFINITY };
        if (i < dim && read_side(jnode_key(&o, axis_name[i]), side)) return 1;
        b->lo[i] = side[0], b->hi[i] = side[1];
    }
    return 0;
}

static void add_wall(struct scene *s, struct wall w, vec3 point, vec3 normal)
{
    w.x = point, w.n = normal;
    s->wall[s->walls++] = w;
}

/* x from below, x from above, y ...: where the box is not open. */
static void add_box(struct scene *s, struct wall w, const struct scene_box *b)
{
    for (int i = 0; i < 3; i++) {
        double e[3] = { i == 0, i == 1, i == 2 }, lo = b->lo[i], hi = b->hi[i];
        vec3 n = v3(e[0], e[1], e[2]), zero = v3(0, 0, 0);
        if (isfinite(lo)) add_wall(s, w, v3_axpy(zero, lo, n), n);
        if (isfinite(hi)) add_wall(s, w, v3_axpy(zero, hi, n), v3_axpy(zero, -1, n));
    }
}

static int read_plane(jnode o, struct scene *s, struct wall w)
{
    vec3 x = v3(0, 0, 0), n = x;
    if (jnode_only(o, "point normal velocity kind") || jnode_need(&o, "point normal") ||
        jnode_vector(jnode_key(&o, "point"), s->dim, &x) ||
        jnode_vector(jnode_key(&o, "normal"), s->dim, &n))
        return 1;
    double most = fmax(fabs(n.x), fmax(fabs(n.y), fabs(n.z))); // so that no square overflows
    if (!(most > 0)) return jnode_fault(jnode_key(&o, "normal"), "must not be zero");
    n = v3(n.x / most, n.y / most, n.z / most);
    double length = v3_norm(n);
    add_wall(s, w, x, v3(n.x / length, n.y / length, n.z / length));
    return 0;
}

/* *box: that of the first boxed wall, the default place of a lattice. */
static int read_wall(jnode o, struct scene *s, struct scene_box *box, bool *boxed)
{
    struct wall w = { .kind = 1 };
    struct scene_box b;
    int which = jnode_choice(o, "point box");
    if (which < 0 || jnode_vector(jnode_key(&o, "velocity"), s->dim, &w.v) ||
        read_kind(jnode_key(&o, "kind"), s, &w.kind))
        return 1;
    if (which == 0) return read_plane(o, s, w);
    if (jnode_only(o, "box velocity kind") || read_box(jnode_key(&o, "box"), s->dim, &b)) return 1;
    add_box(s, w, &b);
    if (!*boxed) *box = b, *boxed = true;
    return 0;
}

static int read_walls(jnode a, struct scene *s, struct scene_box *box, bool *boxed)
{
    size_t n;
    if (jnode_array(a, &n) || !(s->wall = room(a, 6 * n, sizeof *s->wall))) return 1;
    for (size_t i = 0; i < n; i++)
        if (read_wall(jnode_item(&a, i), s, box, boxed)) return 1;
    return 0;
}

/* ---- bodies ---- */

static int read_uniform(jnode a, struct scene_size *z)
{
    size_t n;
    if (jnode_array(a, &n)) return 1;
    if (n != 2) return jnode_fault(a, "wants [min, max]");
    if (jnode_number(jnode_item(&a, 0), J_POSITIVE, &z->min) ||
        jnode_number(jnode_item(&a, 1), J_POSITIVE, &z->max))
        return 1;
    return z->min <= z->max ? 0 : jnode_fault(a, "max is less than min");
}

static double normal_below(double z)
{
    return 0.5 * erfc(-z * M_SQRT1_2);
}

static int read_bell(jnode o, struct scene_size *z)
{
    bool gauss = z->law == SIZE_GAUSSIAN;
    const char *mid = gauss ? "mean" : "median", *spread = gauss ? "sd" : "sigma";
    if (jnode_only(o, gauss ? "mean sd min max" : "median sigma min max") ||
        jnode_need(&o, gauss ? "mean sd min max" : "median sigma min max") ||
        jnode_number(jnode_key(&o, mid), gauss ? J_ANY : J_POSITIVE, &z->mid) ||
        jnode_number(jnode_key(&o, spread), J_NOT_NEGATIVE, &z->spread) ||
        jnode_number(jnode_key(&o, "min"), J_POSITIVE, &z->min) ||
        jnode_number(jnode_key(&o, "max"), J_POSITIVE, &z->max))
        return 1;
    if (z->min > z->max) return jnode_fault(jnode_key(&o, "max"), "is less than min");
    double from = gauss ? z->min - z->mid : log(z->min / z->mid);
    double to = gauss ? z->max - z->mid : log(z->max / z->mid);
    bool enough = z->spread > 0
                      ? normal_below(to / z->spread) - normal_below(from / z->spread) > 1e-3
                      : from <= 0 && to >= 0;
    return enough ? 0 : jnode_fault(o, "[min, max] keeps less than a thousandth of it");
}

static int read_size(jnode n, struct scene_size *z)
{
    if (!json_is_object(n.json)) {
        int bad = jnode_number(n, J_POSITIVE, &z->min);
        z->max = z->min;
        return bad;
    }
    int which = jnode_choice(n, "uniform gaussian lognormal");
    if (which < 0 || jnode_only(n, "uniform gaussian lognormal")) return 1;
    z->law = which == 0 ? SIZE_UNIFORM : which == 1 ? SIZE_GAUSSIAN : SIZE_LOGNORMAL;
    if (which == 0) return read_uniform(jnode_key(&n, "uniform"), z);
    return read_bell(jnode_key(&n, which == 1 ? "gaussian" : "lognormal"), z);
}

/* In x (and y) the cells fill the box; along the last axis they are as low as they can be. */
struct scene_lattice scene_lattice(const struct scene_bodies *b, int dim)
{
    struct scene_lattice l = { .cells = { 1, 1, 1 } };
    double least = 2 * b->spacing * b->size.max;
    for (int i = 0; i < dim; i++) {
        double width = b->box.hi[i] - b->box.lo[i];
        l.cells[i] = floor(width / least * (1 + 1e-12)); // 6.3 mm holds six cells of 1.05 mm
        l.edge[i] = i < dim - 1 ? width / l.cells[i] : least;
    }
    return l;
}

static int check_lattice(const jnode *o, int dim, const struct scene_bodies *b)
{
    jnode box = jnode_key(o, "box");
    for (int i = 0; i < dim; i++) {
        if (!isfinite(b->box.lo[i]) || (i < dim - 1 && !isfinite(b->box.hi[i])))
            return jnode_fault(box, "a lattice may be open above only, %s is not closed",
                               axis_name[i]);
        if (!(b->box.hi[i] - b->box.lo[i] <= 1e9 * b->size.max || i == dim - 1))
            return jnode_fault(box, "too wide for bodies of %g m", b->size.max);
    }
    struct scene_lattice l = scene_lattice(b, dim);
    double places = 1;
    for (int i = 0; i < dim; i++) {
        places *= l.cells[i];
        if (!(l.cells[i] >= 1))
            return jnode_fault(box, "%s is narrower than a cell, %g m", axis_name[i],
                               2 * b->spacing * b->size.max);
    }
    if ((double)b->count <= places) return 0;
    return jnode_fault(jnode_key(o, "count"), "%lld bodies, but the box has cells for %.0f",
                       (long long)b->count, places);
}

static int read_lattice(jnode o, const struct scene *s, bool boxed, struct scene_bodies *b)
{
    if (jnode_only(o, "count radius box spacing jitter thermal v w kind density mass fixed") ||
        jnode_need(&o, boxed ? "radius" : "radius box") ||
        jnode_integer(jnode_key(&o, "count"), 0, INT32_MAX, &b->count) ||
        read_size(jnode_key(&o, "radius"), &b->size) ||
        jnode_number(jnode_key(&o, "spacing"), J_ANY, &b->spacing) ||
        jnode_number(jnode_key(&o, "jitter"), J_UNIT, &b->jitter) ||
        jnode_number(jnode_key(&o, "thermal"), J_NOT_NEGATIVE, &b->thermal))
        return 1;
    if (!(b->spacing >= 1)) return jnode_fault(jnode_key(&o, "spacing"), "must be at least 1");
    jnode box = jnode_key(&o, "box");
    if (box.json && read_box(box, s->dim, &b->box)) return 1;
    return check_lattice(&o, s->dim, b);
}

static int read_one(jnode o, int dim, struct scene_bodies *b)
{
    b->count = 1;
    if (jnode_only(o, "x radius v w kind density mass fixed") || jnode_need(&o, "radius") ||
        jnode_vector(jnode_key(&o, "x"), dim, &b->x) ||
        jnode_number(jnode_key(&o, "radius"), J_POSITIVE, &b->size.min))
        return 1;
    b->size.max = b->size.min;
    return 0;
}

static int read_table(jnode o, struct scene_bodies *b)
{
    const char *name = NULL;
    if (jnode_only(o, "file v w kind density mass fixed") ||
        jnode_text(jnode_key(&o, "file"), &name))
        return 1;
    b->file = strdup(name);
    return b->file ? 0 : why_set(o.in->why, EX_SOFTWARE, "no memory for a file name");
}

static int read_spin(jnode n, int dim, vec3 *w)
{
    return dim == 2 ? jnode_number(n, J_ANY, &w->z) : jnode_vector(n, 3, w);
}

/* What every body of a group has in common. */
static int read_common(jnode o, const struct scene *s, struct scene_bodies *b)
{
    if (jnode_vector(jnode_key(&o, "v"), s->dim, &b->v) ||
        read_spin(jnode_key(&o, "w"), s->dim, &b->w) ||
        read_kind(jnode_key(&o, "kind"), s, &b->kind))
        return 1;
    b->density = s->kind[b->kind].density;
    jnode mass = jnode_key(&o, "mass"), density = jnode_key(&o, "density");
    if (mass.json && density.json) return jnode_fault(mass, "density is given too");
    return jnode_number(density, J_POSITIVE, &b->density) ||
           jnode_number(mass, J_POSITIVE, &b->mass) ||
           jnode_bool(jnode_key(&o, "fixed"), &b->fixed);
}

static int read_group(jnode o, const struct scene *s, const struct scene_box *box,
                      struct scene_bodies *b)
{
    *b = (struct scene_bodies){ .spacing = 1.05, .jitter = 1 };
    if (box) b->box = *box;
    int which = jnode_choice(o, "x count file");
    if (which < 0) return 1;
    b->from = which == 0 ? SCENE_ONE : which == 1 ? SCENE_LATTICE : SCENE_TABLE;
    int bad = which == 0   ? read_one(o, s->dim, b)
              : which == 1 ? read_lattice(o, s, box, b)
                           : read_table(o, b);
    return bad || read_common(o, s, b);
}

static int read_bodies(jnode a, struct scene *s, const struct scene_box *box)
{
    size_t n;
    int64_t total = 0;
    if (jnode_array(a, &n) || !(s->bodies = room(a, n, sizeof *s->bodies))) return 1;
    for (size_t i = 0; i < n; i++) {
        jnode group = jnode_item(&a, i);
        s->groups++;
        if (read_group(group, s, box, &s->bodies[i])) return 1;
        total += s->bodies[i].count;
        if (total > INT32_MAX) return jnode_fault(group, "more than %d bodies", INT32_MAX);
    }
    return 0;
}

/* ---- the whole ---- */

/* The text without the blanks outside its strings. */
static char *compact(const char *text)
{
    char *out = malloc(strlen(text) + 1), *o = out;
    bool inside = false;
    for (const char *s = text; out && *s; s++) {
        if (!inside && strchr(" \t\r\n", *s)) continue;
        if (inside && *s == '\\')
            *o++ = *s++;
        else if (*s == '"')
            inside = !inside;
        *o++ = *s;
    }
    if (out) *o = 0;
    return out;
}

static int read_scene(jnode o, struct scene *s)
{
    int64_t dim = 3, seed = 1;
    double density = 2500;
    bool boxed = false;
    const char *title;
    struct scene_law law = { 0 };
    struct scene_box box = { 0 };
    if (jnode_only(o, "title dim dt theta gravity seed density mu e_n e_t kinds pairs overlap "
                      "bodies walls") ||
        jnode_need(&o, "dt") || jnode_text(jnode_key(&o, "title"), &title) ||
        jnode_integer(jnode_key(&o, "dim"), 2, 3, &dim) ||
        jnode_integer(jnode_key(&o, "seed"), 0, UINT32_MAX, &seed) ||
        jnode_number(jnode_key(&o, "dt"), J_POSITIVE, &s->dt) ||
        jnode_number(jnode_key(&o, "theta"), J_UNIT, &s->theta) ||
        jnode_number(jnode_key(&o, "density"), J_POSITIVE, &density) || read_law(&o, &law) ||
        jnode_bool(jnode_key(&o, "overlap"), &s->overlap))
        return 1;
    s->dim = (int)dim, s->seed = (uint64_t)seed;
    s->g = dim == 2 ? v3(0, -9.81, 0) : v3(0, 0, -9.81);
    return jnode_vector(jnode_key(&o, "gravity"), s->dim, &s->g) ||
           read_kinds(jnode_key(&o, "kinds"), s, density) ||
           read_pairs(jnode_key(&o, "pairs"), s, law) ||
           read_walls(jnode_key(&o, "walls"), s, &box, &boxed) ||
           read_bodies(jnode_key(&o, "bodies"), s, boxed ? &box : NULL);
}

int scene_parse(struct scene *s, const char *text, size_t length, struct why *why)
{
    struct jtext t;
    *s = (struct scene){ .theta = 0.5 };
    if (jtext_parse(&t, text, length, why)) return why->status;
    int bad = read_scene(jtext_root(&t), s);
    if (!bad && !(s->text = compact(t.text)))
        bad = why_set(why, EX_SOFTWARE, "no memory for the scene's text");
    jtext_free(&t);
    if (bad) scene_free(s);
    return why->status;
}

void scene_free(struct scene *s)
{
    for (int32_t k = 0; k < s->kinds; k++) free(s->kind[k].name);
    for (int64_t i = 0; i < s->groups; i++) free(s->bodies[i].file);
    free(s->kind), free(s->law), free(s->bodies), free(s->wall), free(s->text);
    *s = (struct scene){ 0 };
}

/* ---- the paper's examples 2 and 3 ---- */

int scene_paper(struct scene *s, int dim, int64_t n, struct why *why)
{
    char text[1000], y[64] = "";
    bool two = n == 4;
    double share = (double)n / 500;
    double columns = dim == 2 ? 25 * sqrt(share) : 6 * cbrt(share);
    double half = two ? 0.8e-3 : 0.525e-3 * fmax(1, round(columns)); // m, of the box
    if (dim == 3) snprintf(y, sizeof y, "\"y\": [-%.10g, %.10g], ", half, half);
    int length =
        snprintf(text, sizeof text,
                 "{ \"title\": \"Sedimentation of %lld %s%s\",\n"
                 "  \"comment\": \"The paper gives radii, mu and dt. The rest is ours.\",\n"
                 "  \"dim\": %d, \"dt\": %s, \"seed\": %d, \"gravity\": %s,\n"
                 "  \"density\": 2500, \"mu\": 0.3, \"e_n\": 0, \"e_t\": 0,\n"
                 "  \"bodies\": [{ \"count\": %lld, \"radius\": { \"uniform\": [%s, 5e-4] } }],\n"
                 "  \"walls\": [{ \"box\": { \"x\": [-%.10g, %.10g], %s\"%c\": [0, null] } }] }\n",
                 (long long)n, dim == 2 ? "disc" : "ball", n == 1 ? "" : "s", dim,
                 two ? "1e-4" : "5e-5", two ? 9 : 1, dim == 2 ? "[0, -9.81]" : "[0, 0, -9.81]",
                 (long long)n, two ? "4e-4" : "2.5e-4", half, half, y, dim == 2 ? 'y' : 'z');
    return scene_parse(s, text, (size_t)length, why);
}
