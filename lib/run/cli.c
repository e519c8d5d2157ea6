#include "run/cli.h"

#include "base/nearest.h"
#include "base/output.h"
#include "base/renamed.h"
#include "file/reader.h"

#include <errno.h>
#include <getopt.h>
#include <jansson.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdio_ext.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum {
    MESSAGE = 8192,   /* bytes of a message: names of files are at most 4096 */
    OPTIONS = 68,     /* room for a tool's options */
    RENAMED_MOST = 8, /* old names that a tool accepts */
    LEFT = 28,        /* characters of --help's left column */
    COLUMNS = 96,     /* of its longest words */
    FIRST_LONG = 1000 /* + the option's index: what getopt_long returns, beyond all letters */
};

/* The options of every tool; one with an -o of its own has not the first */
static const char *output;
static double gigabytes; /* that a packed document may hold */
static bool wants_help, wants_version;
static const struct cli_option common[] = {
    { CLI_TEXT, 'o', "output", &output, "FILE", .help = "write to FILE [standard output]",
      .silent = true },
    { CLI_REAL, 0, "unpack", &gigabytes, "GB", .max = 1e6, .silent = true,
      .help = "accept documents that unpack to GB [64 times their size, >= 0.067]" },
    { CLI_FLAG, 'h', "help", &wants_help, .help = "print this text" },
    { CLI_FLAG, 'V', "version", &wants_version, .help = "print the version" },
    { 0 },
};

static char *history;
static char **arguments;
static const void *given[OPTIONS]; /* the variables that were set, NULL between */
static bool formerly[OPTIONS];     /* by a former name */

static void cli_message(const char *format, va_list ap)
{
    char text[MESSAGE];
    vsnprintf(text, sizeof text, format, ap);
    failure_plain(text);
    progress_end();
    fprintf(stderr, "%s: %s\n", tool.name, text);
}

void die(int status, const char *format, ...)
{
    va_list ap;
    va_start(ap, format);
    cli_message(format, ap);
    va_end(ap);
    if (status == EX_IOERR) __fpurge(stdout); // what comes after a piece that is missing
    exit(status);
}

void die_usage(const char *format, ...)
{
    va_list ap;
    va_start(ap, format);
    cli_message(format, ap);
    va_end(ap);
    fprintf(stderr, "usage: %s [OPTION ...] %s (see --help)\n", tool.name, tool.operands);
    exit(EX_USAGE);
}

void die_why(const struct failure *failure)
{
    die(failure->status, "%s", failure->text);
}

void warn(const char *format, ...)
{
    va_list ap;
    va_start(ap, format);
    cli_message(format, ap);
    va_end(ap);
}

static bool progress_shown;
static double between_lines; /* s; 0: only on a terminal */

void progress_lines(double seconds)
{
    between_lines = seconds;
}

/* s of real time: when a line was shown last, or nothing yet when it was asked first */
static double progress_last;

