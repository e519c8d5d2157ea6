#include "measure/measures.h"

#include "base/nearest.h"
#include "base/renamed.h"
#include "base/text.h"
#include "measure/follow.h"
#include "measure/photo.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { OLD_MEASURES = 8, MOST_QUANTITIES = 20 }; /* more than there are */

static const struct measure *const measures[] = {
    &measure_fraction,
    &measure_coordination,
    &measure_contact_numbers,
    &measure_fabric,
    &measure_stress,
    &measure_wall_forces,
    &measure_energy,
    &measure_temperature,
    &measure_profile,
    &measure_friction,
    &measure_normal_forces,
    &measure_tangential_forces,
    &measure_mobilised,
    &measure_pairs,
    &measure_sizes,
    &measure_segregation,
    &measure_displacement,
    &measure_surface,
    &measure_flux,
    &measure_grains,
    &measure_strain,
    &measure_names,
    &measure_sums,
    &measure_sums_by_name,
    &measure_sums_by_face,
    &measure_mixing,
    &measure_residence,
    &measure_departures,
    &measure_lifetimes,
    &measure_separations,
    &measure_silhouette,
    &measure_breakage,
    &measure_grading,
    NULL,
};

const struct measure *measure_at(int k)
{
    return measures[k];
}

/* A measure under its old name, with the old names of its quantities: scripts that ask for it read these. One more for each
   old name [base/renamed.h]. */
static const struct measure *measure_renamed(const struct renamed *r, const struct measure *is)
{
    static _Thread_local struct measure old[OLD_MEASURES];
    static _Thread_local struct quantity quantity[OLD_MEASURES][MOST_QUANTITIES + 1];
    int k = 0, q = 0;
    while (k < OLD_MEASURES && old[k].name && strcmp(old[k].name, r->was) != 0) k++;
    if (k == OLD_MEASURES) return is;
    old[k] = *is, old[k].name = r->was;
    for (; q < MOST_QUANTITIES && is->quantity[q].name; q++) {
        quantity[k][q] = is->quantity[q];
        for (int row = 0; (r = renamed_at(row)); row++)
            if (!strcmp(r->in, "quantity") && !strcmp(r->is, is->quantity[q].name))
                quantity[k][q].name = r->was;
    }
    old[k].quantity = quantity[k];
    return &old[k];
}

const struct measure *measure_named(const char *name, size_t n)
{
    const struct renamed *r = renamed_find("measure", name, n);
    const char *is = r ? r->is : name;
    if (r) n = strlen(is);
    for (int k = 0; measures[k]; k++)
        if (!strncmp(measures[k]->name, is, n) && !measures[k]->name[n])
            return r ? measure_renamed(r, measures[k]) : measures[k];
    return NULL;
}

/* Why this cannot be measured here, or NULL */
static const char *lacks(const struct snapshot *s, enum needs needs)
{
    if (!s->p->n) return "the frame has no bodies";
    if (needs == NEEDS_SUMS && !s->p->sums.n)
        return "the document has no sums over steps: nsd-step --wall-loads keeps them";
    if ((needs == NEEDS_CONTACTS || needs == NEEDS_FORCES || needs == NEEDS_CONTACTS_BEFORE) &&
        !s->s)
        return "the frame has no contacts: steps find them, and nsd-step --contacts keeps them";
    if ((needs == NEEDS_BEFORE || needs == NEEDS_CONTACTS_BEFORE) && !s->before)
        return "no previous frame";
    if (needs == NEEDS_CONTACTS_BEFORE && !s->before->pair)
        return "the contacts of the previous frame were not read";
    if (needs == NEEDS_FORCES && !s->s->found && s->s->n)
        return "the contacts are not solved: use nsd-solve first";
    return NULL;
}

int measure_run(struct table *t, const struct measure *m, const struct snapshot *s,
                struct failure *failure)
{
    table_init(t, m->quantity);
    t->names = &s->p->names;
    const char *lack = lacks(s, m->needs);
    if (lack) {
        table_null(t, "%s", lack);
        return 0;
    }
    if (m->rows(t, s, failure)) return failure->status;
    const struct quantity *q = m->quantity;
    for (int k = 0, in = 0; k < t->width; k++, in++) {
        if (in == q->width) q++, in = 0;
        for (int64_t i = 0; i < t->rows && !quantity_is_name(q); i++)
            if (!isfinite(t->x[i * t->width + k]))
                table_null(t, "the value is out of the range of numbers");
    }
    return 0;
}

