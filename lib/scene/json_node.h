/*
 * scene/json_node.h: JSON read with checks. A node knows its path from the root, so that a fault
 * can be reported as
 *
 *     line:column: path: trouble        (12:9: bodies[1].radius: must be positive)
 *
 * Lines and columns count from 1, columns in characters. Reading a node that is not there (its json
 * is NULL) is no fault and leaves *out, which holds the default, as it is.
 */
#pragma once

#include "base/failure.h"
#include "base/vec.h"

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A parsed text, and where its faults are reported */
struct json_doc {
    char *text;   /* as given, with a final 0 */
    json_t *root; /* jansson's: an object or array */
    struct failure *failure;
};

typedef struct json_node {
    const struct json_node *up; /* NULL at the root; must outlive this node */
    const char *key;            /* of a member of an object; NULL: an item of an array */
    size_t index;               /* of an item */
    json_t *json;               /* NULL when there is no such key */
    struct json_doc *in;
} jnode;

enum json_range { J_ANY, J_POSITIVE, J_NOT_NEGATIVE, J_UNIT /* [0, 1] */ };

/* Returns 0, EX_DATAERR (syntax error, repeated key, not an object or array) or EX_SOFTWARE. */
int json_doc_parse(struct json_doc *t, const char *text, size_t length, struct failure *failure);
void json_doc_free(struct json_doc *t);
jnode json_doc_root(struct json_doc *t);

jnode json_node_key(const jnode *object, const char *key);
jnode json_node_item(const jnode *array, size_t index);

/* Returns EX_DATAERR; the reason has the place of the node or of its nearest ancestor. */
int json_node_fault(jnode node, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Each returns 0 or the status of a fault. */
int json_node_number(jnode node, enum json_range range, double *out);
int json_node_integer(jnode node, int64_t least, int64_t most, int64_t *out);
int json_node_bool(jnode node, bool *out);
int json_node_text(jnode node, const char **out); /* borrowed from the parsed text */
/* One of these words, NULL ends them: *out is its index. */
int json_node_word(jnode node, const char *const *words, int *out);
int json_node_array(jnode node, size_t *length); /* 0 when it is not there */
int json_node_vector(jnode node, int dim, vec3 *out);
