/*
 * run/cli.h: what every tool's command line has in common: options with --help and --version made
 * from one table, errors as `tool: thing: trouble`, exit statuses, progress on a terminal.
 *
 * A tool defines `tool` and tool_main(); the only main() is in main.c.
 */
#pragma once

#include "base/option.h"

struct cli_tool {
    const char *name, *operands;            /* "nsd-detect", "[FILE ...]" */
    const char *about;                      /* a few lines: what it does, reads and writes */
    const struct cli_option *const *tables; /* NULL ends */
    const char *more;                       /* after the options: examples; or NULL */
};

extern const struct cli_tool tool;
int tool_main(int operands, char **operand); /* called after cli_parse; returns the exit status */

/*
 * Sets the options, answers --help and --version, and ends with EX_USAGE at the first error.
 * Returns the index of the first operand.
 */
int cli_parse(int argc, char **argv);

/* main()'s argv as it was: options are sorted to the front of that */
char **cli_arguments(void);

/* Option k of the tool: those of its tables, then those of every tool; NULL past the last */
const struct cli_option *cli_option_at(int k);

/* The file of -o, of a tool without an option -o of its own; NULL: standard output */
const char *cli_output(void);
/* What is printed from now on goes there, and takes its place with finish_stdout(). */
void begin_stdout(void);

/* Was an option given that sets this variable? Then its value is the user's, else the default. */
bool cli_given(const void *to);
/* And by its former name [base/renamed.h]? Scripts that write it read former names, too. */
bool cli_given_formerly(const void *to);

/*
 * The line for the document's history: {"command":"nsd-step","version":"0.1","options":{...}}, with
 * the options that were given and are not silent, in the table's order.
 */
const char *cli_history(void);

/* Messages to stderr, after the tool's name. Those called die end the tool. */
void die(int status, const char *format, ...) __attribute__((noreturn, format(printf, 2, 3)));
void die_usage(const char *format, ...) __attribute__((noreturn, format(printf, 1, 2)));
void die_why(const struct failure *failure) __attribute__((noreturn));
void warn(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* One line that is overwritten, at most ten times a second, only when stderr is a terminal: is it time for one?
   Then it is printed. */
bool progress_due(void);
void progress_now(const char *format, ...) __attribute__((format(printf, 1, 2)));
#define progress(...) (progress_due() ? progress_now(__VA_ARGS__) : (void)0)
/* Elsewhere, too: a line of its own every so many seconds of real time */
void progress_lines(double seconds);
void progress_end(void);

/* Flushes and closes stdout, where it is text, and the file of -o; ends with EX_IOERR if any of it was not written. */
void finish_stdout(void);
