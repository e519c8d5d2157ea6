#include "scene/schema.h"

#include "scene/scene_read.h"

#include <stdlib.h>
#include <string.h>

enum { TABLES_MOST = 100 };

/* A schema that is made, of scenes of one dimension */
struct schema {
    int dim;
    json_t *defs; /* all that a $ref names */
    bool bad;     /* there was no memory */
};

/* Types that are not objects, with ' for ". DIM is the dimension. */
static const struct plain {
    const char *name, *text, *plane; /* in the plane; NULL: the same */
} plain[] = {
    { "vector", "{'type': 'array', 'items': {'type': 'number'}, 'minItems': DIM, 'maxItems': DIM}",
      NULL },
    { "direction",
      "{'type': 'array', 'items': {'type': 'number'}, 'minItems': DIM, 'maxItems': DIM, "
      "'not': {'items': {'const': 0}}}",
      NULL },
    { "spin", "{'$ref': 'vector'}", "{'type': 'number'}" },
    { "matrix", "{'type': 'array', 'items': {'$ref': 'vector'}, 'minItems': DIM, 'maxItems': DIM}",
      NULL },
    { "loose_matrix",
      "{'type': 'array', 'items': {'type': 'array', 'items': {'type': ['number', 'null']}, "
      "'minItems': DIM, 'maxItems': DIM}, 'minItems': DIM, 'maxItems': DIM}",
      NULL },
    { "points", "{'type': 'array', 'items': {'$ref': 'vector'}, 'minItems': 2}", NULL },
    { "balls",
      "{'type': 'array', 'minItems': 1, 'maxItems': 4096, 'items': {'type': 'array', "
      "'prefixItems': "
      "[{'type': 'number'}, {'type': 'number'}, {'type': 'number'}, {'$ref': 'positive'}], "
      "'minItems': 4, 'maxItems': 4}}",
      "{'type': 'array', 'minItems': 1, 'maxItems': 4096, 'items': {'type': 'array', "
      "'prefixItems': "
      "[{'type': 'number'}, {'type': 'number'}, {'$ref': 'positive'}], 'minItems': 3, 'maxItems': "
      "3}}" },
    { "positive", "{'type': 'number', 'exclusiveMinimum': 0}", NULL },
    { "polygons",
      "{'type': 'array', 'items': {'type': 'array', 'items': {'type': 'integer', 'minimum': 0}, "
      "'minItems': 3}, 'minItems': 4}",
      NULL },
    { "interval",
      "{'type': 'array', 'items': {'type': ['number', 'null']}, 'minItems': 2, 'maxItems': 2}",
      NULL },
    { "sieve",
      "{'type': 'array', 'items': {'type': 'array', 'prefixItems': [{'type': 'number', "
      "'exclusiveMinimum': 0}, {'type': 'number', 'minimum': 0, 'maximum': 1}], 'minItems': 2, "
      "'maxItems': 2}, 'minItems': 2}",
      NULL },
    { "rows",
      "{'type': 'array', 'items': {'type': 'array', 'items': {'type': 'number'}, 'minItems': 2, "
      "'maxItems': 2}, 'minItems': 1}",
      NULL },
    { "numbers", "{'type': 'array', 'items': {'type': 'number'}}", NULL },
    { "body_ids",
      "{'type': 'array', 'items': {'type': 'integer', 'minimum': 0, 'maximum': 2147483646}}",
      NULL },
    { "id", "{'type': 'integer', 'minimum': 0, 'maximum': 2147483647}", NULL },
    { "ids",
      "{'anyOf': [{'$ref': 'id'}, {'type': 'array', 'items': {'$ref': 'id'}, 'minItems': 1}]}",
      NULL },
    { "names",
      "{'anyOf': [{'type': 'string'}, {'type': 'array', 'items': {'type': 'string'}, 'minItems': "
      "1}]}",
      NULL },
    { "types",
      "{'type': 'object', 'patternProperties': {'^[0-9]+$': {'type': 'string'}, '^comment$': "
      "true}, "
      "'additionalProperties': false}",
      NULL },
    { "shapes",
      "{'type': 'object', 'properties': {'comment': true}, 'additionalProperties': {'$ref': "
      "'shape'}}",
      NULL },
};

static void schema_put(struct schema *to, json_t *object, const char *key, json_t *value)
{
    if (!value || json_object_set_new(object, key, value)) to->bad = true;
}

