/*
 * io/serve.h: what is asked of a document, and the answers: the one place where nsd has libhdf5 read
 * what it did not write. It runs in a process of its own (io/source.h), for no check of ours makes
 * libhdf5 safe against hostile bytes. What it hands out is plain: numbers, texts, names, shapes.
 *
 * A document is one file: links into others, data kept in others and filters from plugins are
 * refused. What a document does not store is not believed.
 */
#ifndef NSD_SERVE_H
#define NSD_SERVE_H

#include "io/h5.h"

#include <stddef.h>
#include <stdint.h>

enum {
    SERVE_RANK = 8,       /* most dimensions of a dataset that can be copied */
    SERVE_PATH = 400,     /* bytes of a path, its zero included */
    SERVE_NAME = 256,     /* bytes of an attribute's name */
    SERVE_PIECE = 1 << 18 /* bytes handed out at once: they stay in a core's second cache */
};

/* A request; path "" is the root. */
struct request {
    enum {
        REQUEST_NEXT,      /* the next document of the stream; answered by its objects, see below */
        REQUEST_ROWS,      /* rows start .. start+n-1 of width numbers; n < 0: all numbers */
        REQUEST_RAW,       /* all of a dataset of numbers or texts, in its own plain type */
        REQUEST_TEXT,      /* a scalar string, without its zero; of an attribute if name[0] */
        REQUEST_ATTRIBUTE, /* n numbers of an attribute; n < 0: a scalar */
        REQUEST_ATTRIBUTES, /* all attributes of an object, as objects with their data */
        REQUEST_UNLOAD,     /* stream_unload */
        REQUEST_RELEASE     /* the document is closed, and stream_release */
    } op;
    enum column_type type; /* of the numbers wanted */
    int64_t start, n, width;
    char path[SERVE_PATH], name[SERVE_NAME];
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
    char text[400];    /* status 0, REQUEST_NEXT: the name of its file; else the reason */
};

/*
 * An object or an attribute, in a sequence of bytes: this, shape[rank], the name with its zero, and
 * data; each padded to 8 bytes.
 */
struct object {
    enum { OBJECT_GROUP, OBJECT_NUMBERS, OBJECT_TEXT, OBJECT_OTHER } kind;
    char class;     /* 'i' signed, 'u' unsigned, 'f' real, 's' string */
    uint32_t size;  /* bytes of an element */
    uint32_t rank;  /* 0: a scalar; SERVE_RANK + 1: more than can be copied */
    uint32_t name;  /* bytes of the name, zero included */
    bool attribute; /* of a group, under the name "group@name" */
    uint64_t data;  /* bytes of data behind it; 0 where they are to be asked for */
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

/* An open document */
struct served {
    hid_t file;          /* -1: none */
    uint64_t size;       /* bytes of the document */
    uint64_t limit;      /* bytes that its datasets may hold in all, packed data unpacked */
    uint64_t unpacked;   /* bytes that they do hold */
    int64_t count, room; /* of entries */
    struct entry *entry; /* what is in it, in the order of a walk by names */
};

/* Once in a process that serves: no plugins, no links into other files. */
void serve_start(void);
/*
 * Takes the file over, to be closed by serve_close even after a failure here, and looks at all that
 * is in it. limit 0: the usual one. EX_DATAERR: it is more than one file, or holds too much.
 */
int serve_open(struct served *served, hid_t file, uint64_t size, uint64_t limit, struct why *why);
/*
 * The objects of the document, as bytes; to be freed. Small ones come with their data, and groups with
 * their attributes: most documents are small, and a question takes longer than its answer.
 */
void *serve_objects(struct served *served, size_t *size, struct why *why);
/* Answers any request but those of the stream. */
int serve_answer(struct served *served, const struct request *request, struct sink *sink,
                 struct why *why);
/* Bytes that are already there, as an answer */
int serve_bytes(struct sink *sink, struct reply *reply, const void *bytes, size_t size);
void serve_close(struct served *served);

#endif
