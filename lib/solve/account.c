/* solve/account.c: what is watched of a run [solve/account.h]. */
#include "solve/account.h"

#include <math.h>
#include <stdio.h>

static double overlap(const struct report *r, double bodies[2])
{
    for (int k = 0; k < 2; k++) bodies[k] = r->depth.pair[k];
    return r->depth.deepest;
}

static double approach(const struct report *r, double bodies[2])
{
    (void)bodies;
    return r->err.max_penetration_true;
}

static double wedged(const struct report *r, double bodies[2])
{
    bodies[0] = r->depth.wedged_id;
    return (double)r->depth.wedged;
}

static double passed(const struct report *r, double bodies[2])
{
    bodies[0] = r->passed_id, bodies[1] = r->passed_through;
    return r->watched ? (double)r->passed : 0;
}

static double unconverged(const struct report *r, double bodies[2])
{
    (void)bodies;
    return !r->converged;
}

const struct watched account_watched[ACCOUNT_ROWS] = {
    [ACCOUNT_OVERLAP] = { "overlap", "1", "overlap %.3g of a radius", false, 2, 0.01, 0.1, overlap,
                          "a smaller dt leaves less: --dt, or --dt auto:0.01" },
    [ACCOUNT_APPROACH] = { "approach", "m s-1", "approach %.3g m/s", false, 0, INFINITY, INFINITY,
                           approach, "" },
    [ACCOUNT_WEDGED] = { "wedged", "1", "%.0f wedged", false, 1, 0, 0, wedged,
                         "held from two sides, deeper than 0.1 of its radius" },
    [ACCOUNT_PASSED] = { "passed", "1", "%.0f went through a wall or another body", true, 2, 0, 0,
                         passed, "a smaller dt finds such contacts" },
    [ACCOUNT_UNCONVERGED] = { "unconverged", "1", "%.0f steps not converged", true, 0, INFINITY, 0,
                              unconverged, "" },
};

unsigned account_add(struct account *a, const struct report *report)
{
    unsigned news = 0;
    a->steps++;
    for (int k = 0; k < ACCOUNT_ROWS; k++) {
        const struct watched *w = &account_watched[k];
        struct account_entry *e = &a->worst[k], now = { .step = (double)report->step };
        double before = e->value;
        now.value = w->of(report, now.bodies);
        if (w->adds && e->step > 0)
            e->value += now.value;
        else if (!(now.value <= e->value) && !isnan(before)) // what is not a number lasts
            *e = now;
        if (!(e->value <= w->warns) && before <= w->warns) news |= 1U << k;
    }
    return news;
}

bool account_row_fails(const struct account *a, enum account_row row)
{
    return !(a->worst[row].value <= account_watched[row].fails);
}

bool account_fails(const struct account *a)
{
    for (int k = 0; k < ACCOUNT_ROWS; k++)
        if (account_row_fails(a, (enum account_row)k)) return true;
    return false;
}

static void say_body(double id, const struct names *names, char *text, size_t room)
{
    const char *name = id < 0 ? names_of_wall(names, (int32_t)(-1 - id)) : NULL;
    if (name)
        snprintf(text, room, "wall %.0f (%s)", -1 - id, name);
    else
        snprintf(text, room, id < 0 ? "wall %.0f" : "%.0f", id < 0 ? -1 - id : id);
}

void account_says(const struct account *a, enum account_row row, const struct names *names,
                  char *text, size_t room)
{
    const struct watched *w = &account_watched[row];
    const struct account_entry *e = &a->worst[row];
    char one[40 + NAME_BYTES], other[40 + NAME_BYTES] = "";
    int n = snprintf(text, room, w->says, e->value);
    if (e->value == 0 || n < 0 || (size_t)n >= room) return;
    text += n, room -= (size_t)n;
    say_body(e->bodies[0], names, one, sizeof one);
    say_body(e->bodies[1], names, other, sizeof other);
    if (w->bodies == 2)
        snprintf(text, room, " (step %.0f, bodies %s and %s)", e->step, one, other);
    else if (w->bodies == 1)
        snprintf(text, room, " (step %.0f, body %s)", e->step, one);
    else
        snprintf(text, room, " (%sstep %.0f)", w->adds ? "first " : "", e->step);
}
