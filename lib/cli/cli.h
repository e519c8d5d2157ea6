/*
 * cli/cli.h: what every tool's command line has in common: options with --help and --version made from
 * one table, errors as `tool: thing: trouble`, exit statuses, progress on a terminal.
 *
 * A tool defines `tool` and tool_main(); the only main() is in main.c.
 */
#ifndef NSD_CLI_H
#define NSD_CLI_H

#include "base/why.h"

#include <stdbool.h>
#include <stdint.h>

enum cli_kind {
    CLI_END,
    CLI_FLAG,    /* bool, set */
    CLI_UNFLAG,  /* bool, cleared */
    CLI_INT,     /* int64_t in [min, max] */
    CLI_REAL,    /* double in [min, max] */
    CLI_ABOVE,   /* double in (min, max] */
    CLI_BETWEEN, /* double in (min, max) */
    CLI_CHOICE,  /* int: the place of the word in choices, "a|b|c" */
    CLI_TEXT     /* const char * */
};

struct cli_option {
    enum cli_kind kind;
    char letter;      /* or 0 */
    const char *name; /* --name */
    void *to;
    const char *arg;  /* EPS, FILE ...; the choices of a CLI_CHOICE */
    const char *help; /* with its default in brackets */
    double min, max;
    bool silent; /* leaves the result as it is (-j, --log): not in a document's history */
};

struct cli_tool {
    const char *name, *operands;            /* "nsd-detect", "[FILE ...]" */
    const char *about;                      /* one line, what it reads and writes */
    const struct cli_option *const *tables; /* NULL ends */
    const char *more;                       /* after the options: examples; or NULL */
};

extern const struct cli_tool tool;
int tool_main(int argc, char **argv); /* the operands, after cli_parse */

/*
 * Sets the options, answers --help and --version, ends with EX_USAGE where something is off.
 * Returns the place of the first operand. Afterwards cli_history() is the line for the document's
 * history: {"command":"nsd-step","version":"0.1","options":{...}}, the options given that are not
 * silent, in the table's order.
 */
int cli_parse(int argc, char **argv);
const char *cli_history(void);

/* All of these to stderr; die ends. */
void die(int status, const char *format, ...) __attribute__((noreturn, format(printf, 2, 3)));
void die_usage(const char *format, ...) __attribute__((noreturn, format(printf, 1, 2)));
void die_why(const struct why *) __attribute__((noreturn));
void warn(const char *format, ...) __attribute__((format(printf, 1, 2)));
void say(const char *format, ...)
    __attribute__((format(printf, 1, 2))); /* without the tool's name */

/* One line that is written over, at most ten times a second, only when stderr is a terminal. */
void progress(const char *format, ...) __attribute__((format(printf, 1, 2)));
void progress_end(void);

/* stdout as text: flushed and closed with its errors heeded (EX_IOERR). */
void finish_stdout(void);

#endif
