/*
 * scene/keys.h: the objects of a scene as tables of keys. A row has all that there is to know of a key: the type of
 * its value, the member that gets it, its range, unit and default, when it may and when it must be given, and a line of
 * help. The reading, its messages, the JSON Schema [scene/schema.h] and the tables of nsd-scene(5) come of the same rows.
 */
#pragma once

#include "scene/json_node.h"
#include "scene/scene.h"

/* Rows leave out what they do not have. */
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"

struct key;

/*
 * A type of values: of its own, or an array of items of another type, which follow each other in the member. A JSON Schema is
 * written with ' for ", and the names of tables and of scene/schema.c's own types in $ref.
 */
struct key_type {
    const char *words; /* in the manual */
    const char *schema;
    int (*read)(jnode n, const struct key *k, struct scene *s, void *member);
    void (*preset)(const struct key *k, void *member); /* to the default; NULL: it stays as it is */
    const struct keys *object; /* the table that its schema refers to; NULL: none */
    enum json_range range;
    const struct key_type *item; /* of an array */
    int count;                   /* of items; 0: that of dimensions, below 0: less by so many */
    size_t size;                 /* bytes of an item */
};
/* In braces: an initializer of such a type */
#define ARRAY(words, item, count, size)                                                            \
    words, NULL, keys_read_array, NULL, NULL, J_ANY, item, count, size
int keys_read_array(jnode n, const struct key *k, struct scene *s, void *member);
static inline int keys_count(const struct key_type *array, int dim)
{
    return array->count > 0 ? array->count : dim + array->count;
}

#define REQUIRED "required" /* the default of a key that is needed, where it is allowed */

struct key {
    const char *name;
    const struct key_type *type;
    size_t at; /* offset of the member in what the object becomes */
    const char *unit, *otherwise /* the default */, *example, *help;

    int dim;             /* only in scenes of that many dimensions; 0: in all */
    int choice;          /* exactly one of the keys of that number is given; below 0: at most one */
    bool some;           /* at least one of the keys with this mark is given */
    const char *with;    /* only beside one of these keys */
    const char *without; /* only beside none of these */
    const char *why;     /* the message where it is not allowed; NULL: what it goes with */
    const char *needed;  /* needed beside one of these keys */
    const char *unless;  /* REQUIRED: not beside one of these */
    double least, most;  /* of a number or an integer; both 0: as its type has it */
    const char *limit;   /* what a number beyond these is reported with; NULL: the range */
    const char *const *words;  /* of a key_word, NULL ends them */
    const struct keys *object; /* of an object, or of the items of a list or of a map */
    int (*read)(jnode n, struct scene *s, void *member); /* in place of the type's */
    bool always;                                         /* read although it is not given */
};

struct keys {
    const char *name;      /* in the schema and in the manual */
    const struct key *key; /* rows; one without a name ends them */
    /* instead of rows: one of these, by the first key of each; NULL ends them */
    const struct keys *const *forms;
    bool keeps; /* a key that is not given leaves what its member has, not the default */
    /* checks of several keys, and what follows from them; or NULL */
    int (*finish)(jnode o, struct scene *s, void *out);
};

/* Reads an object. Returns 0, or not 0 after a fault has been reported. */
int keys_read(jnode o, const struct keys *t, struct scene *s, void *out);
/* Rows [[t, x], ...] whose t rise, from a list that is not empty, behind each other in memory for all of them */
int keys_read_rows(jnode list, double *row);
/* Reads each item of a list. */
int keys_each(jnode a, struct scene *s, void *out,
              int (*read)(jnode n, struct scene *s, void *out));
bool keys_has(const jnode *o, const char *key);

/* The row of another table's rows, whose members lie behind `at` */
extern const struct key_type key_include;

extern const struct key_type key_number, key_positive, key_not_negative, key_share; /* double */
extern const struct key_type key_integer;                                           /* int64_t */
extern const struct key_type key_bool;
extern const struct key_type key_text; /* const char *, borrowed from the scene's text */
extern const struct key_type key_file; /* char *, to be freed */
extern const struct key_type key_word; /* int */
extern const struct key_type key_vector, key_direction /* of length 1 */, key_spin; /* vec3 */
extern const struct key_type key_lengths, key_two_positive, key_min_max;            /* double[] */
extern const struct key_type key_matrix;                    /* double[3][3] or vec3[3] */
extern const struct key_type key_object, key_list, key_map; /* a list or a map has its own read */
