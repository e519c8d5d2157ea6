/* scene/json_node.c: nodes, their places in the text, and the checks of keys and values. */
#include "scene/json_node.h"

#include "base/json.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Control characters of keys and strings become '?', so that a fault is one line. */
static void make_printable(char *s)
{
    for (; *s; s++)
        if ((unsigned char)*s < ' ' || *s == 0x7f) *s = '?';
}

/* jansson takes a zero byte behind a number for a blank, and the text would end there. */
static int refuse_zero(const char *text, size_t length, struct failure *failure)
{
    const char *zero = memchr(text, 0, length), *line = text;
    int lines = 1;
    if (!zero) return 0;
    for (const char *s = text; s < zero; s++)
        if (*s == '\n') lines++, line = s + 1;
    return failure_set(failure, EX_DATAERR, "%d:%d: a zero byte", lines, (int)(zero - line) + 1);
}

int json_doc_parse(struct json_doc *t, const char *text, size_t length, struct failure *failure)
{
    json_error_t e;
    size_t mark = mark_length(text, length);
    *t = (struct json_doc){ .failure = failure };
    text += mark, length -= mark;
    if (refuse_zero(text, length, failure)) return failure->status;
    t->root = json_loadb(text, length, JSON_REJECT_DUPLICATES, &e);
    if (!t->root) {
        make_printable(e.text);
        return failure_set(failure, EX_DATAERR, "%d:%d: %s", e.line, e.column, e.text);
    }
    t->text = malloc(length + 1);
    if (!t->text) {
        json_doc_free(t);
        return failure_set(failure, EX_SOFTWARE, "no memory for a text of %zu bytes", length);
    }
    memcpy(t->text, text, length);
    t->text[length] = 0;
    return 0;
}

void json_doc_free(struct json_doc *t)
{
    json_decref(t->root);
    free(t->text);
    *t = (struct json_doc){ 0 };
}

jnode json_doc_root(struct json_doc *t)
{
    return (jnode){ .json = t->root, .in = t };
}

jnode json_node_key(const jnode *up, const char *key)
{
    return (jnode){ .up = up, .key = key, .json = json_object_get(up->json, key), .in = up->in };
}

jnode json_node_item(const jnode *up, size_t i)
{
    return (jnode){ .up = up, .index = i, .json = json_array_get(up->json, i), .in = up->in };
}

/* ---- the place of a node in the text, which is valid JSON: jansson has parsed it ---- */

static const char *skip_space(const char *s)
{
    return s + strspn(s, " \t\r\n");
}

static const char *skip_string(const char *s)
{
    for (s++; *s != '"'; s++)
        if (*s == '\\') s++;
    return s + 1;
}

static const char *skip_value(const char *s)
{
    int depth = 0;
    do {
        if (*s == '"')
            s = skip_string(s);
        else if (*s == '{' || *s == '[')
            depth++, s++;
        else if (*s == '}' || *s == ']')
            depth--, s++;
        else if (depth)
            s++;
        else
            s += strcspn(s, ",]} \t\r\n");
    } while (depth);
    return s;
}

static bool key_is(const char *s, const char *key)
{
    size_t n = strlen(key);
    return !strncmp(s + 1, key, n) && s[1 + n] == '"';
}

/* The node's key or item in the text and its *value; or its nearest ancestor's, *value NULL. */
static const char *find_node(const jnode *n, const char **value)
{
    if (!n->up) return *value = skip_space(n->in->text);
    const char *inside, *above = find_node(n->up, &inside);
    *value = NULL;
    if (!inside || *inside != (n->key ? '{' : '[')) return above;
    const char *s = skip_space(inside + 1);
    for (size_t i = 0; *s != '}' && *s != ']'; i++) {
        const char *here = s;
        bool found = n->key ? key_is(s, n->key) : i == n->index;
        if (n->key) s = skip_space(skip_space(skip_string(s)) + 1); // behind the colon
        if (found) {
            *value = s;
            return here;
        }
        s = skip_space(skip_value(s));
        if (*s == ',') s = skip_space(s + 1);
    }
    return above;
}

