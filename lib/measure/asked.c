#include "measure/asked.h"

#include "base/number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* As many finite numbers as there are, from `least` to `most`, by commas; how many, or 0 with the reason */
static int measures_numbers(const char *name, const char *text, double *x, int least, int most,
                   struct failure *failure)
{
    const char *s = text;
    char *end;
    for (int k = 0; k < most; k++, s = end + 1) {
        x[k] = number_read(s, &end);
        if (end == s || !isfinite(x[k])) break;
        if (!*end && k + 1 >= least) return k + 1;
        if (*end != ',') break;
    }
    failure_set(failure, EX_USAGE, "--%s: '%s' is not %d numbers with commas between", name, text, most);
    return 0;
}

static int measures_set_box(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    double b[6] = { 0, 0, 0, 0, -INFINITY, INFINITY };
    int n = measures_numbers(name, text, b, 4, 6, failure);
    if (!n) return failure->status;
    if (n == 5) return failure_set(failure, EX_USAGE, "--box: '%s' has five numbers", text);
    for (int k = 0; k < n / 2; k++)
        if (!(b[2 * k] < b[2 * k + 1])) return failure_set(failure, EX_USAGE, "--box: '%s' is empty", text);
    for (int k = 0; k < 3; k++) a->lo[k] = b[2 * k], a->hi[k] = b[2 * k + 1];
    a->boxed = true;
    return 0;
}

static int set_layers(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    const char axes[] = "xyzr", *axis = *text ? strchr(axes, *text) : NULL;
    char *end = NULL;
    double n = axis && text[1] == ':' ? number_read(text + 2, &end) : 0;
    if (!end || *end || !(n >= 1 && n <= 1e6) || n != floor(n))
        return failure_set(failure, EX_USAGE, "--%s: '%s' is not x:N, y:N, z:N or r:N", name, text);
    a->axis = (int)(axis - axes), a->layers = (int64_t)n;
    return 0;
}

static int set_point(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    double x[3] = { 0 };
    if (!measures_numbers(name, text, x, 2, 3, failure)) return failure->status;
    a->point = v3(x[0], x[1], x[2]);
    return 0;
}

static int set_plane(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    double x[3] = { 0 };
    if (!measures_numbers(name, text, x, 2, 3, failure)) return failure->status;
    vec3 n = v3(x[0], x[1], x[2]);
    double size = v3_norm(n);
    if (!(size > 0 && size < INFINITY))
        return failure_set(failure, EX_USAGE, "--%s: '%s' is no direction", name, text);
    a->normal = v3_scale(1 / size, n);
    return 0;
}

/* Above 0 */
static int measures_set_number(double *to, const char *name, const char *text, struct failure *failure)
{
    char *end;
    double x = number_read(text, &end);
    if (end == text || *end || !(x > 0))
        return failure_set(failure, EX_USAGE, "--%s: '%s' is not a number above 0", name, text);
    *to = x;
    return 0;
}

static int set_radius(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    return measures_set_number(&a->radius, name, text, failure);
}

static int set_distance(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    double x = 0;
    if (measures_set_number(&x, name, text, failure)) return failure->status;
    if (!isfinite(x)) return failure_set(failure, EX_USAGE, "--%s: %s must be finite", name, text);
    a->distance = x;
    return 0;
}

static int set_bins(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    double x = 0;
    if (measures_set_number(&x, name, text, failure)) return failure->status;
    if (x != floor(x) || x > 1e6)
        return failure_set(failure, EX_USAGE, "--%s: %s must be a whole number, 1 to 1e6", name, text);
    a->bins = (int64_t)x;
    return 0;
}

static int set_only(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    size_t n = strlen(text);
    if (!n || n >= sizeof a->only)
        return failure_set(failure, EX_USAGE, "--%s: needs names, at most %zu bytes", name,
                       sizeof a->only - 1);
    memcpy(a->only, text, n + 1);
    return 0;
}

static int set_finite(double *x, const char *name, const char *text, struct failure *failure)
{
    double given = 0;
    if (measures_set_number(&given, name, text, failure)) return failure->status;
    if (!isfinite(given)) return failure_set(failure, EX_USAGE, "--%s: %s must be finite", name, text);
    *x = given;
    return 0;
}

static int set_wear(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    return set_finite(&a->wear, name, text, failure);
}

static int set_sample(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    return set_finite(&a->sample, name, text, failure);
}

static int set_tracer(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    if (!*text || strlen(text) >= sizeof a->tracer)
        return failure_set(failure, EX_USAGE, "--%s: '%.40s' is not the name of a kind, or large", name,
                       text);
    memcpy(a->tracer, text, strlen(text) + 1);
    return 0;
}

static const struct {
    const char *name;
    int (*set)(struct asked *, const char *name, const char *text, struct failure *);
} settings[] = {
    { "box", measures_set_box },           { "layers", set_layers }, { "point", set_point },
    { "plane", set_plane },       { "radius", set_radius }, { "bins", set_bins },
    { "distance", set_distance }, { "only", set_only },     { "wear", set_wear },
    { "sample", set_sample },     { "tracer", set_tracer },
};
enum { SETTINGS = sizeof settings / sizeof settings[0] };

bool asked_has(const char *name)
{
    for (int k = 0; k < SETTINGS; k++)
        if (!strcmp(settings[k].name, name)) return true;
    return false;
}

int asked_set(struct asked *a, const char *name, const char *text, struct failure *failure)
{
    for (int k = 0; k < SETTINGS; k++)
        if (!strcmp(settings[k].name, name)) return settings[k].set(a, name, text, failure);
    return failure_set(failure, EX_USAGE, "--%s: no such option", name);
}
