/* scene/keys.c: objects of a scene by their tables. */
#include "scene/keys.h"

#include "base/nearest.h"
#include "base/renamed.h"
#include "base/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    ROWS_MOST = 64 /* of an object, those of included tables too */
};

/* A row, and where its member lies */
struct row {
    const struct key *key;
    size_t at;
};

/* By its name, or by that of version 1 */
static jnode value_of(const jnode *o, const char *name)
{
    const jnode value = json_node_key(o, name);
    const struct renamed *r = NULL;
    for (int k = 0; !value.json && (r = renamed_at(k)); k++)
        if (r->accepted && words_have(r->in, "scene", 5) && !strcmp(r->is, name))
            return json_node_key(o, r->was);
    return value;
}

bool keys_has(const jnode *o, const char *key)
{
    return value_of(o, key).json;
}

/* Has o one of these keys? */
static bool has_one(const jnode *o, const char *names)
{
    const char *key;
    json_t *value;
    json_object_foreach(o->json, key, value)
    {
        const struct renamed *r = renamed_find("scene", key, strlen(key));
        const char *is = r && r->accepted ? r->is : key;
        if (words_have(names, is, strlen(is))) return true;
    }
    return false;
}

/* The rows of a table for scenes of that dimension */
static int gather(const struct keys *t, int dim, size_t at, struct row *row, int n)
{
    for (const struct key *k = t->key; k->name; k++)
        if (k->type == &key_include)
            n = gather(k->object, dim, at + k->at, row, n);
        else if ((!k->dim || k->dim == dim) && n < ROWS_MOST)
            row[n++] = (struct row){ k, at + k->at };
    return n;
}

static bool is_allowed(const jnode *o, const struct key *k)
{
    return (!k->with || has_one(o, k->with)) && !(k->without && has_one(o, k->without));
}

static bool is_needed(const jnode *o, const struct key *k)
{
    if (k->needed && has_one(o, k->needed)) return true;
    if (k->unless && has_one(o, k->unless)) return false;
    return k->otherwise && !strcmp(k->otherwise, REQUIRED) && !k->choice && is_allowed(o, k);
}

/* ---- the messages ---- */

static void add_name(char *list, size_t room, const char *name)
{
    const size_t n = strlen(list);
    snprintf(list + n, room - n, "%s%s", n ? " " : "", name);
}

static int check_choice(jnode o, const struct row *row, int n, int choice)
{
    char names[200] = "";
    int found = 0, keys = 0;
    for (int i = 0; i < n; i++) {
        if (abs(row[i].key->choice) != choice || row[i].key->with) continue;
        add_name(names, sizeof names, row[i].key->name);
        keys++, found += keys_has(&o, row[i].key->name);
    }
    if (!keys || found == 1) return 0;
    for (int i = 0; i < n; i++)
        if (row[i].key->choice == -choice && !found) return 0;
    return json_node_fault(o,
                           json_is_object(o.json) ? "needs one of the keys %s"
                                                  : "needs an object with one of the keys %s",
                           names);
}

/* At least one of the keys that are marked so */
static int check_some(jnode o, const struct row *row, int n)
{
    char names[200] = "";
    for (int i = 0; i < n; i++) {
        if (!row[i].key->some) continue;
        if (keys_has(&o, row[i].key->name)) return 0;
        add_name(names, sizeof names, row[i].key->name);
    }
    return *names ? json_node_fault(o, "needs at least one of the keys %s", names) : 0;
}

/* A key that would be known beside another one */
static int misplaced_key(jnode o, const struct key *k)
{
    const jnode n = json_node_key(&o, k->name);
    const bool lacks = k->with && !has_one(&o, k->with);
    if (k->why && !(lacks && k->without)) return json_node_fault(n, "%s", k->why);
    if (lacks) return json_node_fault(n, "goes with %s", k->with);
    return json_node_fault(n, "does not go with %s", k->without);
}

