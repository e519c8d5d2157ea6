/* draw/paint.c: palettes, sRGB, and the marks. */
#include "draw/paint.h"

#include "base/array.h"
#include "base/json.h"
#include "base/text.h"

#include <errno.h>
#include <float.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

const struct colour_meaning colour_meaning[COLOUR_COUNT] = {
    [COLOUR_RADIUS] = { .name = "radius", .unit = "m" },
    [COLOUR_SPEED] = { .name = "speed", .unit = "m/s", .from_zero = true },
    [COLOUR_MATERIAL] = { .name = "material", .unit = "", .classes = true },
    [COLOUR_ID] = { .name = "id", .unit = "", .classes = true },
    [COLOUR_SPIN] = { .name = "spin", .unit = "rad/s", .from_zero = true },
    [COLOUR_HEIGHT] = { .name = "height", .unit = "m" },
    [COLOUR_MASS] = { .name = "mass", .unit = "kg" },
    [COLOUR_CONTACTS] = { .name = "contacts", .unit = "", .from_zero = true, .given = true },
    [COLOUR_FORCE] = { .name = "force", .unit = "N", .from_zero = true, .given = true },
    [COLOUR_VALUE] = { .name = "value", .unit = "", .given = true },
    [COLOUR_GROUP] = { .name = "group", .unit = "", .classes = true },
    [COLOUR_GENERATION] = { .name = "generation", .unit = "", .from_zero = true },
    [COLOUR_DAMAGE] = { .name = "damage", .unit = "", .from_zero = true },
};

/* Ten colours that are easy to tell apart [Tableau 10] */
static const unsigned ten[10] = { 0x4e79a7, 0xf28e2b, 0xe15759, 0x76b7b2, 0x59a14f,
                                  0xedc948, 0xb07aa1, 0xff9da7, 0x9c755f, 0xbab0ac };

/* The map viridis as polynomials in t, coefficients from t^0 on; within 0.01 of its table. */
static const double viridis[7][3] = {
    { 0.2777273272, 0.0054073445, 0.3340998053 },
    { 0.1050930431, 1.4046135299, 1.3845901626 },
    { -0.3308618287, 0.2148475595, 0.0950951630 },
    { -4.6342304990, -5.7991009734, -19.3324409563 },
    { 6.2282699363, 14.1799333668, 56.6905526007 },
    { 4.7763849977, -13.7451453777, -65.3530326334 },
    { -5.4354558559, 4.6458526122, 26.3124352496 },
};

/* sRGB and linear light, each in [0, 1] [IEC 61966-2-1]. */
static double linear(double s)
{
    return s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4);
}
static double encoded(double l)
{
    return l <= 0.0031308 ? 12.92 * l : 1.055 * pow(l, 1 / 2.4) - 0.055;
}

enum { STEPS = 4096 }; /* of linear light in the table of bytes */
static unsigned char bytes[STEPS + 1];

unsigned char rgb_byte(float light)
{
    return bytes[(int)(fminf(fmaxf(light, 0), 1) * STEPS + 0.5f)];
}

struct rgb rgb_of(unsigned code)
{
    return (struct rgb){ (float)linear((code >> 16 & 255) / 255.0),
                         (float)linear((code >> 8 & 255) / 255.0),
                         (float)linear((code & 255) / 255.0) };
}

struct rgb rgb_mix(struct rgb a, struct rgb b, float t)
{
    return (struct rgb){ a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b) };
}

void paint_init(struct paint *p, enum colour by, bool plain)
{
    p->by = by, p->plain = plain, p->fixed = false, p->lo = INFINITY, p->hi = -INFINITY;
    for (int i = 0; i <= STEPS; i++)
        bytes[i] = (unsigned char)(255 * encoded(i / (double)STEPS) + 0.5);
    for (int i = 0; i < 256; i++) {
        double c[3], t = i / 255.0;
        for (int k = 0; k < 3; k++) {
            c[k] = 0;
            for (int power = 6; power >= 0; power--) c[k] = c[k] * t + viridis[power][k];
            c[k] = linear(fmin(fmax(c[k], 0), 1));
        }
        p->palette[i] = (struct rgb){ (float)c[0], (float)c[1], (float)c[2] };
    }
}

static double length(vec3 a)
{
    return fmin(hypot(hypot(a.x, a.y), a.z), DBL_MAX);
}

