#include "scene/grains.h"

#include "base/array.h"
#include "base/json.h"
#include "base/renamed.h"
#include "base/text.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* A quaternion on the unit sphere by rejection: without sines, whose last bits differ between machines */
quat quat_draw(int dim, gsl_rng *rng)
{
    double x[4], sum;
    do {
        sum = 0;
        for (int k = 0; k < 4; k++) {
            x[k] = dim == 2 && (k == 1 || k == 2) ? 0 : 2 * gsl_rng_uniform(rng) - 1;
            sum += x[k] * x[k];
        }
    } while (sum > 1 || sum < 1e-4);
    return quat_unit((quat){ x[0], x[1], x[2], x[3] });
}

quat orientation_draw(const struct scene *s, const struct scene_form *form, gsl_rng *rng)
{
    quat q = form->tumbled ? quat_draw(s->dim, rng) : form->turned;
    return quat_unit(quat_mul(q, s->solid[form->shape].turn));
}

struct grain grain_at(vec3 x, double r)
{
    return (struct grain){ .x = x, .q = { 1, 0, 0, 0 }, .r = r, .material = -1, .id = -1 };
}

int grains_add(struct grains *t, const struct grain *g, struct failure *failure)
{
    if (!array_grow(&t->g, &t->room, t->n + 1, sizeof *t->g))
        return failure_set(failure, EX_SOFTWARE, "no memory for the bodies");
    t->g[t->n++] = *g;
    return 0;
}

void grains_free(struct grains *t)
{
    free(t->g);
    *t = (struct grains){ 0 };
}

/* The scene's material of this name; -1 where it has none */
static int32_t grains_material_named(const struct scene *s, const char *name)
{
    for (int32_t k = 0; k < s->materials; k++)
        if (!strcmp(s->material[k].name, name)) return k;
    return -1;
}

int32_t grains_material(const struct scene *s, const struct scene_bodies *b, int32_t k)
{
    const struct packing *p = b->document;
    if (!b->foreign) return grains_material_named(s, p->material_name[k]);
    for (int32_t i = 0; i < b->types; i++)
        if (!strcmp(b->type[i].name, p->material_name[k])) return b->type[i].material;
    int32_t material = grains_material_named(s, p->material_name[k]);
    return material < 0 && p->materials == 1 && !b->types ? 0 : material;
}

/* material[k]: the scene's material for material k of the document */
static int grains_add_body(struct grains *out, const struct scene_bodies *b,
                           const int32_t *material, int64_t i, struct failure *failure)
{
    const struct packing *p = b->document;
    struct grain g = grain_at(p->x[i], p->radius[i]);
    g.q = p->q[i], g.id = p->id[i];
    g.shape = p->shape ? p->shape[i] : 0;
    g.group = p->group ? p->group[i] : 0;
    g.has_v = g.has_w = true;
    if (!b->at_rest) g.v = p->v[i], g.w = p->w[i];
    g.weighs = true, g.mass = p->mass[i], g.inertia = p->inertia[i], g.fixed = p->mass[i] == 0;
    if (b->foreign && g.mass == 0) g.weighs = g.fixed = false;
    g.material = b->has_material ? b->material : material[p->material[i]];
    if (g.material < 0 && b->foreign)
        return failure_set(
            failure, EX_DATAERR,
            "%s: ball %lld is of type %s: which material is that? \"types\": {\"%s\": NAME}",
            b->file, (long long)i, p->material_name[p->material[i]],
            p->material_name[p->material[i]]);
    if (g.material < 0)
        return failure_set(failure, EX_DATAERR,
                           "%s: body %lld is of material \"%s\": name it under \"materials\"",
                           b->file, (long long)i, p->material_name[p->material[i]]);
    return grains_add(out, &g, failure);
}