/* As many finite numbers as there are, from `least` to `most`, by commas; how many, or 0 with the reason */
static int measures_numbers(const char *name, const char *text, double *x, int least, int most,
                            struct failure *failure)
{
    const char *s = text;
    char *end;
    for (int k = 0; k < most; k++, s = end + 1) {
        x[k] = number_read(s, &end);
        if (end == s || !isfinite(x[k])) break;
        if (!*end && k + 1 >= least) return k + 1;
        if (*end != ',') break;
    }
    failure_set(failure, EX_USAGE, "--%s: '%s' is not %d numbers with commas between", name, text,
                most);
    return 0;
}

static int measures_set_box(struct asked *a, const char *name, const char *text,
                            struct failure *failure)
{
    double b[6] = { 0, 0, 0, 0, -INFINITY, INFINITY };
    int n = measures_numbers(name, text, b, 4, 6, failure);
    if (!n) return failure->status;
    if (n == 5) return failure_set(failure, EX_USAGE, "--box: '%s' has five numbers", text);
    for (int k = 0; k < n / 2; k++)
        if (!(b[2 * k] < b[2 * k + 1]))
            return failure_set(failure, EX_USAGE, "--box: '%s' is empty", text);
    for (int k = 0; k < 3; k++) a->lo[k] = b[2 * k], a->hi[k] = b[2 * k + 1];
    a->boxed = true;
    return 0;
}

static int set_layers(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    const char axes[] = "xyzr", *axis = *text ? strchr(axes, *text) : NULL;
    char *end = NULL;
    double n = axis && text[1] == ':' ? number_read(text + 2, &end) : 0;
    if (!end || *end || !(n >= 1 && n <= 1e6) || n != floor(n))
        return failure_set(failure, EX_USAGE, "--%s: '%s' is not x:N, y:N, z:N or r:N", name, text);
    a->axis = (int)(axis - axes), a->layers = (int64_t)n;
    return 0;
}

static int set_point(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    double x[3] = { 0 };
    if (!measures_numbers(name, text, x, 2, 3, failure)) return failure->status;
    a->point = v3(x[0], x[1], x[2]);
    return 0;
}

static int set_plane(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    double x[3] = { 0 };
    if (!measures_numbers(name, text, x, 2, 3, failure)) return failure->status;
    vec3 n = v3(x[0], x[1], x[2]);
    double size = v3_norm(n);
    if (!(size > 0 && size < INFINITY))
        return failure_set(failure, EX_USAGE, "--%s: '%s' is no direction", name, text);
    a->normal = v3_scale(1 / size, n);
    return 0;
}

/* Above 0 */
static int measures_set_number(double *to, const char *name, const char *text,
                               struct failure *failure)
{
    char *end;
    double x = number_read(text, &end);
    if (end == text || *end || !(x > 0))
        return failure_set(failure, EX_USAGE, "--%s: '%s' is not a number above 0", name, text);
    *to = x;
    return 0;
}

static int set_radius(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    return measures_set_number(&a->radius, name, text, failure);
}

static int set_distance(struct asked *a, const char *name, const char *text,
                        struct failure *failure)
{
    double x = 0;
    if (measures_set_number(&x, name, text, failure)) return failure->status;
    if (!isfinite(x)) return failure_set(failure, EX_USAGE, "--%s: %s must be finite", name, text);
    a->distance = x;
    return 0;
}

static int set_bins(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    double x = 0;
    if (measures_set_number(&x, name, text, failure)) return failure->status;
    if (x != floor(x) || x > 1e6)
        return failure_set(failure, EX_USAGE, "--%s: %s must be a whole number, 1 to 1e6", name,
                           text);
    a->bins = (int64_t)x;
    return 0;
}

static int set_only(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    size_t n = strlen(text);
    if (!n || n >= sizeof a->only)
        return failure_set(failure, EX_USAGE, "--%s: needs names, at most %zu bytes", name,
                           sizeof a->only - 1);
    memcpy(a->only, text, n + 1);
    return 0;
}

static int set_finite(double *x, const char *name, const char *text, struct failure *failure)
{
    double given = 0;
    if (measures_set_number(&given, name, text, failure)) return failure->status;
    if (!isfinite(given))
        return failure_set(failure, EX_USAGE, "--%s: %s must be finite", name, text);
    *x = given;
    return 0;
}

static int set_wear(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    return set_finite(&a->wear, name, text, failure);
}