/* Does a key go with an alternative that is not chosen? */
static bool is_elsewhere(const jnode *o, const struct key *k, const struct row *row, int n)
{
    for (int i = 0; i < n && k->with; i++)
        if (row[i].key->choice && words_have(k->with, row[i].key->name, strlen(row[i].key->name)))
            return !is_allowed(o, k);
    return false;
}

/* A key of version 1: refused, or accepted where its new name is not given too */
static int check_renamed(jnode o, const char *key, const struct renamed *r)
{
    if (r->accepted && !json_object_get(o.json, r->is)) return 0;
    return json_node_fault(
        json_node_key(&o, key),
        r->accepted ? "now called \"%s\", which is given, too" : "now called \"%s\"", r->is);
}

static bool is_row(const char *key, const struct row *row, int n)
{
    for (int i = 0; i < n; i++)
        if (!strcmp(key, row[i].key->name)) return true;
    return false;
}

static int unknown_key(jnode o, const char *key, const struct row *row, int n)
{
    const struct renamed *r = renamed_find("scene", key, strlen(key));
    if (r && is_row(r->is, row, n)) return check_renamed(o, key, r);

    char names[250] = "";
    struct nearest near = { 0 };
    for (int i = 0; i < n; i++) {
        const struct key *k = row[i].key;
        if (is_elsewhere(&o, k, row, n) || words_have(names, k->name, strlen(k->name))) continue;
        nearest_look(&near, key, strlen(key), k->name);
        add_name(names, sizeof names, k->name);
    }
    if (near.name)
        return json_node_fault(json_node_key(&o, key),
                               "unknown key; did you mean \"%s\"? known here: %s", near.name,
                               names);
    return json_node_fault(json_node_key(&o, key), "unknown key; known here: %s", names);
}

static int keys_check_names(jnode o, const struct row *row, int n)
{
    const char *key;
    json_t *value;
    json_object_foreach(o.json, key, value)
    {
        bool known = !strcmp(key, "comment");
        const struct key *misplaced = NULL;
        for (int i = 0; i < n && !known; i++) {
            if (strcmp(key, row[i].key->name) != 0) continue;
            known = is_allowed(&o, row[i].key);
            misplaced = row[i].key;
        }
        if (!known && misplaced) return misplaced_key(o, misplaced);
        if (!known && unknown_key(o, key, row, n)) return 1;
    }
    for (int i = 0; i < n; i++)
        if (is_needed(&o, row[i].key) && !keys_has(&o, row[i].key->name))
            return json_node_fault(json_node_key(&o, row[i].key->name), "is missing");
    return 0;
}

static int check_object(jnode o, const struct row *row, int n)
{
    if (check_choice(o, row, n, 1) || check_choice(o, row, n, 2)) return 1;
    if (!json_is_object(o.json)) return json_node_fault(o, "needs an object {...}");
    return keys_check_names(o, row, n) || check_some(o, row, n);
}

/* ---- reading ---- */

/* Which of the forms an object has, by the first key of each */
static const struct keys *form_of(jnode o, const struct keys *t)
{
    struct row row[ROWS_MOST] = { 0 };
    struct key first[ROWS_MOST];
    int n = 0;
    for (; n < ROWS_MOST && t->forms[n]; n++) {
        first[n] = (struct key){ .name = t->forms[n]->key->name, .choice = 1 };
        row[n].key = &first[n];
    }
    if (check_choice(o, row, n, 1)) return NULL;
    for (int i = 0; i < n; i++)
        if (keys_has(&o, first[i].name)) return t->forms[i];
    return NULL;
}

/* What follows from several keys: first of included tables */
static int finish(const struct keys *t, jnode o, struct scene *s, char *out)
{
    for (const struct key *k = t->key; k->name; k++)
        if (k->type == &key_include && finish(k->object, o, s, out + k->at)) return 1;
    return t->finish && t->finish(o, s, out);
}

