/*
 * scene/mesh_words.h: lines, words and numbers of text in the files of surfaces. Lines end with LF or CR LF; a
 * UTF-8 byte order mark in front is passed over. Numbers are decimal, with a point whatever the locale, and
 * keep all their digits.
 */
#ifndef NSD_MESH_WORDS_H
#define NSD_MESH_WORDS_H

#include "scene/soup.h"

struct words {
    struct soup *soup;    /* its `at` is the number of the line */
    const char *at, *end; /* the rest; *end is 0 */
    bool joined;          /* a backslash at the end of a line joins the next one to it */
    bool comments;        /* from # to the end of a line */
};

struct word {
    const char *s;
    int n; /* bytes */
};

/* Of the n bytes of a file, behind which there is a 0 */
struct words words_of(struct soup *soup, const char *bytes, int64_t n);
/* The next word of the line; false at its end */
bool words_next(struct words *w, struct word *word);
/* Goes to the next line; false: there is none */
bool words_line(struct words *w);
/* The next word, on this line or a later one; false at the end of the text */
bool words_any(struct words *w, struct word *word);
/* Letters may be of either case. */
bool word_is(struct word word, const char *what);
bool word_has_only(struct word word, const char *letters);
/* A fault: "WORD" trouble */
int word_fault(struct words *w, struct word word, const char *trouble);

/* The next word of the line, which must be a finite number, or a whole one; each returns 0 or a fault's
   status. */
int words_number(struct words *w, double *x);
int words_whole(struct words *w, int64_t *x);
int word_number(struct words *w, struct word word, double *x);

#endif
