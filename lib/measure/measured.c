#include "measure/measured.h"

#include "measure/follow.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

static void measured_choose_one(const struct measure **chosen, const struct measure *m)
{
    int k = 0;
    while (chosen[k] && chosen[k] != m) k++;
    if (k < MOST_MEASURES) chosen[k] = m;
}

int measured_choose(const struct measure **chosen, const char *names, struct failure *failure)
{
    for (int k = 0; k <= MOST_MEASURES; k++) chosen[k] = NULL;
    for (const char *s = names;; s++) {
        size_t n = strcspn(s, ",");
        const struct measure *m = measure_named(s, n);
        if (n == 3 && !strncmp(s, "all", n))
            for (int k = 0; measure_at(k); k++) measured_choose_one(chosen, measure_at(k));
        else if (!m)
            return failure_set(failure, EX_USAGE, "--measures: no '%.*s' (nsd-stat --list names them)",
                           (int)n, s);
        else
            measured_choose_one(chosen, m);
        s += n;
        if (!*s) return 0;
    }
}

bool measured_remember(const struct measure *const *chosen)
{
    for (int k = 0; chosen[k]; k++)
        if (chosen[k]->remembers || chosen[k]->needs == NEEDS_BEFORE ||
            chosen[k]->needs == NEEDS_SUMS || chosen[k]->needs == NEEDS_CONTACTS_BEFORE)
            return true;
    return false;
}

int measured_keep(const struct measure *const *chosen, const struct snapshot *s, struct frame_memory *first,
                  struct frame_memory *before, struct failure *failure)
{
    bool pairs = false;
    struct frame_memory now;
    for (int k = 0; chosen[k]; k++) pairs = pairs || chosen[k]->needs == NEEDS_CONTACTS_BEFORE;
    if (!s->first && frame_memory_set(first, s->p, failure)) return failure->status;
    if (follow(&now, s, pairs, failure)) return failure->status;
    frame_memory_free(before);
    *before = now;
    return 0;
}

/* Can each measure keep to what --only names? Returns 0 or EX_DATAERR. */
static int check_only(const struct measure *const *chosen, const struct snapshot *s,
                      struct failure *failure)
{
    bool used = !s->only.any;
    for (int k = 0; chosen[k]; k++) {
        const enum keeps_to to = chosen[k]->keeps_to;
        if (to == KEEPS_TO_NOTHING && s->only.bodies)
            return failure_set(failure, EX_DATAERR,
                           "--only: %s is measured of all bodies, not of a group or kind",
                           chosen[k]->name);
        used = used || (to == KEEPS_TO_WALLS && s->only.walls) ||
               (to == KEEPS_TO_BODIES && s->only.bodies);
    }
    const char *of = s->only.walls ? "walls" : "bodies";
    if (used) return 0;
    return failure_set(failure, EX_DATAERR, "--only: '%s' names %s, and no measure of %s is chosen",
                   s->asked->only, of, of);
}

int measured_run(struct table *t, const struct measure *const *chosen, const struct snapshot *s,
                 struct failure *failure)
{
    for (int k = 0; k < MOST_MEASURES; k++) t[k] = (struct table){ 0 };
    if (failure->status || check_only(chosen, s, failure)) return failure->status;
    for (int k = 0; chosen[k]; k++)
        if (measure_run(&t[k], chosen[k], s, failure)) return failure->status;
    return 0;
}

void measured_free(struct table *t)
{
    for (int k = 0; k < MOST_MEASURES; k++) table_free(&t[k]);
}

void measured_json(FILE *out, const struct snapshot *s, const struct measure *const *chosen,
                   const struct table *t)
{
    const char *mark = ",\"why\":{";
    fprintf(out, "{\"step\":%" PRId64 ",\"time\":", s->p->step);
    print_number(out, s->p->t, "null");
    fprintf(out, ",\"bodies\":%" PRId64 ",\"contacts\":", s->p->n);
    s->s ? fprintf(out, "%" PRId64, s->s->n) : fprintf(out, "null");
    if (!isnan(s->unconverged)) fprintf(out, ",\"unconverged\":%.0f", s->unconverged);
    for (int k = 0; chosen[k]; k++) {
        fprintf(out, ",\"%s\":", chosen[k]->name);
        table_json(out, &t[k], chosen[k]->list);
    }
    for (int k = 0; chosen[k]; k++)
        if (*t[k].null)
            fprintf(out, "%s\"%s\":\"%s\"", mark, chosen[k]->name, t[k].null), mark = ",";
    fprintf(out, "%s}", *mark == ',' && mark[1] ? "" : "}");
}