int keys_read(jnode o, const struct keys *t, struct scene *s, void *out)
{
    struct row row[ROWS_MOST];
    if (t->forms) return !(t = form_of(o, t)) || keys_read(o, t, s, out);
    const int n = gather(t, s->dim, 0, row, 0);
    if (check_object(o, row, n)) return 1;
    for (int i = 0; i < n && !t->keeps; i++)
        if (row[i].key->type->preset && row[i].key->otherwise)
            row[i].key->type->preset(row[i].key, (char *)out + row[i].at);
    for (int i = 0; i < n; i++) {
        const struct key *k = row[i].key;
        jnode value = value_of(&o, k->name);
        void *member = (char *)out + row[i].at;
        if (!value.json && !k->always) continue;
        if (k->read ? k->read(value, s, member) : k->type->read(value, k, s, member)) return 1;
    }
    return finish(t, o, s, out);
}

int keys_each(jnode a, struct scene *s, void *out, int (*read)(jnode n, struct scene *s, void *out))
{
    size_t n = 0;
    if (json_node_array(a, &n)) return 1;
    for (size_t i = 0; i < n; i++)
        if (read(json_node_item(&a, i), s, out)) return 1;
    return 0;
}

/* ---- types ---- */

const struct key_type key_include = { .words = "keys" };

static int keys_read_number(jnode n, const struct key *k, struct scene *s, void *member)
{
    double *x = member;
    (void)s;
    if (json_node_number(n, k->type->range, x)) return 1;
    if ((k->least == 0 && k->most == 0) || (*x >= k->least && *x <= k->most)) return 0;
    if (k->limit) return json_node_fault(n, "%s", k->limit);
    return isfinite(k->most) ? json_node_fault(n, "must lie in [%g, %g]", k->least, k->most)
                             : json_node_fault(n, "must be at least %g", k->least);
}

static void preset_number(const struct key *k, void *member)
{
    char *end;
    const double x = number_read(k->otherwise, &end);
    if (end != k->otherwise && !*end) *(double *)member = x;
}

#define NUMBER(words, schema, range)                                                               \
    words, "{'type': 'number'" schema "}", keys_read_number, preset_number, NULL, range

const struct key_type key_number = { NUMBER("number", "", J_ANY) };
const struct key_type key_positive = { NUMBER("number > 0", ", 'exclusiveMinimum': 0",
                                              J_POSITIVE) };
const struct key_type key_not_negative = { NUMBER("number >= 0", ", 'minimum': 0",
                                                  J_NOT_NEGATIVE) };
const struct key_type key_share = { NUMBER("number 0 to 1", ", 'minimum': 0, 'maximum': 1",
                                           J_UNIT) };

static int read_integer(jnode n, const struct key *k, struct scene *s, void *member)
{
    (void)s;
    return json_node_integer(n, (int64_t)k->least, (int64_t)k->most, member);
}

static void preset_integer(const struct key *k, void *member)
{
    char *end;
    const long long x = strtoll(k->otherwise, &end, 10);
    if (end != k->otherwise && !*end) *(int64_t *)member = x;
}

const struct key_type key_integer = { "integer", "{'type': 'integer'}", read_integer,
                                      preset_integer };

static int read_bool(jnode n, const struct key *k, struct scene *s, void *member)
{
    (void)k, (void)s;
    return json_node_bool(n, member);
}

static void preset_bool(const struct key *k, void *member)
{
    if (!strcmp(k->otherwise, "true") || !strcmp(k->otherwise, "false"))
        *(bool *)member = *k->otherwise == 't';
}

const struct key_type key_bool = { "true or false", "{'type': 'boolean'}", read_bool, preset_bool };

static int keys_read_text(jnode n, const struct key *k, struct scene *s, void *member)
{
    (void)k, (void)s;
    return json_node_text(n, member);
}

const struct key_type key_text = { "string", "{'type': 'string'}", keys_read_text, NULL };