static void line_and_column(const jnode *n, int *line, int *column)
{
    const char *value, *here = find_node(n, &value);
    *line = *column = 1;
    for (const char *s = n->in->text; s < here; s++) {
        if (*s == '\n')
            ++*line, *column = 1;
        else if ((*s & 0xc0) != 0x80) // not inside a UTF-8 character
            ++*column;
    }
}

/* Writes the path of n from the root; returns its length. */
static size_t write_path(const jnode *n, char *out, size_t room)
{
    if (!n->up) return 0;
    size_t k = write_path(n->up, out, room);
    int more = n->key ? snprintf(out + k, room - k, "%s%s", k ? "." : "", n->key)
                      : snprintf(out + k, room - k, "[%zu]", n->index);
    k += (size_t)more;
    return k < room ? k : room - 1;
}

int json_node_fault(jnode n, const char *format, ...)
{
    char way[200] = "", trouble[400]; // all keys of a scene have room
    int line, column;
    va_list ap;
    va_start(ap, format);
    vsnprintf(trouble, sizeof trouble, format, ap);
    va_end(ap);
    size_t length = write_path(&n, way, sizeof way);
    make_printable(way), make_printable(trouble);
    line_and_column(&n, &line, &column);
    return failure_set(n.in->failure, EX_DATAERR, "%d:%d: %s%s%s", line, column, way,
                       length ? ": " : "", trouble);
}

/* ---- values ---- */

int json_node_number(jnode n, enum json_range range, double *out)
{
    if (!n.json) return 0;
    if (!json_is_number(n.json)) return json_node_fault(n, "needs a number");
    double x = json_number_value(n.json);
    if (range == J_POSITIVE && !(x > 0)) return json_node_fault(n, "must be positive");
    if (range == J_NOT_NEGATIVE && !(x >= 0)) return json_node_fault(n, "must not be negative");
    if (range == J_UNIT && !(x >= 0 && x <= 1)) return json_node_fault(n, "must lie in [0, 1]");
    *out = x;
    return 0;
}

int json_node_integer(jnode n, int64_t least, int64_t most, int64_t *out)
{
    if (!n.json) return 0;
    double x = json_number_value(n.json); // exact: the ranges asked for end far below 2^53
    if (!json_is_number(n.json) || x != floor(x)) return json_node_fault(n, "needs an integer");
    if (!(x >= (double)least && x <= (double)most))
        return json_node_fault(n, "must lie in [%lld, %lld]", (long long)least, (long long)most);
    *out = (int64_t)x;
    return 0;
}

int json_node_bool(jnode n, bool *out)
{
    if (!n.json) return 0;
    if (!json_is_boolean(n.json)) return json_node_fault(n, "needs true or false");
    *out = json_is_true(n.json);
    return 0;
}

int json_node_text(jnode n, const char **out)
{
    if (!n.json) return 0;
    if (!json_is_string(n.json)) return json_node_fault(n, "needs a string");
    *out = json_string_value(n.json);
    return 0;
}

int json_node_word(jnode n, const char *const *words, int *out)
{
    const char *text = NULL;
    if (json_node_text(n, &text)) return 1;
    if (!text) return 0;
    char known[100] = "";
    for (int k = 0; words[k]; k++) {
        const size_t at = strlen(known);
        if (!strcmp(words[k], text)) return *out = k, 0;
        snprintf(known + at, sizeof known - at, " \"%s\"", words[k]);
    }
    return json_node_fault(n, "\"%s\" is no choice here; known here:%s", text, known);
}

int json_node_array(jnode n, size_t *length)
{
    *length = json_array_size(n.json);
    return !n.json || json_is_array(n.json) ? 0 : json_node_fault(n, "needs an array [...]");
}

int json_node_vector(jnode n, int dim, vec3 *out)
{
    double x[3] = { 0 };
    if (!n.json) return 0;
    if (!json_is_array(n.json) || json_array_size(n.json) != (size_t)dim)
        return json_node_fault(n, "needs %s", dim == 2 ? "[x, y], for dim is 2" : "[x, y, z]");
    for (int i = 0; i < dim; i++)
        if (json_node_number(json_node_item(&n, (size_t)i), J_ANY, &x[i]))
            return n.in->failure->status;
    *out = v3(x[0], x[1], x[2]);
    return 0;
}