static int set_sample(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    return set_finite(&a->sample, name, text, failure);
}

static int set_tracer(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    if (!*text || strlen(text) >= sizeof a->tracer)
        return failure_set(failure, EX_USAGE, "--%s: '%.40s' is not the name of a kind, or large",
                           name, text);
    memcpy(a->tracer, text, strlen(text) + 1);
    return 0;
}

static int set_view(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    static const char axes[] = "xyz";
    if (strlen(text) != 1 || !strchr(axes, *text))
        return failure_set(failure, EX_USAGE, "--%s: '%s' is not x, y or z", name, text);
    a->view = (int)(strchr(axes, *text) - axes);
    return 0;
}

static int set_window(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    double w[4];
    if (!measures_numbers(name, text, w, 4, 4, failure)) return failure->status;
    const double ratio = (w[1] - w[0]) / (w[3] - w[2]);
    if (!(w[0] < w[1] && w[2] < w[3] && ratio > 1e-3 && ratio < 1e3))
        return failure_set(failure, EX_USAGE, "--%s: '%s' is not LEFT,RIGHT,LOWER,UPPER", name,
                           text);
    memcpy(a->window, w, sizeof w);
    return 0;
}

static int set_pixels(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    double x = 0;
    if (measures_set_number(&x, name, text, failure)) return failure->status;
    if (x != floor(x) || x > PHOTO_MOST)
        return failure_set(failure, EX_USAGE, "--%s: %s must be a whole number, 1 to %d", name,
                           text, PHOTO_MOST);
    a->pixels = (int64_t)x;
    return 0;
}

static int set_photo(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    struct photo photo;
    struct failure why = { 0 };
    if (photo_read(&photo, text, &why))
        return failure_set(failure, EX_USAGE, "--%s: %.300s", name, why.text);
    free(a->photo.grey);
    a->photo = photo;
    return 0;
}

static const struct {
    const char *name;
    int (*set)(struct asked *, const char *name, const char *text, struct failure *);
} settings[] = {
    { "box", measures_set_box },  { "layers", set_layers }, { "point", set_point },
    { "plane", set_plane },       { "radius", set_radius }, { "bins", set_bins },
    { "distance", set_distance }, { "only", set_only },     { "wear", set_wear },
    { "sample", set_sample },     { "tracer", set_tracer }, { "view", set_view },
    { "window", set_window },     { "pixels", set_pixels }, { "photo", set_photo },
};
enum { SETTINGS = sizeof settings / sizeof settings[0] };

const char *asked_name(int k)
{
    return k < SETTINGS ? settings[k].name : NULL;
}

bool asked_has(const char *name)
{
    for (int k = 0; k < SETTINGS; k++)
        if (!strcmp(settings[k].name, name)) return true;
    return false;
}

int asked_set(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    for (int k = 0; k < SETTINGS; k++)
        if (!strcmp(settings[k].name, name)) return settings[k].set(a, name, text, failure);
    return failure_set(failure, EX_USAGE, "--%s: no such option", name);
}

static void measured_choose_one(const struct measure **chosen, const struct measure *m)
{
    int k = 0;
    while (chosen[k] && chosen[k] != m) k++;
    if (k < MOST_MEASURES) chosen[k] = m;
}

static int no_such_measure(const char *name, size_t n, struct failure *failure)
{
    struct nearest near = { 0 };
    for (int k = 0; measures[k]; k++) nearest_look(&near, name, n, measures[k]->name);
    return failure_set(
        failure, EX_USAGE, "--measures: no '%.*s'%s%s%s (nsd-stat --list names them)", (int)n, name,
        near.name ? "; did you mean " : "", near.name ? near.name : "", near.name ? "?" : "");
}

int measured_choose(const struct measure **chosen, const char *names, struct failure *failure)
{
    for (int k = 0; k <= MOST_MEASURES; k++) chosen[k] = NULL;
    for (const char *s = names;; s++) {
        size_t n = strcspn(s, ",");
        const struct measure *m = measure_named(s, n);
        if (n == 3 && !strncmp(s, "all", n))
            for (int k = 0; measure_at(k); k++) measured_choose_one(chosen, measure_at(k));
        else if (!m)
            return no_such_measure(s, n, failure);
        else
            measured_choose_one(chosen, m);
        s += n;
        if (!*s) return 0;
    }
}

