/*
 * scene/json_node.h: JSON read with checks. A node knows its way from the root, so that a fault is told as
 *
 *     line:column: path: trouble        (12:9: bodies[1].radius: must be positive)
 *
 * Lines and columns count from 1, columns in characters. A node that is not there (json NULL) is
 * read without a word and leaves the default that stands in *out.
 */
#ifndef NSD_JSON_NODE_H
#define NSD_JSON_NODE_H

#include "base/vec.h"
#include "base/why.h"

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct jtext {
    char *text;   /* as given, but ending in 0 */
    json_t *root; /* an object */
    struct why *why;
};

typedef struct json_node {
    const struct json_node *up; /* NULL at the root; must outlive this node */
    const char *key;            /* in an object; else NULL and index counts */
    size_t index;
    json_t *json; /* NULL when there is no such key */
    struct jtext *in;
} jnode;

enum jrange { J_ANY, J_POSITIVE, J_NOT_NEGATIVE, J_UNIT /* [0, 1] */ };

/* Returns 0, EX_DATAERR (syntax, a key twice, no object) or EX_SOFTWARE. */
int jtext_parse(struct jtext *, const char *text, size_t length, struct why *);
void jtext_free(struct jtext *);
jnode jtext_root(struct jtext *);

jnode json_node_key(const jnode *object, const char *key);
jnode json_node_item(const jnode *array, size_t index);

/* EX_DATAERR with the node's place, or its nearest ancestor's that is in the text. */
int json_node_fault(jnode, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Each returns 0 or the status of a fault. Names are a list with blanks between. */
int json_node_only(jnode, const char *names); /* an object with no other keys but "comment" */
int json_node_need(const jnode *object, const char *names);
int json_node_choice(jnode object,
                     const char *names); /* which one of the keys is there; -1: a fault */

int json_node_number(jnode, enum jrange, double *out);
int json_node_integer(jnode, int64_t least, int64_t most, int64_t *out);
int json_node_bool(jnode, bool *out);
int json_node_text(jnode, const char **out); /* borrowed */
int json_node_array(jnode, size_t *length);  /* 0 when it is not there */
int json_node_vector(jnode, int dim, vec3 *out);

#endif