/* The number that the palette shows */
static double palette_value(const struct paint *p, const struct packing *k, int64_t i)
{
    switch (p->by) {
    case COLOUR_SPEED:
        return length(k->v[i]);
    case COLOUR_SPIN:
        return length(k->w[i]);
    case COLOUR_HEIGHT:
        return k->dim == 2 ? k->x[i].y : k->x[i].z;
    case COLOUR_MASS:
        return k->mass[i];
    case COLOUR_GENERATION:
        return k->generation ? k->generation[i] : 0;
    case COLOUR_DAMAGE:
        return k->damage ? k->damage[i] : 0;
    case COLOUR_CONTACTS:
    case COLOUR_FORCE:
    case COLOUR_VALUE:
        return p->value[i];
    default:
        return k->radius[i];
    }
}

void paint_range(struct paint *p, const struct packing *k)
{
    const struct colour_meaning *m = &colour_meaning[p->by];
    if (p->fixed || m->classes) return;
    for (int64_t i = 0; i < k->n; i++) {
        double x = palette_value(p, k, i);
        if (isfinite(x)) p->lo = fmin(p->lo, m->from_zero ? fmin(0, x) : x), p->hi = fmax(p->hi, x);
    }
}

struct rgb paint_material(int32_t material)
{
    return rgb_of(ten[material % 10]);
}

struct rgb paint_body(const struct paint *p, const struct packing *k, int64_t i)
{
    if (p->by == COLOUR_MATERIAL) return paint_material(k->material[i]);
    if (p->by == COLOUR_GROUP)
        return k->group && k->group[i] ? paint_material(k->group[i] - 1) : rgb_of(0xb8b8b8);
    if (p->by == COLOUR_ID) return rgb_of(ten[(uint32_t)k->id[i] % 10]);
    double x = palette_value(p, k, i), t = (x - p->lo) / (p->hi - p->lo);
    if (isnan(x)) return rgb_of(0xb8b8b8);
    if (!(p->hi > p->lo)) t = x < p->lo ? 0 : x > p->hi ? 1 : 0.5; // all have one value
    return p->palette[(int)(255 * fmin(fmax(t, 0), 1) + 0.5)];
}

static const struct rgb black = { 0, 0, 0 };

/* Mixed with white on square roots of light, near to what the eye sees as even steps */
static struct rgb pale(struct rgb c)
{
    const float t = 0.42F;
    float r = (1 - t) * sqrtf(c.r) + t, g = (1 - t) * sqrtf(c.g) + t, b = (1 - t) * sqrtf(c.b) + t;
    return (struct rgb){ r * r, g * g, b * b };
}

struct rgb paint_ball(const struct paint *p, struct rgb own, vec3 b)
{
    if (p->plain) return own;
    if (fabs(b.z) > 0.94) return rgb_mix(own, black, 0.6F); // a cap at each pole
    return b.x * b.y > 0 ? pale(own) : own;                 // and four sectors between
}

struct rgb paint_disc(const struct paint *p, struct rgb own, vec3 b)
{
    if (p->plain) return own;
    return b.y > 0 ? pale(own) : own; // the half that is up when the disc is not turned
}

/* ---- sums over contacts, and a table read ---- */

static const char blank[] = " \t\r\n,";

enum {
    LINE = 1 << 20,      /* bytes of a line */
    MOST_PIPED = 1 << 22 /* lines of a table that is no file: 100 MB of memory */
};

/* ---- the table ---- */

static int paint_compare(const void *a, const void *b)
{
    const struct value *x = a, *y = b;
    if (x->step != y->step) return x->step < y->step ? -1 : 1;
    return (x->id > y->id) - (x->id < y->id);
}

static struct value *paint_add_row(struct values *v)
{
    if (!array_grow(&v->row, &v->room, v->n + 1, sizeof *v->row)) return NULL;
    return &v->row[v->n++];
}

struct paint_columns {
    int id, step, x; /* which; -1: not there */
};

/* The first line: names. */
static int paint_read_names(struct values *v, char *line, const char *path, const char *column,
                            struct paint_columns *c, struct failure *failure)
{
    int k = 0;
    *c = (struct paint_columns){ -1, -1, -1 };
    line += mark_length(line, strlen(line));
    line += strspn(line, "# \t");
    for (char *name = strtok(line, blank); name; name = strtok(NULL, blank), k++) {
        if (!strcmp(name, "id")) c->id = k;
        if (!strcmp(name, "step")) c->step = k;
        if (column && strcmp(name, column) != 0) continue;
        c->x = k;
        free(v->name);
        if (!(v->name = strdup(name))) return failure_set(failure, EX_SOFTWARE, "no memory");
    }
    if (c->id < 0) return failure_set(failure, EX_DATAERR, "%s:1: no column is named id", path);
    if (c->x < 0)
        return failure_set(failure, EX_DATAERR, "%s:1: no column is named %s", path, column);
    return 0;
}