static void schema_append(struct schema *to, json_t *list, json_t *value)
{
    if (!value || json_array_append_new(list, value)) to->bad = true;
}

/* The member of an object, made where it is not there yet */
static json_t *schema_member(struct schema *to, json_t *object, const char *key,
                             json_t *(*make)(void))
{
    if (!json_object_get(object, key)) schema_put(to, object, key, make());
    return json_object_get(object, key);
}

/* ---- names and texts ---- */

static void schema_define(struct schema *to, const char *name, const struct keys *table);

/* In place of each name after $ref where it is defined */
static void schema_resolve(struct schema *to, json_t *j, const struct keys *table)
{
    const char *key;
    json_t *value;
    for (size_t i = 0; i < json_array_size(j); i++) schema_resolve(to, json_array_get(j, i), table);
    json_object_foreach(j, key, value)
    {
        schema_resolve(to, value, table);
        if (strcmp(key, "$ref") != 0) continue;
        schema_define(to, json_string_value(value), table);
        json_t *at = json_sprintf("#/$defs/%s-%dd", json_string_value(value), to->dim);
        if (!at || json_object_set_new(j, key, at)) to->bad = true;
    }
}

static json_t *schema_parse(struct schema *to, const char *text, const struct keys *table)
{
    char *copy = malloc(strlen(text) + 1), *o = copy;
    for (const char *t = text; copy && *t;) {
        const bool dim = !strncmp(t, "DIM", 3);
        *o++ = dim ? (char)('0' + to->dim) : *t == '\'' ? '"' : *t;
        t += dim ? 3 : 1;
    }
    if (copy) *o = 0;
    json_t *j = copy ? json_loads(copy, 0, NULL) : NULL;
    free(copy);
    if (j) schema_resolve(to, j, table);
    return j;
}

/* ---- a key ---- */

static json_t *ref(struct schema *to, const struct keys *t)
{
    json_t *j = json_pack("{s:s}", "$ref", t->name);
    if (j) schema_resolve(to, j, t);
    return j;
}

static json_t *schema_value(struct schema *to, const struct key *k);

static json_t *array_of(struct schema *to, const struct key *k)
{
    const struct key item = { .type = k->type->item, .least = k->least, .most = k->most };
    const int n = keys_count(k->type, to->dim);
    return json_pack("{s:s, s:o, s:i, s:i}", "type", "array", "items", schema_value(to, &item),
                     "minItems", n, "maxItems", n);
}

static json_t *schema_words(struct schema *to, const char *const *words)
{
    json_t *list = json_array();
    for (; *words; words++) schema_append(to, list, json_string(*words));
    return json_pack("{s:o}", "enum", list);
}

static json_t *bare_value(struct schema *to, const struct key *k)
{
    if (k->type->schema) return schema_parse(to, k->type->schema, k->type->object);
    if (k->type->item) return array_of(to, k);
    if (k->words) return schema_words(to, k->words);
    if (k->type == &key_list)
        return json_pack("{s:s, s:o}", "type", "array", "items", ref(to, k->object));
    if (k->type == &key_map)
        return json_pack("{s:s, s:{s:b}, s:o}", "type", "object", "properties", "comment", 1,
                         "additionalProperties", ref(to, k->object));
    return ref(to, k->object);
}

/* What stands in the table, where it is JSON */
static json_t *literal(struct schema *to, const char *text)
{
    json_error_t e;
    json_t *j = text ? json_loads(text, JSON_DECODE_ANY, &e) : NULL;
    if (text && !j && json_error_code(&e) == json_error_out_of_memory) to->bad = true;
    return j;
}

static json_t *schema_value(struct schema *to, const struct key *k)
{
    json_t *j = bare_value(to, k), *standard = literal(to, k->otherwise),
           *example = literal(to, k->example);
    const bool unit = k->unit && *k->unit && strcmp(k->unit, "-") != 0;
    if (!k->type->item && (k->least != 0 || k->most != 0 || k->type == &key_integer)) {
        schema_put(to, j, "minimum",
                   k->type == &key_integer ? json_integer((json_int_t)k->least)
                                           : json_real(k->least));
        if (isfinite(k->most))
            schema_put(to, j, "maximum",
                       k->type == &key_integer ? json_integer((json_int_t)k->most)
                                               : json_real(k->most));
    }
    if (!k->help) return j; // an item of an array
    schema_put(to, j, "description",
               unit ? json_sprintf("%s [%s]", k->help, k->unit) : json_string(k->help));
    if (standard) schema_put(to, j, "default", standard);
    if (example) schema_put(to, j, "examples", json_pack("[o]", example));
    return j;
}

