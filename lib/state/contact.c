/* state/contact.c: lists of contacts, their bases, and reactions carried from step to step. */
#include "state/contact.h"

#include "base/array.h"
#include "base/team.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum {
    CONTACTS_PER_THREAD =
        16384 /* the fewest contacts that are worth a thread: 100 us of looking at each */
};

/* The arrays beside the contacts */
enum { BESIDE_FOUND, BESIDE_LAW, BESIDE_MOMENT, BESIDE };
static const struct {
    size_t at, bytes; /* in struct contacts; of a row */
} beside[BESIDE] = {
    [BESIDE_FOUND] = { offsetof(struct contacts, found), sizeof(struct found) },
    [BESIDE_LAW] = { offsetof(struct contacts, law), sizeof(struct contact_law) },
    [BESIDE_MOMENT] = { offsetof(struct contacts, moment), sizeof(double[3]) },
};

static void *beside_of(const struct contacts *s, int k)
{
    void *rows;
    memcpy(&rows, (const char *)s + beside[k].at, sizeof rows);
    return rows;
}

/* rows in place of what there was */
static void beside_set(struct contacts *s, int k, void *rows)
{
    free(beside_of(s, k));
    memcpy((char *)s + beside[k].at, &rows, sizeof rows);
}

static int beside_alloc(struct contacts *s, int k)
{
    beside_set(s, k, NULL);
    beside_set(s, k, calloc((size_t)s->n + 1, beside[k].bytes));
    return beside_of(s, k) ? 0 : -1;
}

void contacts_free(struct contacts *s)
{
    for (int k = 0; k < BESIDE; k++) beside_set(s, k, NULL);
    free(s->c);
    *s = (struct contacts){ 0 };
}

void contacts_free_found(struct contacts *s)
{
    beside_set(s, BESIDE_FOUND, NULL), beside_set(s, BESIDE_MOMENT, NULL);
}

void contacts_free_tie(struct contacts *s)
{
    beside_set(s, BESIDE_LAW, NULL);
}

int contacts_alloc_found(struct contacts *s)
{
    contacts_free_found(s);
    return beside_alloc(s, BESIDE_FOUND);
}

int contacts_alloc_laws(struct contacts *s)
{
    return beside_alloc(s, BESIDE_LAW);
}

int contacts_alloc_moment(struct contacts *s)
{
    return beside_alloc(s, BESIDE_MOMENT);
}

int contacts_copy(struct contacts *to, const struct contacts *from)
{
    const size_t n = (size_t)from->n;
    *to = (struct contacts){ .n = from->n, .room = from->n };
    bool good = (to->c = malloc((n + 1) * sizeof *to->c));
    if (good && n) memcpy(to->c, from->c, n * sizeof *to->c);
    for (int k = 0; k < BESIDE && good; k++) {
        if (!beside_of(from, k)) continue;
        good = !beside_alloc(to, k);
        if (good && n) memcpy(beside_of(to, k), beside_of(from, k), n * beside[k].bytes);
    }
    if (!good) contacts_free(to);
    return good ? 0 : -1;
}

bool contacts_reserve(struct contacts *s, int64_t more)
{
    return array_grow(&s->c, &s->room, s->n + more, sizeof *s->c);
}

struct contact *contacts_add(struct contacts *s, int32_t a, int32_t b)
{
    if (s->n == s->room && !contacts_reserve(s, 64)) return NULL;
    struct contact *c = &s->c[s->n++];
    *c = (struct contact){ .a = a, .b = b };
    return c;
}

void contacts_settle(struct contacts *out)
{
    int64_t k = out->n - 1;
    struct contact new = out->c[k];
    const struct contact_key key = contact_key(&new);
    for (; k > 0; k--) {
        const struct contact *c = &out->c[k - 1];
        if (c->a != new.a || c->b != new.b) break;
        int order = contact_key_order(contact_key(c), key);
        if (order < 0) break;
        if (order == 0) {
            if (new.gap < c->gap) out->c[k - 1] = new;
            memmove(&out->c[k], &out->c[k + 1], (size_t)(out->n - 1 - k) * sizeof *out->c);
            out->n--;
            return;
        }
        out->c[k] = *c;
    }
    out->c[k] = new;
}

void contact_basis(struct contact *c, int dim, vec3 n)
{
    c->n = n;
    if (dim == 2) {
        c->t1 = v3(-n.y, n.x, 0);
        return;
    }
    // [Duff et al. 2017]: without a branch, and |sign + n_z| >= 1
    double sign = copysign(1, n.z), a = -sign / (sign + n.z);
    c->t1 = v3(1 + n.x * n.x * a, n.x * n.y * a, -sign * n.x);
}