int grains_of_document(struct grains *out, const struct scene *s, const struct scene_bodies *b,
                       struct failure *failure)
{
    if (!b->document)
        return failure_set(failure, EX_DATAERR, "%s: a document, which is not read here", b->file);
    if (b->document->dim != s->dim)
        return failure_set(failure, EX_DATAERR, "%s: its dim is %d, and the scene's is %d", b->file,
                           b->document->dim, s->dim);
    int32_t *material = calloc((size_t)b->document->materials + 1, sizeof *material);
    if (!material) return failure_set(failure, EX_SOFTWARE, "no memory for the bodies");
    for (int32_t k = 0; k < b->document->materials; k++) material[k] = grains_material(s, b, k);
    for (int64_t i = 0; i < b->document->n && !failure->status; i++)
        grains_add_body(out, b, material, i, failure);
    free(material);
    return failure->status;
}

/* Tables of bodies: text, a line a body, columns that the first line names. */

enum {
    LINE = 4096,          /* bytes of a line, a comment's too */
    MOST_ROWS = 1 << 27,  /* bodies of a table, */
    MOST_PIPED = 1 << 20, /* and of one that comes through a pipe: a quarter of a GB */
    MOST_LINES = 1 << 24, /* lines of that, comments and empty ones too */
    COLUMNS = 24          /* of a line */
};

enum heading {
    X,
    Y,
    Z,
    R,
    D,
    MASS,
    DENSITY,
    VX,
    VY,
    VZ,
    WX,
    WY,
    WZ,
    QW,
    QX,
    QY,
    QZ,
    ID,
    MATERIAL,
    FIXED,
    NAMES
};
static const char *const column_name[NAMES] = { "x",    "y",       "z",  "r",        "d",
                                                "mass", "density", "vx", "vy",       "vz",
                                                "wx",   "wy",      "wz", "qw",       "qx",
                                                "qy",   "qz",      "id", "material", "fixed" };

struct grains_table {
    const char *path;
    int64_t line; /* its number, from 1 */
    const struct scene *scene;
    int n;                        /* columns */
    enum heading column[COLUMNS]; /* [n] */
    bool has[NAMES];
    bool named;   /* by its first line */
    bool endless; /* perhaps: it is no file, whose size says how long it is */
};

static int grains_fault(const struct grains_table *t, struct failure *failure, const char *trouble,
                        const char *word)
{
    return failure_set(failure, EX_DATAERR, "%s:%lld: %s%s%s%s", t->path, (long long)t->line,
                       trouble, word ? " \"" : "", word ? word : "", word ? "\"" : "");
}

/* The next word of a line, ended by a zero; NULL at its end */
static char *next_word(char **at)
{
    char *s = *at;
    while (isspace((unsigned char)*s)) s++;
    if (!*s) return NULL;
    char *end = s;
    while (*end && !isspace((unsigned char)*end)) end++;
    *at = *end ? end + 1 : end;
    *end = 0;
    return s;
}

static int name_index(const char *word)
{
    for (int k = 0; k < NAMES; k++)
        if (!strcmp(column_name[k], word)) return k;
    const struct renamed *r = renamed_find("column", word, strlen(word));
    return r ? name_index(r->is) : -1;
}

static bool of_space(enum heading c)
{
    return c == Z || c == VZ || c == WX || c == WY;
}

static int grains_add_column(struct grains_table *t, char *word, struct failure *failure)
{
    int k = name_index(word);
    if (k < 0) return grains_fault(t, failure, "no column is called", word);
    if (t->has[k]) return grains_fault(t, failure, "named twice: the column", word);
    if (t->scene->dim == 2 && of_space((enum heading)k))
        return grains_fault(t, failure, "the scene's dim is 2, there is no column", word);
    t->has[k] = true;
    t->column[t->n++] = (enum heading)k; // at most NAMES, for none comes twice
    return 0;
}