/* ---- which keys go together ---- */

/* [{"required": [name]}, ...] of names with blanks between, or of the rows with a choice or a mark */
static void append_required(struct schema *to, json_t *list, const char *name, size_t n)
{
    schema_append(to, list, json_pack("{s:[o]}", "required", json_stringn(name, n)));
}

static json_t *any_of(struct schema *to, const char *names)
{
    json_t *list = json_array();
    for (const char *s = names; *s; s += strcspn(s, " ")) {
        s += strspn(s, " ");
        append_required(to, list, s, strcspn(s, " "));
    }
    return json_pack("{s:o}", "anyOf", list);
}

/* k is needed beside each of the names */
static void require_beside(struct schema *to, json_t *object, const char *names,
                           const struct key *k)
{
    json_t *all = schema_member(to, object, "dependentRequired", json_object);
    for (const char *s = names; *s; s += strcspn(s, " ")) {
        char name[40];
        s += strspn(s, " ");
        snprintf(name, sizeof name, "%.*s", (int)strcspn(s, " "), s);
        schema_append(to, schema_member(to, all, name, json_array), json_string(k->name));
    }
}

static void add_conditions(struct schema *to, json_t *object, const struct key *k)
{
    const bool required = k->otherwise && !strcmp(k->otherwise, REQUIRED) && !k->choice;
    if (k->needed) require_beside(to, object, k->needed, k);
    if (required && k->with) require_beside(to, object, k->with, k);
    if (required && !k->with && !k->unless)
        schema_append(to, schema_member(to, object, "required", json_array), json_string(k->name));
    if (required && k->unless) {
        json_t *either = any_of(to, k->unless);
        append_required(to, json_object_get(either, "anyOf"), k->name, strlen(k->name));
        schema_append(to, schema_member(to, object, "allOf", json_array), either);
    }
    if (!k->with && !k->without) return;
    json_t *beside = k->with ? any_of(to, k->with) : json_object();
    if (k->without) schema_put(to, beside, "not", any_of(to, k->without));
    schema_put(to, schema_member(to, object, "dependentSchemas", json_object), k->name, beside);
}

/* Rows of one choice, exactly one of which is given, or at most one; of choice 0, at least one of those that are
   marked so */
static void add_choice(struct schema *to, json_t *object, const struct key *const *row, int n,
                       int choice)
{
    json_t *list = json_array();
    bool maybe = false;
    for (int i = 0; i < n; i++) {
        if (choice ? abs(row[i]->choice) != choice : !row[i]->some) continue;
        append_required(to, list, row[i]->name, strlen(row[i]->name));
        maybe = maybe || (choice && row[i]->choice < 0);
    }
    if (!json_array_size(list)) {
        json_decref(list);
        return;
    }
    if (maybe)
        schema_append(to, list, json_pack("{s:{s:o}}", "not", "anyOf", json_deep_copy(list)));
    schema_append(to, schema_member(to, object, "allOf", json_array),
                  json_pack("{s:o}", choice ? "oneOf" : "anyOf", list));
}

/* ---- a table ---- */

static int schema_rows(const struct keys *t, int dim, const struct key **row, int n)
{
    for (const struct key *k = t->key; k->name; k++)
        if (k->type == &key_include)
            n = schema_rows(k->object, dim, row, n);
        else if ((!k->dim || !dim || k->dim == dim) && n < TABLES_MOST)
            row[n++] = k;
    return n;
}

static void schema_describe(struct schema *to, json_t *object, const struct keys *t)
{
    const struct key *row[TABLES_MOST];
    const int n = schema_rows(t, to->dim, row, 0);
    json_t *properties = schema_member(to, object, "properties", json_object);
    schema_put(to, properties, "comment", json_true());
    for (int i = 0; i < n; i++) schema_put(to, properties, row[i]->name, schema_value(to, row[i]));
    schema_put(to, object, "additionalProperties", json_false());
    for (int i = 0; i < n; i++) add_conditions(to, object, row[i]);
    for (int choice = 0; choice < 3; choice++) add_choice(to, object, row, n, choice);
}