static int read_file(jnode n, const struct key *k, struct scene *s, void *member)
{
    const char *name = NULL;
    char **out = member;
    (void)k, (void)s;
    if (json_node_text(n, &name)) return 1;
    free(*out);
    *out = strdup(name);
    return *out ? 0 : failure_set(n.in->failure, EX_SOFTWARE, "no memory for a file name");
}

const struct key_type key_file = { "string", "{'type': 'string'}", read_file, NULL };

static int keys_read_word(jnode n, const struct key *k, struct scene *s, void *member)
{
    (void)s;
    return json_node_word(n, k->words, member);
}

const struct key_type key_word = { "string", NULL, keys_read_word, NULL };

static int keys_read_vector(jnode n, const struct key *k, struct scene *s, void *member)
{
    vec3 *v = member;
    if (json_node_vector(n, s->dim, v)) return 1;
    if (k->type != &key_direction) return 0;
    // scaled by its largest component, so that no square overflows
    const double most = fmax(fabs(v->x), fmax(fabs(v->y), fabs(v->z)));
    if (!(most > 0)) return json_node_fault(n, "must not be zero");
    *v = v3(v->x / most, v->y / most, v->z / most);
    const double length = v3_norm(*v);
    *v = v3(v->x / length, v->y / length, v->z / length);
    return 0;
}

const struct key_type key_vector = { "vector", "{'$ref': 'vector'}", keys_read_vector, NULL };
const struct key_type key_direction = { "vector", "{'$ref': 'direction'}", keys_read_vector, NULL };

static int read_spin(jnode n, const struct key *k, struct scene *s, void *member)
{
    vec3 *w = member;
    return s->dim == 2 ? json_node_number(n, J_ANY, &w->z) : keys_read_vector(n, k, s, member);
}

const struct key_type key_spin = { "vector; 2D: number", "{'$ref': 'spin'}", read_spin, NULL };

int keys_read_array(jnode n, const struct key *k, struct scene *s, void *member)
{
    const struct key_type *array = k->type;
    const size_t count = (size_t)keys_count(array, s->dim);
    struct key item = *k;
    size_t has;
    if (json_node_array(n, &has)) return 1;
    if (has != count && *array->words == '[') return json_node_fault(n, "needs %s", array->words);
    if (has != count)
        return json_node_fault(n, "needs an array of %zu: %s", count, array->item->words);
    item.type = array->item;
    for (size_t i = 0; i < count; i++)
        if (array->item->read(json_node_item(&n, i), &item, s, (char *)member + i * array->size))
            return 1;
    return 0;
}

int keys_read_rows(jnode list, double *row)
{
    for (size_t i = 0; i < json_array_size(list.json); i++, row += 2) {
        const jnode pair = json_node_item(&list, i), t = json_node_item(&pair, 0);
        size_t two = 0;
        if (json_node_array(pair, &two)) return 1;
        if (two != 2) return json_node_fault(pair, "needs [time, value]");
        if (json_node_number(t, J_ANY, &row[0]) ||
            json_node_number(json_node_item(&pair, 1), J_ANY, &row[1]))
            return 1;
        if (i && !(row[0] > row[-2])) return json_node_fault(t, "times must rise");
    }
    return 0;
}

const struct key_type key_lengths = { ARRAY("vector", &key_positive, 0, sizeof(double)) };
const struct key_type key_two_positive = { ARRAY("two numbers > 0", &key_positive, 2,
                                                 sizeof(double)) };
const struct key_type key_min_max = { ARRAY("[min, max]", &key_positive, 2, sizeof(double)) };
const struct key_type key_matrix = { ARRAY("MATRIX", &key_vector, 0, sizeof(vec3)) };

static int read_object(jnode n, const struct key *k, struct scene *s, void *member)
{
    return keys_read(n, k->object, s, member);
}

const struct key_type key_object = { "object", NULL, read_object, NULL };
const struct key_type key_list = { "array", NULL, NULL, NULL };
const struct key_type key_map = { "object", NULL, NULL, NULL };