/* The columns that the first line, a comment, names: if its first two words are names. */
static int grains_read_names(struct grains_table *t, char *line, struct failure *failure)
{
    char copy[LINE], *at = strcpy(copy, line), *first = next_word(&at), *second = next_word(&at);
    if (!first || !second || name_index(first) < 0 || name_index(second) < 0) return 0;
    t->n = 0, t->named = true;
    memset(t->has, 0, sizeof t->has);
    char *word;
    for (at = line; (word = next_word(&at));)
        if (grains_add_column(t, word, failure)) return failure->status;
    for (int k = X; k <= Z; k++)
        if (!t->has[k] && !(k == Z && t->scene->dim == 2))
            return grains_fault(t, failure, "there is no column", column_name[k]);
    if (!t->has[R] && !t->has[D]) return grains_fault(t, failure, "there is no column", "r");
    if (t->has[R] && t->has[D]) return grains_fault(t, failure, "both r and", "d");
    if (t->has[MASS] && t->has[DENSITY])
        return grains_fault(t, failure, "both mass and", "density");
    int q = t->has[QW] + t->has[QX] + t->has[QY] + t->has[QZ];
    return !q || q == 4 ? 0 : grains_fault(t, failure, "an orientation is qw qx qy qz", NULL);
}

static void usual_columns(struct grains_table *t)
{
    static const enum heading usual[] = { X, Y, Z, R };
    t->n = 0;
    for (int k = 0; k < 4; k++)
        if (t->scene->dim == 3 || usual[k] != Z)
            t->column[t->n++] = usual[k], t->has[usual[k]] = true;
}

/* ---- a line ---- */

static int fault_usual(const struct grains_table *t, struct failure *failure)
{
    return grains_fault(t, failure, t->scene->dim == 2 ? "needs x y r" : "needs x y z r", NULL);
}

static int read_number(const struct grains_table *t, enum heading c, const char *word, double *x,
                       struct failure *failure)
{
    char *end, text[80];
    *x = number_read(word, &end);
    if (*end && !t->named) return fault_usual(t, failure);
    snprintf(text, sizeof text, "%s: not a number:", column_name[c]);
    if (*end) return grains_fault(t, failure, text, word);
    snprintf(text, sizeof text, "%s: not finite", column_name[c]);
    if (!isfinite(*x)) return grains_fault(t, failure, t->named ? text : "not finite", NULL);
    snprintf(text, sizeof text, "the %s must be positive", c == R ? "radius" : column_name[c]);
    bool positive = c == R || c == D || c == MASS || c == DENSITY;
    if (positive && !(*x > 0)) return grains_fault(t, failure, text, NULL);
    bool whole = *x == floor(*x) && *x >= 0 && *x <= INT32_MAX;
    if (c == ID && !whole) return grains_fault(t, failure, "an id must be a whole number:", word);
    if (c == FIXED && *x != 0 && *x != 1)
        return grains_fault(t, failure, "fixed must be 0 or 1:", word);
    return 0;
}

static int grains_read_material(const struct grains_table *t, const char *word, int32_t *material,
                                struct failure *failure)
{
    for (int32_t k = 0; k < t->scene->materials; k++) {
        if (strcmp(t->scene->material[k].name, word) != 0) continue;
        *material = k;
        return 0;
    }
    return grains_fault(t, failure, "the scene names no material", word);
}

static int make_grain(const struct grains_table *t, const double *x, struct grain *g,
                      struct failure *failure)
{
    *g = grain_at(v3(x[X], x[Y], x[Z]), t->has[D] ? 0.5 * x[D] : x[R]);
    g->mass = x[MASS], g->density = x[DENSITY];
    g->v = v3(x[VX], x[VY], x[VZ]), g->w = v3(x[WX], x[WY], x[WZ]);
    g->has_v = t->has[VX] || t->has[VY] || t->has[VZ];
    g->has_w = t->has[WX] || t->has[WY] || t->has[WZ];
    g->fixed = x[FIXED] != 0;
    if (t->has[ID]) g->id = (int32_t)x[ID];
    if (!t->has[QW]) return 0;
    quat q = { x[QW], x[QX], x[QY], x[QZ] };
    double length = sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    if (!(fabs(length - 1) < 1e-3))
        return grains_fault(t, failure, "qw qx qy qz is no unit quaternion", NULL);
    g->q = quat_unit(q);
    return 0;
}