/* One of several tables, by the first key of each */
static void describe_forms(struct schema *to, json_t *object, const struct keys *t)
{
    json_t *one = schema_member(to, object, "oneOf", json_array),
           *all = schema_member(to, object, "allOf", json_array);
    for (int i = 0; t->forms[i]; i++) {
        const char *first = t->forms[i]->key->name;
        append_required(to, one, first, strlen(first));
        schema_append(
            to, all,
            json_pack("{s:{s:[s]}, s:o}", "if", "required", first, "then", ref(to, t->forms[i])));
    }
}

static void schema_define(struct schema *to, const char *name, const struct keys *table)
{
    char full[60];
    snprintf(full, sizeof full, "%s-%dd", name, to->dim);
    if (json_object_get(to->defs, full)) return;
    for (size_t i = 0; i < sizeof plain / sizeof *plain; i++) {
        if (strcmp(plain[i].name, name) != 0) continue;
        const char *text = to->dim == 2 && plain[i].plane ? plain[i].plane : plain[i].text;
        schema_put(to, to->defs, full, schema_parse(to, text, table));
        return;
    }
    json_t *object = json_pack("{s:s}", "type", "object");
    schema_put(to, to->defs, full, object);
    if (!object || !table) return;
    if (table->forms)
        describe_forms(to, object, table);
    else
        schema_describe(to, object, table);
}

json_t *schema_of_scenes(struct failure *failure)
{
    struct schema to = { .defs = json_object() };
    for (to.dim = 3; to.dim >= 2; to.dim--) schema_define(&to, scene_keys.name, &scene_keys);
    json_t *j =
        json_pack("{s:s, s:s, s:s, s:{s:{s:{s:i}}, s:[s]}, s:{s:s}, s:{s:s}, s:O}", "$schema",
                  "https://json-schema.org/draft/2020-12/schema", "title", "A scene of nsd", "type",
                  "object", "if", "properties", "dim", "const", 2, "required", "dim", "then",
                  "$ref", "#/$defs/scene-2d", "else", "$ref", "#/$defs/scene-3d", "$defs", to.defs);
    json_decref(to.defs);
    if (j && !to.bad) return j;
    json_decref(j);
    failure_set(failure, EX_SOFTWARE, "no memory for the schema");
    return NULL;
}

/* ---- lines ---- */

struct seen {
    const struct keys *table[TABLES_MOST];
    int n;
};

static bool schema_is_new(struct seen *seen, const struct keys *t)
{
    for (int i = 0; i < seen->n; i++)
        if (seen->table[i] == t) return false;
    if (seen->n == TABLES_MOST) return false;
    seen->table[seen->n++] = t;
    return true;
}

/* As the manual has it: with the range of a number, or with the words if there are two that are short */
static void type_words(char *out, size_t room, const struct key *k)
{
    const char *const *word = k->words, *name = k->type == &key_integer ? "integer" : "number";
    const bool ranged = !k->type->item && (k->least != 0 || k->most != 0);
    const bool open = !(k->most < INT32_MAX);
    snprintf(out, room, "%s", k->type->words);
    if (word && word[1] && !word[2] && strlen(word[0]) + strlen(word[1]) < 10)
        snprintf(out, room, "\"%s\" or \"%s\"", word[0], word[1]);
    else if (ranged && open)
        snprintf(out, room, "%s >= %g", name, k->least);
    else if (ranged && k->least > -1e9)
        snprintf(out, room, k->type == &key_integer ? "%s %.0f to %.0f" : "%s %g to %.3g", name,
                 k->least, k->most);
}

static void table_lines(struct seen *seen, const struct keys *t,
                        void (*line)(const char *const field[7]))
{
    if (!t || !schema_is_new(seen, t)) return;
    for (int i = 0; t->forms && t->forms[i]; i++) table_lines(seen, t->forms[i], line);
    for (const struct key *k = t->key; k && k->name; k++) {
        char type[60];
        type_words(type, sizeof type, k);
        const char *const field[7] = { t->name,      k->name,    type,   k->unit,
                                       k->otherwise, k->example, k->help };
        if (k->type != &key_include) line(field);
    }
    for (const struct key *k = t->key; k && k->name; k++)
        table_lines(seen, k->object ? k->object : k->type->object, line);
}

void schema_lines(void (*line)(const char *const field[7]))
{
    struct seen seen = { 0 };
    table_lines(&seen, &scene_keys, line);
}