static double deepest(void *arg, int64_t first, int64_t end)
{
    const struct contacts *s = arg;
    double depth = 0;
    for (int64_t i = first; i < end; i++) depth = dmax(depth, -s->c[i].gap);
    return depth;
}

int64_t contacts_unsolved(const struct contacts *s, double *off)
{
    int64_t found = -1;
    *off = -2;
    for (int64_t i = 0; s->found && i < s->n; i++) {
        const struct found *f = &s->found[i];
        const bool jammed = f->status == STATUS_JAMMED;
        const double x = jammed ? f->r[0] : -f->u[0];
        const double ranks = (jammed ? 2 : 0) + x / (1 + fabs(x)); // rises with x, within (-1, 1)
        if (!(ranks <= *off)) found = i, *off = ranks;
    }
    return found;
}

double contacts_max_overlap(const struct contacts *s)
{
    return team_most(team_size(), s->n, CONTACTS_PER_THREAD, deepest, (void *)s);
}

static const char *contact_trouble(const struct contact *c, const struct found *found,
                                   int64_t bodies, int32_t walls)
{
    if (c->b < 0 || c->b >= bodies || c->a >= bodies || c->a < -walls || c->a == c->b)
        return "no such bodies";
    if (!v3_finite(c->x) || !isfinite(c->gap)) return "point or gap is not finite";
    if (!(fabs(v3_dot(c->n, c->n) - 1) < 1e-6 && fabs(v3_dot(c->t1, c->t1) - 1) < 1e-6 &&
          fabs(v3_dot(c->n, c->t1)) < 1e-6))
        return "frame is not orthonormal";
#define CHECK(member, name, unit, key, most, range)                                                \
    if (!(c->member >= 0 && c->member <= (most) && isfinite(c->member))) return name " " range;
    EACH_PAIR_COLUMN(CHECK)
#undef CHECK
    for (int k = 0; found && k < 3; k++)
        if (!isfinite(found->r[k]) || !isfinite(found->u[k]))
            return "reaction or velocity is not finite";
    return NULL;
}

static bool contact_not_negative(double x)
{
    return x >= 0 && isfinite(x);
}

static const char *contact_law_trouble(const struct contact_law *t)
{
    if (!contact_not_negative(t->pull) || !contact_not_negative(t->offset) ||
        !isfinite(t->jump[0]) || (t->jump[0] < 0 && t->spring[0] == 0) || !isfinite(t->jump[1]) ||
        !isfinite(t->jump[2]))
        return "its pull, offset or jump is out of range";
    if (!contact_not_negative(t->stiff[0]) || !contact_not_negative(t->stiff[1]) ||
        !(t->beta >= 0 && t->beta <= 1))
        return "its stiffness or beta is out of range";
    if (!contact_not_negative(t->spring[0]) || !contact_not_negative(t->spring[1]) ||
        (t->spring[0] > 0) != (t->spring[1] > 0))
        return "its spring is out of range";
    for (int k = 0; k < 3; k++)
        if (!isfinite(t->hit[k])) return "its impulse of impact is not finite";
    for (int k = 0; k < 3; k++)
        if (!isfinite(t->turn[k])) return "the turn of its spring is not finite";
    if (!contact_not_negative(t->roll)) return "the stiffness of its moment is out of range";
    if (!contact_not_negative(t->mu_r) || !contact_not_negative(t->mu_p))
        return "mu_r and mu_p must not be negative";
    const int states = t->spring[0] > 0 ? CONTACT_LAW_STATES : CONTACT_LAW_MEETS;
    return t->state >= 0 && t->state < states ? NULL : "its tie has no such state";
}

int contacts_check(const struct contacts *s, int64_t bodies, int32_t walls, struct failure *failure)
{
    for (int64_t i = 0; i < s->n; i++) {
        const char *what = contact_trouble(&s->c[i], s->found ? &s->found[i] : NULL, bodies, walls);
        for (int k = 0; k < 3 && s->moment; k++)
            if (!isfinite(s->moment[i][k])) what = "moment is not finite";
        if (!what && s->law) what = contact_law_trouble(&s->law[i]);
        if (what) return failure_set(failure, EX_DATAERR, "contact %lld: %s", (long long)i, what);
    }
    return 0;
}

void contact_arms(const struct contact *c, vec3 xa, vec3 xb, double *la, double *lb)
{
    *la = c->a < 0 ? 0 : v3_dot(v3_sub(c->x, xa), c->n);
    *lb = v3_dot(v3_sub(xb, c->x), c->n);
}