static int read_line(struct grains_table *t, char *line, struct grains *out,
                     struct failure *failure)
{
    double x[NAMES] = { 0 };
    int32_t material = -1;
    char *word, *at = line, *comment = strchr(line, '#');
    struct grain g;
    int n = 0;
    if (comment) *comment = 0;
    for (; (word = next_word(&at)); n++) {
        if (n == t->n) break;
        enum heading c = t->column[n];
        if (c == MATERIAL ? grains_read_material(t, word, &material, failure)
                          : read_number(t, c, word, &x[c], failure))
            return failure->status;
    }
    if (!n) return 0;
    if (word || n != t->n)
        return t->named ? grains_fault(t, failure, "not as many words as columns", NULL)
                        : fault_usual(t, failure);
    if (out->n == MOST_ROWS) return grains_fault(t, failure, "a table of too many bodies", NULL);
    if (t->endless && out->n == MOST_PIPED)
        return grains_fault(
            t, failure, "too many bodies for a pipe (endless?): put the table into a file", NULL);
    if (make_grain(t, x, &g, failure)) return failure->status;
    g.material = material;
    return grains_add(out, &g, failure);
}

/* A line of a table without its newline; false at the end, and where it is too long. */
static bool grains_next_line(FILE *f, char line[LINE], const struct grains_table *t,
                             struct failure *failure)
{
    size_t n = 0;
    int c = 0;
    while (n < LINE - 1 && (c = getc(f)) != EOF && c != '\n') line[n++] = c ? (char)c : '?';
    line[n] = 0;
    if (n == LINE - 1)
        return failure_set(failure, EX_DATAERR, "%s:%lld: a line of more than %d bytes", t->path,
                           (long long)t->line, LINE - 2),
               false;
    return n || c != EOF;
}

static int read_lines(struct grains_table *t, FILE *f, struct grains *out, struct failure *failure)
{
    char line[LINE] = "";
    for (t->line = 1; !failure->status && grains_next_line(f, line, t, failure); t->line++) {
        if (t->endless && t->line > MOST_LINES)
            return grains_fault(t, failure,
                                "too many lines for a pipe (endless?): put the table into a file",
                                NULL);
        char *s = line + (t->line == 1 ? mark_length(line, strlen(line)) : 0);
        s += strspn(s, " \t\r\v\f");
        if (t->line == 1 && *s == '#')
            grains_read_names(t, s + 1, failure);
        else
            read_line(t, s, out, failure);
    }
    return failure->status;
}

static int grains_read_table(struct grains *out, const struct scene *s, const char *path,
                             struct failure *failure)
{
    struct stat st;
    struct grains_table t = { .path = path, .scene = s };
    usual_columns(&t);
    FILE *f = fopen(path, "r");
    if (!f) return failure_set(failure, EX_NOINPUT, "%s: %s", path, strerror(errno));
    if (fstat(fileno(f), &st)) st.st_mode = 0;
    if (S_ISCHR(st.st_mode) || S_ISBLK(st.st_mode))
        failure_set(failure, EX_NOINPUT, "%s: a device is no table", path);
    t.endless = !S_ISREG(st.st_mode);
    if (!failure->status) read_lines(&t, f, out, failure);
    if (!failure->status && ferror(f))
        failure_set(failure, EX_NOINPUT, "%s: %s", path, strerror(errno));
    fclose(f);
    return failure->status;
}

int grains_of_table(struct grains *out, const struct scene *s, const char *dir, const char *name,
                    struct failure *failure)
{
    char *path = scene_path(dir, name);
    if (!path) return failure_set(failure, EX_SOFTWARE, "no memory for a name");
    grains_read_table(out, s, path, failure);
    free(path);
    return failure->status;
}
