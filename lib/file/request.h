/*
 * file/request.h: what is asked of a document, and the answers: the words between the process that
 * reads (file/server.h) and the tool (file/source.h).
 */
#pragma once

#include "file/h5.h"
#include "file/object.h"
#include "file/served.h"

#include <sys/types.h>

enum {
    REQUEST_PIECE = 1 << 18 /* bytes handed out at once: they stay in a core's second cache */
};

/* A request; path "" is the root. */
struct request {
    enum {
        REQUEST_NEXT, /* the next document of the stream; answered by its objects, see below */
        REQUEST_ROWS, /* rows start .. start+n-1 of width numbers; n < 0: all numbers */
        REQUEST_PART, /* n rows, from `from` on, of width numbers, of row start */
        REQUEST_RAW,  /* all of a dataset of numbers or texts, in its own plain type */
        REQUEST_TEXT, /* a scalar string, without its zero; of an attribute if name[0]; n: a list of them */
        REQUEST_ATTRIBUTE,  /* n numbers of an attribute; n < 0: a scalar */
        REQUEST_ATTRIBUTES, /* all attributes of an object, as objects with their data */
        REQUEST_IMAGE,      /* the document's own bytes, header and all */
        REQUEST_UNLOAD,     /* stream_unload */
        REQUEST_RELEASE     /* the document is closed, and stream_release */
    } op;
    enum column_type type; /* of the numbers wanted */
    int64_t start, n, width, from;
    char path[OBJECT_PATH], name[OBJECT_NAME];
};

/* An answer, and in front of every further piece of its data. */
struct reply {
    int status;    /* as of struct why */
    bool there;    /* false: there is no such text, no further document */
    uint64_t size; /* bytes of data in all */
    uint64_t here; /* of them in this piece */
    bool foreign, unfinished;
    int64_t number;    /* of the document in its file */
    uint64_t document; /* its bytes */
    uint64_t work;     /* bytes that had to be unpacked for it, and are not kept */
    bool plain;        /* its datasets are in one piece each, not in chunks */
    char text[400];    /* status 0, REQUEST_NEXT: the name of its file; else the reason */
};

/* Where answers go. */
struct sink {
    /* Called first, with the size in all. Returns 0 to go on. */
    int (*begin)(struct sink *sink, const struct reply *reply);
    /* Room for the next piece, of *most bytes. */
    void *(*room)(struct sink *sink, size_t *most);
    /* So many bytes are in it. Returns 0 to go on. */
    int (*put)(struct sink *sink, size_t size);
};

/* Bytes that are already there, as an answer. Returns 0, or -1 when they do not go on. */
int sink_bytes(struct sink *sink, struct reply *reply, const void *bytes, size_t size);

/*
 * A sink into memory: `size` bytes at out or, where out is NULL, fresh memory. Of a child's answers also
 * one that keeps nothing: pour() gets the pieces, and returns 0 to go on.
 */
struct taker {
    struct sink sink;
    int (*pour)(void *to, const void *bytes, size_t size, struct failure *failure);
    void *out; /* or what pour() needs to know */
    uint64_t size, done;
    struct budget *budget; /* which the answer draws on; NULL: none */
    struct reply reply;
    struct failure *failure;
};

/* Sets the sink's functions; out and size are set already. */
void taker_start(struct taker *taker, struct failure *failure);

/* Messages over a socket, whatever signals come in between. False, or another size: it is closed. */
bool line_send(int line, const void *message, size_t size);
ssize_t line_receive(int line, void *message, size_t size);

/* A request for this path, all else 0. */
struct request request_of(int op, const char *path);
