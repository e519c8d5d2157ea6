#include "base/option.h"

#include "base/renamed.h"
#include "base/text.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void option_words(const struct cli_option *o, char *text, size_t size)
{
    size_t n = 0;
    text[0] = 0;
    for (int k = 0; o->choice(k).name && n < size; k++)
        n += (size_t)snprintf(text + n, size - n, "%s%s", k ? "|" : "", o->choice(k).name);
}

static int option_wrong(const struct cli_option *o, struct failure *failure, const char *text,
                        const char *trouble)
{
    return failure_set(failure, EX_USAGE, "--%s: '%s' %s", o->name, text, trouble);
}

static int set_choice(const struct cli_option *o, int *to, const char *text,
                      struct failure *failure)
{
    char words[200];
    for (int k = 0; o->choice(k).name; k++)
        if (!strcmp(o->choice(k).name, text)) return *to = k, 0;
    const struct renamed *r = renamed_find(o->name, text, strlen(text));
    if (r) return set_choice(o, to, r->is, failure);
    for (const struct cli_choice *g = o->gone; g && g->name; g++)
        if (!strcmp(g->name, text))
            return failure_set(failure, EX_USAGE, "--%s: %s is no longer available: %s", o->name,
                               text, g->help);
    option_words(o, words, sizeof words);
    return failure_set(failure, EX_USAGE, "--%s: '%s' is none of %s", o->name, text, words);
}

static int option_set_number(const struct cli_option *o, void *to, const char *text,
                             struct failure *failure)
{
    char *end;
    errno = 0;
    double x = number_read(text, &end);
    if (end == text || *end || !isfinite(x) || isspace((unsigned char)*text))
        return option_wrong(o, failure, text, "is not a number");
    bool open = o->kind == CLI_ABOVE || o->kind == CLI_BETWEEN;
    if (open ? !(x > o->min) : !(x >= o->min))
        return failure_set(failure, EX_USAGE, "--%s: %s must be %s %g", o->name, text,
                           open ? "above" : "at least", o->min);
    if (o->kind == CLI_BETWEEN ? !(x < o->max) : x > o->max)
        return failure_set(failure, EX_USAGE, "--%s: %s must be %s %g", o->name, text,
                           o->kind == CLI_BETWEEN ? "below" : "at most", o->max);
    if (o->kind == CLI_INT && x != floor(x))
        return option_wrong(o, failure, text, "is not a whole number");
    if (o->kind == CLI_INT)
        *(int64_t *)to = (int64_t)x;
    else
        *(double *)to = x;
    return 0;
}

/* A number and a unit of time, or none. Returns the unit in s; 0: there is none; below 0: it is no number, or no unit */
static double read_time(const char *text, double *x)
{
    static const struct {
        const char *name;
        double seconds;
    } units[] = { { "", 0 }, { "ms", 1e-3 }, { "s", 1 }, { "min", 60 }, { "h", 3600 } };
    char *end;
    *x = number_read(text, &end);
    if (end == text || !isfinite(*x) || isspace((unsigned char)*text)) return -1;
    for (size_t k = 0; k < sizeof units / sizeof *units; k++)
        if (!strcmp(end, units[k].name)) return units[k].seconds;
    return -1;
}

bool time_parse(double *seconds, const char *text)
{
    double x, unit = read_time(text, &x);
    *seconds = unit > 0 ? x * unit : x;
    return unit >= 0;
}

bool every_passed(const struct cli_every *e, double *last, double t)
{
    const double multiple = floor(t / e->seconds + 1e-6); // times of frames are rounded
    bool passed = multiple != *last;                      // NAN, too
    *last = multiple;
    return passed;
}

static int set_time(const struct cli_option *o, double *to, const char *text,
                    struct failure *failure)
{
    double x;
    if (!time_parse(&x, text))
        return option_wrong(o, failure, text, "is no time as 90 (seconds), 5ms, 90s, 10min or 2h");
    if (!(x > o->min && x <= o->max))
        return failure_set(failure, EX_USAGE, "--%s: %s must be above %g s and at most %g s",
                           o->name, text, o->min, o->max);
    *to = x;
    return 0;
}

static int set_every(const struct cli_option *o, struct cli_every *e, const char *text,
                     struct failure *failure)
{
    double x, unit = read_time(text, &x);
    if (unit < 0)
        return option_wrong(o, failure, text,
                            "is neither a whole number nor, as 0.01s or 5ms, a time");
    if (unit > 0 ? !(x > 0) : !(x >= 1 && x <= o->max && x == floor(x)))
        return failure_set(failure, EX_USAGE, "--%s: %s must be %s", o->name, text,
                           unit > 0 ? "above 0" : "a whole number, at least 1");
    *e = unit > 0 ? (struct cli_every){ 0, x * unit } : (struct cli_every){ (int64_t)x, 0 };
    return 0;
}

static int option_set_flag(const struct cli_option *o, bool *to, const char *text,
                           struct failure *failure)
{
    bool on = !text || !strcmp(text, "true");
    if (!on && strcmp(text, "false") != 0)
        return option_wrong(o, failure, text, "is neither true nor false");
    *to = (o->kind == CLI_FLAG) == on;
    return 0;
}

int option_set(const struct cli_option *o, void *to, const char *text, struct failure *failure)
{
    switch (o->kind) {
    case CLI_FLAG:
    case CLI_UNFLAG:
        return option_set_flag(o, to, text, failure);
    case CLI_TEXT:
        *(const char **)to = text;
        return 0;
    case CLI_CHOICE:
        return set_choice(o, to, text, failure);
    case CLI_TIME:
        return set_time(o, to, text, failure);
    case CLI_EVERY:
        return set_every(o, to, text, failure);
    default:
        return option_set_number(o, to, text, failure);
    }
}

/* Reads a range of steps. */

/* Reads a number, or nothing, up to a colon or the end, and moves *s there. */
static bool parse_part(const char **s, int64_t *x)
{
    char *end;
    errno = 0;
    if (**s != ':' && **s) {
        *x = strtoll(*s, &end, 10);
        if (end == *s || errno || *x < 0) return false;
        *s = end;
    }
    return **s == ':' || !**s;
}

bool range_parse(struct range *r, const char *s)
{
    *r = (struct range){ 0, INT64_MAX, 1 };
    if (!*s || !parse_part(&s, &r->from)) return false;
    if (!*s) { // one step alone
        r->to = r->from;
        return true;
    }
    s++;
    if (!parse_part(&s, &r->to)) return false;
    if (!*s) return r->from <= r->to;
    s++;
    return parse_part(&s, &r->by) && !*s && r->by > 0 && r->from <= r->to;
}
