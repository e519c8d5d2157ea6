#include "measure/measured.h"

#include "bodies/chosen.h"
#include "measure/follow.h"

#include <inttypes.h>
#include <string.h>

static void choose(const struct measure **chosen, const struct measure *m)
{
    int k = 0;
    while (chosen[k] && chosen[k] != m) k++;
    if (k < MOST_MEASURES) chosen[k] = m;
}

int measured_choose(const struct measure **chosen, const char *names, struct why *why)
{
    for (int k = 0; k <= MOST_MEASURES; k++) chosen[k] = NULL;
    for (const char *s = names;; s++) {
        size_t n = strcspn(s, ",");
        const struct measure *m = measure_named(s, n);
        if (n == 3 && !strncmp(s, "all", n))
            for (int k = 0; measure_at(k); k++) choose(chosen, measure_at(k));
        else if (!m)
            return why_set(why, EX_USAGE, "--measures: no '%.*s' (nsd-stat --list names them)",
                           (int)n, s);
        else
            choose(chosen, m);
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

int measured_keep(const struct measure *const *chosen, const struct snapshot *s, struct kept *first,
                  struct kept *before, struct why *why)
{
    bool pairs = false;
    struct kept now;
    for (int k = 0; chosen[k]; k++) pairs = pairs || chosen[k]->needs == NEEDS_CONTACTS_BEFORE;
    if (!s->first && kept_set(first, s->p, why)) return why->status;
    if (follow(&now, s, pairs, why)) return why->status;
    kept_free(before);
    *before = now;
    return 0;
}

/* Are --only and --tracer names of this document, whatever else it lacks? Returns 0, EX_DATAERR or EX_SOFTWARE. */
static int names_known(const struct snapshot *s, struct why *why)
{
    const struct packing *p = s->p;
    const char *only = *s->asked->only ? s->asked->only : NULL, *tracer = s->asked->tracer;
    struct chosen chosen;
    char kinds[200];
    size_t at = 0;
    if (chosen_init(&chosen, p, "--only", only, why)) return why->status;
    chosen_free(&chosen);
    if (!*tracer || !strcmp(tracer, "large")) return 0;
    for (int32_t k = 0; k < p->kinds; k++) {
        if (!strcmp(tracer, p->kind_name[k])) return 0;
        if (at < sizeof kinds)
            at += (size_t)snprintf(kinds + at, sizeof kinds - at, ", %s", p->kind_name[k]);
    }
    return why_set(why, EX_DATAERR, "--tracer: no kind '%s' here, but large%s%s", tracer, kinds,
                   at < sizeof kinds ? "" : "...");
}

int measured_run(struct table *t, const struct measure *const *chosen, const struct snapshot *s,
                 struct why *why)
{
    for (int k = 0; k < MOST_MEASURES; k++) t[k] = (struct table){ 0 };
    if (names_known(s, why)) return why->status;
    for (int k = 0; chosen[k]; k++)
        if (measure_run(&t[k], chosen[k], s, why)) return why->status;
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
    for (int k = 0; chosen[k]; k++) {
        fprintf(out, ",\"%s\":", chosen[k]->name);
        table_json(out, &t[k], chosen[k]->list);
    }
    for (int k = 0; chosen[k]; k++)
        if (*t[k].null)
            fprintf(out, "%s\"%s\":\"%s\"", mark, chosen[k]->name, t[k].null), mark = ",";
    fprintf(out, "%s}", *mark == ',' && mark[1] ? "" : "}");
}
