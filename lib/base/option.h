/*
 * base/option.h: a row of a table of options: what it is called, the variable that it sets, and which values it takes.
 * Command lines (run/cli.h) and programs that call the library (run/nsd.h) read the same tables.
 */
#pragma once

#include "base/failure.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum cli_kind {
    CLI_END,
    CLI_FLAG,    /* bool, set */
    CLI_UNFLAG,  /* bool, cleared */
    CLI_INT,     /* int64_t in [min, max] */
    CLI_REAL,    /* double in [min, max] */
    CLI_ABOVE,   /* double in (min, max] */
    CLI_BETWEEN, /* double in (min, max) */
    CLI_TIME,    /* double, s, in (min, max]: "90", "90s", "10min", "2h", "5ms" */
    CLI_EVERY,   /* struct cli_every: "10" steps or, with a unit of time, "0.01s" */
    CLI_CHOICE,  /* int: the index of the word among its choices */
    CLI_TEXT     /* const char * */
};

/* How often: every so many steps or, where that is 0, seconds of simulated time */
struct cli_every {
    int64_t steps;
    double seconds;
};

/* Is the frame at time t one of those by times: the first of all, or the first at or after a multiple of e->seconds?
   last: NAN before the first */
bool every_passed(const struct cli_every *e, double *last, double t);
/* Reads a time as options have it; false where text is none. */
bool time_parse(double *seconds, const char *text);

/* A word that an option takes, and what it means; help may be NULL. */
struct cli_choice {
    const char *name, *help;
};

struct cli_option {
    enum cli_kind kind;
    char letter;      /* -letter, or 0 */
    const char *name; /* --name */
    void *to;         /* the variable that it sets */
    const char *arg;  /* EPS, FILE ...; NULL for flags and choices */
    const char *help; /* one line */
    double min, max;
    struct cli_choice (*choice)(int index); /* of a CLI_CHOICE; past the last, a name of NULL */
    const struct cli_choice
        *gone; /* words that it took once, and what to use instead; a name of NULL ends them */
    const char *(*usual)(const void *to); /* its default for --help; NULL: help has it in [] */
    bool silent; /* leaves the result as it is (-j, --log): not in a document's history */
};

/* The words of a choice, "a|b|c", for --help and for messages: at most size - 1 characters of them */
void option_words(const struct cli_option *o, char *text, size_t size);
/* Sets a variable of the option's kind, *to, by a text; a flag takes none, or true or false. Returns 0, or EX_USAGE
   with "--name: trouble". A CLI_TEXT is borrowed. */
int option_set(const struct cli_option *o, void *to, const char *text, struct failure *failure);

/* Ranges of steps, "A:B:K": every K-th step from A to B. Any may be left out. */

struct range {
    int64_t from, to, by; /* from, from + by ... up to and with to */
};

/* Parses "7", "100:", ":50", "0:1000:10", "::10" ...; false where text is no range. */
bool range_parse(struct range *r, const char *text);
static inline bool range_has(const struct range *r, int64_t step)
{
    return step >= r->from && step <= r->to && (step - r->from) % r->by == 0;
}