bool progress_due(void)
{
    struct timespec t;
    bool terminal = isatty(STDERR_FILENO);
    if (!terminal && !(between_lines > 0)) return false;
    clock_gettime(CLOCK_MONOTONIC, &t);
    double now = (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
    if (progress_last == 0) progress_last = now; // what is done at once needs no line
    if (now - progress_last < (terminal ? 0.1 : between_lines)) return false;
    progress_last = now;
    return true;
}

void progress_now(const char *format, ...)
{
    bool terminal = isatty(STDERR_FILENO);
    va_list ap;
    va_start(ap, format);
    fprintf(stderr, terminal ? "\r\033[K%s: " : "%s: ", tool.name);
    vfprintf(stderr, format, ap);
    va_end(ap);
    if (!terminal) fputc('\n', stderr);
    progress_shown = terminal;
}

void progress_end(void)
{
    if (progress_shown) fprintf(stderr, "\r\033[K");
    progress_shown = false;
}

static bool stdout_named;     /* a file that had a name when the tool began */
static struct output printed; /* the file of -o, which takes standard output's place */

const char *cli_output(void)
{
    return output;
}

void begin_stdout(void)
{
    struct failure failure = { 0 };
    if (!output) return;
    if (output_open(&printed, output, &failure)) die_why(&failure);
    if (dup2(printed.fd, STDOUT_FILENO) < 0) die(EX_IOERR, "%s: %s", output, strerror(errno));
}

void finish_stdout(void)
{
    struct failure failure = { 0 };
    const char *name = printed.name ? printed.name : "standard output";
    bool bad = ferror(stdout);
    bool removed = !printed.name && stdout_named && output_removed(STDOUT_FILENO);
    if (bad) // errno is of something else
        die(EX_IOERR, "%s: not all was written (disk full?)", name);
    if (fflush(stdout) || (fclose(stdout) && errno != EBADF))
        die(EX_IOERR, "%s: %s", name, strerror(errno));
    if (removed) die(EX_IOERR, "%s: another program has removed it", name);
    if (printed.name && output_close(&printed, &failure)) die_why(&failure);
}

const char *cli_history(void)
{
    return history;
}

char **cli_arguments(void)
{
    return arguments;
}

bool cli_given(const void *to)
{
    for (int k = 0; k < OPTIONS; k++)
        if (given[k] == to) return true;
    return false;
}

bool cli_given_formerly(const void *to)
{
    for (int k = 0; k < OPTIONS; k++)
        if (given[k] == to) return formerly[k];
    return false;
}

/* The words of a choice, "a|b|c", for --help. */
static const char *cli_words(const struct cli_option *o)
{
    static char text[200];
    option_words(o, text, sizeof text);
    return text;
}

/* How much of a text of words a|b|c fits into n columns */
static size_t words_fit(const char *text, size_t n)
{
    while (n > 1 && text[n - 1] != '|') n--;
    return n;
}

/* "  -m, --local a|b|c      help [default]", and a line for each choice that explains itself */
static void help_option(const struct cli_option *o)
{
    char left[240], letter[5] = "    ";
    if (o->letter) snprintf(letter, sizeof letter, "-%c, ", o->letter);
    const char *arg = o->choice ? cli_words(o) : o->arg ? o->arg : "";
    snprintf(left, sizeof left, "%s--%s%s%s", letter, o->name, *arg ? " " : "", arg);
    const size_t cut = strlen(left) < COLUMNS ? strlen(left) : words_fit(left, COLUMNS);
    if (strlen(left) > LEFT - 1)
        printf("  %.*s%s%s\n%*s", (int)cut, left, left[cut] ? "\n          " : "", left + cut,
               LEFT + 4, "");
    else
        printf("  %-*s  ", LEFT, left);
    printf(o->usual ? "%s [%s]\n" : "%s\n", o->help, o->usual ? o->usual(o->to) : "");
    for (int k = 0; o->choice && o->choice(k).name; k++)
        if (o->choice(k).help) printf("%8s%-8s  %s\n", "", o->choice(k).name, o->choice(k).help);
}

static const struct cli_option *first_common(void)
{
    for (const struct cli_option *const *t = tool.tables; *t; t++)
        for (const struct cli_option *o = *t; o->kind; o++)
            if (o->letter == 'o') return common + 1;
    return common;
}

const struct cli_option *cli_option_at(int k)
{
    for (const struct cli_option *const *t = tool.tables; *t; t++)
        for (const struct cli_option *o = *t; o->kind; o++)
            if (!k--) return o;
    for (const struct cli_option *o = first_common(); o->kind; o++)
        if (!k--) return o;
    return NULL;
}

static void help(void)
{
    printf("usage: %s [OPTION ...] %s\n\n%s\n", tool.name, tool.operands, tool.about);
    for (const struct cli_option *const *t = tool.tables; *t; t++) {
        if ((*t)->kind != CLI_END) printf("\n");
        for (const struct cli_option *o = *t; o->kind; o++) help_option(o);
    }
    printf("\n");
    for (const struct cli_option *o = first_common(); o->kind; o++) help_option(o);
    if (tool.more) printf("\n%s", tool.more);
    printf("\nThe manual: man %s, man 7 nsd\n", tool.name);
    finish_stdout();
    exit(0);
}

static void version(void)
{
    printf("%s (nsd) %s\n", tool.name, NSD_VERSION);
    finish_stdout();
    exit(0);
}

/* -o -: standard output, as without the option; a file of this name is ./- */
static bool is_standard_output(const struct cli_option *o, const char *text)
{
    return o->letter == 'o' && o->kind == CLI_TEXT && !strcmp(text, "-");
}

/* Sets the option and returns its value for the history. */
static json_t *cli_set(const struct cli_option *o, const char *text)
{
    struct failure failure = { 0 };
    if (option_set(o, o->to, text, &failure)) die_usage("%s", failure.text);
    const struct cli_every *e = o->to;
    switch (o->kind) {
    case CLI_FLAG:
    case CLI_UNFLAG:
        return json_true();
    case CLI_TEXT:
    case CLI_CHOICE:
        return json_string(text);
    case CLI_EVERY:
        return e->steps ? json_integer(e->steps) : json_string(text);
    case CLI_INT:
        return json_integer(*(int64_t *)o->to);
    default:
        return json_real(*(double *)o->to);
    }
}

/* Ends the tool. A name that is the beginning of several could be each of them. */
static void no_such_option(const char *text, const struct option *known) __attribute__((noreturn));
static void no_such_option(const char *text, const struct option *known)
{
    const char *name = text + strspn(text, "-");
    const size_t n = strcspn(name, "=");
    char begun[200] = "";
    struct nearest near = { 0 };
    const struct renamed *renamed = renamed_find(tool.name, name, n);
    const char *cure = gone_find(tool.name, name, n);
    if (cure) die_usage("--%.*s is no longer available: %s", (int)n, name, cure);
    if (renamed) die_usage("--%.*s: now called --%s", (int)n, name, renamed->is);
    for (const struct option *o = known; o->name; o++) {
        const size_t at = strlen(begun);
        if (renamed_find(tool.name, o->name, strlen(o->name))) continue;
        nearest_look(&near, name, n, o->name);
        if (!strncmp(o->name, name, n))
            snprintf(begun + at, sizeof begun - at, "%s--%s", at ? ", " : "", o->name);
    }
    if (*begun) die_usage("--%.*s: more than one option begins so: %s", (int)n, name, begun);
    if (near.name) die_usage("--%.*s: no such option; did you mean --%s?", (int)n, name, near.name);
    die_usage("--%.*s: no such option", (int)n, name);
}

/* Behind the n options that there are: old names that are accepted, which stand for the new ones */
static void add_renamed(struct option *known, int n)
{
    const struct renamed *r;
    int end = n;
    for (int k = 0; (r = renamed_at(k)); k++)
        for (int i = 0; i < n && r->accepted && end < n + RENAMED_MOST; i++)
            if (!strcmp(known[i].name, r->is) && words_have(r->in, tool.name, strlen(tool.name)))
                known[end] = known[i], known[end++].name = r->was;
}

int cli_parse(int argc, char **argv)
{
    struct option lng[OPTIONS + RENAMED_MOST + 1] = { { 0 } };
    const struct cli_option *at[OPTIONS], *o;
    char letters[2 * OPTIONS + 2] = ":";
    int n = 0;
    for (; n < OPTIONS && (o = cli_option_at(n)); n++) {
        at[n] = o;
        bool flag = o->kind == CLI_FLAG || o->kind == CLI_UNFLAG;
        int wants = flag ? no_argument : required_argument;
        lng[n] = (struct option){ o->name, wants, NULL, FIRST_LONG + n };
        if (o->letter) sprintf(letters + strlen(letters), flag ? "%c" : "%c:", o->letter);
    }
    add_renamed(lng, n);
    json_t *value[OPTIONS] = { NULL };
    int c, which = 0;
    stdout_named = !output_removed(STDOUT_FILENO);
    size_t size = ((size_t)argc + 1) * sizeof *argv;
    if (!(arguments = malloc(size))) die(EX_SOFTWARE, "no memory");
    memcpy(arguments, argv, size);
    opterr = 0;
    while ((c = getopt_long(argc, argv, letters, lng, &which)) != -1) {
        if (c == ':') die_usage("%s: an argument is needed", argv[optind - 1]);
        if (c == '?' && optopt && optopt < 256) die_usage("-%c: no such option", optopt);
        if (c == '?' && optopt)
            die_usage("%.*s: takes no argument", (int)strcspn(argv[optind - 1], "="),
                      argv[optind - 1]);
        if (c == '?') no_such_option(argv[optind - 1], lng);
        int k = c - FIRST_LONG;
        for (int i = 0; c < FIRST_LONG && i < n; i++)
            if (at[i]->letter == c) k = i;
        json_decref(value[k]);
        value[k] = cli_set(at[k], optarg);
        given[k] = at[k]->to;
        formerly[k] = c >= FIRST_LONG && which >= n;
        if (wants_help) help();
        if (wants_version) version();
        if (!is_standard_output(at[k], optarg)) continue;
        json_decref(value[k]);
        value[k] = NULL, given[k] = NULL, *(const char **)at[k]->to = NULL;
    }
    if (cli_given(&gigabytes)) reader_unpack(1e9 * gigabytes);
    json_t *options = json_object();
    for (int i = 0; i < n; i++) {
        if (value[i] && !at[i]->silent) json_object_set(options, at[i]->name, value[i]);
        json_decref(value[i]);
    }
    json_t *line = json_pack("{s:s, s:s, s:o}", "command", tool.name, "version", NSD_VERSION,
                             "options", options);
    history = json_dumps(line, JSON_COMPACT);
    json_decref(line);
    if (!history) die(EX_SOFTWARE, "no memory");
    return optind;
}