bool measured_remember(const struct measure *const *chosen)
{
    for (int k = 0; chosen[k]; k++)
        if (chosen[k]->remembers || chosen[k]->needs == NEEDS_BEFORE ||
            chosen[k]->needs == NEEDS_SUMS || chosen[k]->needs == NEEDS_CONTACTS_BEFORE)
            return true;
    return false;
}

int measured_keep(const struct measure *const *chosen, const struct snapshot *s,
                  struct frame_memory *first, struct frame_memory *before, struct failure *failure)
{
    bool pairs = false;
    struct frame_memory now;
    for (int k = 0; chosen[k]; k++) pairs = pairs || chosen[k]->needs == NEEDS_CONTACTS_BEFORE;
    if (!s->first && frame_memory_set(first, s->p, failure)) return failure->status;
    if (follow(&now, s, pairs, failure)) return failure->status;
    for (int k = 0; chosen[k]; k++)
        if (chosen[k]->keep && chosen[k]->keep(&now, s, failure)) {
            frame_memory_free(&now);
            return failure->status;
        }
    frame_memory_free(before);
    *before = now;
    return 0;
}

/* Can each measure keep to what --only names? Returns 0 or EX_DATAERR. */
static int check_only(const struct measure *const *chosen, const struct snapshot *s,
                      struct failure *failure)
{
    bool used = !s->only.any;
    for (int k = 0; chosen[k]; k++) {
        const enum keeps_to to = chosen[k]->keeps_to;
        if (to == KEEPS_TO_NOTHING && s->only.bodies)
            return failure_set(failure, EX_DATAERR,
                               "--only: %s is measured of all bodies, not of a group or kind",
                               chosen[k]->name);
        used = used || (to == KEEPS_TO_WALLS && s->only.walls) ||
               (to == KEEPS_TO_BODIES && s->only.bodies);
    }
    const char *of = s->only.walls ? "walls" : "bodies";
    if (used) return 0;
    return failure_set(failure, EX_DATAERR, "--only: '%s' names %s, and no measure of %s is chosen",
                       s->asked->only, of, of);
}

int measured_run(struct table *t, const struct measure *const *chosen, const struct snapshot *s,
                 struct failure *failure)
{
    for (int k = 0; k < MOST_MEASURES; k++) t[k] = (struct table){ 0 };
    if (failure->status || check_only(chosen, s, failure)) return failure->status;
    for (int k = 0; chosen[k]; k++)
        if (measure_run(&t[k], chosen[k], s, failure)) return failure->status;
    return 0;
}

void measured_free(struct table *t)
{
    for (int k = 0; k < MOST_MEASURES; k++) table_free(&t[k]);
}

void measured_json(FILE *out, const struct snapshot *s, const struct measure *const *chosen,
                   const struct table *t)
{
    const char *mark = ",\"why\":{";
    fprintf(out, "{\"step\":%" PRId64 ",\"time\":", s->p->step);
    print_number(out, s->p->t, "null");
    fprintf(out, ",\"bodies\":%" PRId64 ",\"contacts\":", s->p->n);
    s->s ? fprintf(out, "%" PRId64, s->s->n) : fprintf(out, "null");
    if (!isnan(s->unconverged)) fprintf(out, ",\"unconverged\":%.0f", s->unconverged);
    for (int k = 0; chosen[k]; k++) {
        fprintf(out, ",\"%s\":", chosen[k]->name);
        table_json(out, &t[k], chosen[k]->list);
    }
    for (int k = 0; chosen[k]; k++)
        if (*t[k].null)
            fprintf(out, "%s\"%s\":\"%s\"", mark, chosen[k]->name, t[k].null), mark = ",";
    fprintf(out, "%s}", *mark == ',' && mark[1] ? "" : "}");
}

const char *measure_unit(const char *name, int dim)
{
    static const char *const plane[][2] = { { "Pa", "N/m" }, { "m2", "m" }, { "m3", "m2" } };
    const char *dot = strchr(name, '.');
    const struct measure *m = dot ? measure_named(name, (size_t)(dot - name)) : NULL;
    for (const struct quantity *q = m ? m->quantity : NULL; q && q->name; q++) {
        size_t n = strlen(q->name);
        if (strncmp(dot + 1, q->name, n) != 0 || (dot[1 + n] && dot[1 + n] != '.')) continue;
        for (int k = 0; dim == 2 && k < 3; k++)
            if (!strcmp(q->unit, plane[k][0])) return plane[k][1];
        return strcmp(q->unit, "1") != 0 ? q->unit : "";
    }
    return "";
}