static int read_row(struct values *v, char *line, const char *path, int64_t number,
                    const struct paint_columns *c, struct failure *failure)
{
    int k = 0, found = 0;
    struct value *row = paint_add_row(v);
    if (!row) return failure_set(failure, EX_SOFTWARE, "no memory for %s", path);
    *row = (struct value){ .step = -1, .x = NAN };
    for (char *word = strtok(line, blank); word; word = strtok(NULL, blank), k++) {
        char *end;
        if (k != c->id && k != c->step && k != c->x) continue;
        double x = number_read(word, &end);
        bool none = k == c->x && (!strcmp(word, "null") || !strcmp(word, "nan"));
        if ((*end || (k != c->x && !(fabs(x) < 1e15))) && !none)
            return failure_set(failure, EX_DATAERR, "%s:%lld: '%s' is no number", path,
                               (long long)number, word);
        found++;
        if (k == c->id) row->id = (int64_t)x;
        if (k == c->step) row->step = (int64_t)x;
        if (k == c->x) row->x = none ? NAN : x;
    }
    if (found < (c->step < 0 ? 2 : 3) && !(c->id == c->x && found))
        return failure_set(failure, EX_DATAERR, "%s:%lld: too few columns", path,
                           (long long)number);
    return 0;
}

int values_read(struct values *v, const char *path, const char *column, struct failure *failure)
{
    FILE *in = fopen(path, "r");
    struct paint_columns c = { -1, -1, -1 };
    char *line = malloc(LINE);
    struct stat st;
    if (in && !line) failure_set(failure, EX_SOFTWARE, "no memory");
    if (!in) free(line);
    if (!in) return failure_set(failure, EX_NOINPUT, "%s: %s", path, strerror(errno));
    bool file = !fstat(fileno(in), &st) && S_ISREG(st.st_mode);
    for (int64_t number = 1; !failure->status && fgets(line, LINE, in); number++) {
        if (strlen(line) == LINE - 1)
            failure_set(failure, EX_DATAERR, "%s:%lld: a line of more than %d bytes", path,
                        (long long)number, LINE - 2);
        else if (!file && number > MOST_PIPED)
            failure_set(failure, EX_DATAERR,
                        "%s: too many lines for a pipe (endless?): put it into a file", path);
        else if (number == 1)
            paint_read_names(v, line, path, column, &c, failure);
        else if (line[strspn(line, blank)] && *line != '#')
            read_row(v, line, path, number, &c, failure);
    }
    if (!failure->status && ferror(in))
        failure_set(failure, EX_NOINPUT, "%s: %s", path, strerror(errno));
    if (!failure->status && !v->name) failure_set(failure, EX_DATAERR, "%s: empty", path);
    free(line), fclose(in);
    if (v->n) qsort(v->row, (size_t)v->n, sizeof *v->row, paint_compare);
    return failure->status;
}

void values_free(struct values *v)
{
    free(v->name), free(v->row);
    *v = (struct values){ 0 };
}

static double value_at(const struct values *v, int64_t step, int64_t id)
{
    const struct value exact = { step, id, 0 }, any = { -1, id, 0 };
    if (!v || !v->n) return NAN;
    const struct value *found =
        bsearch(&exact, v->row, (size_t)v->n, sizeof *v->row, paint_compare);
    if (!found) found = bsearch(&any, v->row, (size_t)v->n, sizeof *v->row, paint_compare);
    return found ? found->x : NAN;
}

/* ---- of a packing ---- */

void values_of(double *out, enum colour by, const struct packing *p, const struct contacts *s,
               const struct values *values)
{
    bool solved = s && s->found;
    for (int64_t i = 0; i < p->n; i++)
        out[i] = by == COLOUR_VALUE ? value_at(values, p->step, p->id[i]) : solved ? 0 : NAN;
    for (int64_t i = 0; by != COLOUR_VALUE && solved && i < s->n; i++) {
        double f = s->found[i].r[0] / p->dt;
        if (!(f > 0)) continue;
        double x = by == COLOUR_FORCE ? f : 1;
        out[s->c[i].b] += x;
        if (s->c[i].a >= 0) out[s->c[i].a] += x;
    }
}
