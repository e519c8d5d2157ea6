/* state/account.c: what is watched of a run [state/account.h]. */
#include "state/account.h"

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

static double pinched(const struct report *r, double bodies[2])
{
    bodies[0] = r->depth.pinched_id;
    return (double)r->depth.pinched;
}

static double fast(const struct report *r, double bodies[2])
{
    bodies[0] = r->fast_id;
    return r->watched ? (double)r->fast : 0;
}

static double unconverged(const struct report *r, double bodies[2])
{
    for (int k = 0; k < 2; k++) bodies[k] = r->unsolved[k];
    return !r->converged;
}

const struct watched account_watched[ACCOUNT_ROWS] = {
    [ACCOUNT_OVERLAP] = { "overlap", "overlap", "1", "overlap %.3g of a radius", NULL, false, 2,
                          0.01, 0.1, overlap, "a smaller dt leaves less, and so do small steps" },
    [ACCOUNT_APPROACH] = { "approach", "approach", "m s-1", "approach %.3g m/s", NULL, false, 0,
                           INFINITY, INFINITY, approach, "" },
    [ACCOUNT_PINCHED] = { "pinched", "wedged", "1", "%.0f pinched", NULL, false, 1, 0, 0, pinched,
                          "held from two sides, deeper than 0.1 of its radius" },
    [ACCOUNT_FAST] = { "fast", "passed", "1", "%.0f too fast", NULL, false, 1, 0, 0, fast,
                       "farther in a step than it is thick, it may have passed through others: "
                       "leave out "
                       "--dt, for small steps, or take a smaller one" },
    [ACCOUNT_UNCONVERGED] = { "unconverged", "unconverged", "1", "%.0f steps not converged",
                              "1 step not converged", true, 2, 0, 0, unconverged,
                              "forces and motion are not those of the laws" },
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

bool account_step_fails(const struct report *report)
{
    struct account one = { 0 };
    account_add(&one, report);
    return account_fails(&one);
}

/* "bodies 3 and 8", "wall 1 (lid) and body 3" */
static void say_bodies(const double *id, int n, const struct names *names, char *text, size_t room)
{
    bool plain = n == 2 && id[0] >= 0 && id[1] >= 0;
    size_t at = (size_t)snprintf(text, room, plain ? "bodies " : "");
    for (int k = 0; k < n && at < room; k++) {
        const char *name = id[k] < 0 ? names_of_wall(names, (int32_t)(-1 - id[k])) : NULL;
        at += (size_t)snprintf(text + at, room - at, "%s%s%.0f%s%s%s", k ? " and " : "",
                               id[k] < 0 ? "wall "
                               : plain   ? ""
                                         : "body ",
                               id[k] < 0 ? -1 - id[k] : id[k], name ? " (" : "", name ? name : "",
                               name ? ")" : "");
    }
}

void account_says(const struct account *a, enum account_row row, const struct names *names,
                  char *text, size_t room)
{
    const struct watched *w = &account_watched[row];
    const struct account_entry *e = &a->worst[row];
    char bodies[2 * (40 + NAME_BYTES)];
    bool one = w->one && e->value == 1;
    int n = one ? snprintf(text, room, "%s", w->one) : snprintf(text, room, w->says, e->value);
    if (e->value == 0 || n < 0 || (size_t)n >= room) return;
    text += n, room -= (size_t)n;
    say_bodies(e->bodies, w->bodies, names, bodies, sizeof bodies);
    snprintf(text, room, " (%sstep %.0f%s%s)", w->adds && e->value > 1 ? "first " : "", e->step,
             w->bodies ? ", " : "", bodies);
}
