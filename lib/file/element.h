/*
 * file/element.h: what datasets and attributes consist of: which types on disk are taken, whether numbers
 * keep their value in the type wanted, and texts of either kind.
 */
#pragma once

#include "file/h5.h"
#include "file/object.h"

/* The kind, class and size of an object of this type on disk. */
void element_describe(hid_t disk, struct object *object);
/* Do numbers of this kind keep their values in the type wanted? Integers may become reals. */
bool element_suits(const struct object *object, enum column_type want);
/* "numbers" or "integers", for messages */
const char *element_wanted(enum column_type type);
/* How numbers are read: one that does not fit the type wanted fails the read. Not to be closed. */
hid_t element_transfer(void);
/* The memory type of an object's elements; to be closed when it is a string (class 's'). */
hid_t element_type(const struct object *object);
/* A scalar string of fixed or variable length as a new C string; of set and attr, one is -1. */
char *element_text(hid_t set, hid_t attr, size_t *length, bool *no_memory);
/* A list of strings as one, each ended by a newline; NULL also where they are too many. */
char *element_lines(hid_t set, size_t *length, bool *no_memory);
