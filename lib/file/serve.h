/*
 * file/serve.h: the answers: the one place where nsd has libhdf5 read what it did not write. It runs in a
 * process of its own (file/server.h). What it hands out is plain: numbers, texts, names, shapes.
 */
#pragma once

#include "file/request.h"
#include "file/served.h"

enum {
    MOST_ATTRIBUTE = 1 << 20 /* bytes of an attribute */
};

/*
 * The objects of the document, as bytes; to be freed. Small ones come with their data, and groups with
 * their attributes: most documents are small, and a question takes longer than its answer.
 */
void *serve_objects(struct served *served, size_t *size, struct failure *failure);
/* Answers any request but those of the stream. */
int serve_answer(struct served *served, const struct request *request, struct sink *sink,
                 struct failure *failure);
/* REQUEST_ATTRIBUTES (serve_objects.c) */
int serve_attributes(struct served *served, const struct request *request, struct sink *sink,
                     struct failure *failure);
