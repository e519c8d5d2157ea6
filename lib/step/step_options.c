/* step/step_options.c: see step/step_options.h. */
#include "step/step_options.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>

#define MOST 1e300 /* of a number without a bound: larger than any that is meant */

/* How Newton goes in a contact: the paper's way, or with its steps halved where they do harm. */
enum newton_steps { NEWTON_PLAIN, NEWTON_LINESEARCH, NEWTON_COUNT };
static const char *const newton_name[NEWTON_COUNT] = { "plain", "linesearch" };

/* ---- what an option is when it is not given ---- */

struct step_options_usual {
    enum criterion packing, fclib; /* the criterion of packings, and of FCLIB problems */
    double eps[CRITERION_COUNT];   /* of packings, in each criterion's own units */
    double fclib_eps;              /* of FCLIB problems, whatever the criterion */
    int32_t nlgs_sweeps, sweeps;   /* the limit of nlgs, and of every other solver: */
    int32_t tight_sweeps;          /* this one where eps is below */
    double tight;
    enum order nlgs_order, order; /* the sweep's, likewise */
    double relax;                 /* 0: the solver's own, in its entry of solvers[] */
    bool warm;                    /* start from the reactions at hand, else from 0 */
    enum newton_steps newton;
    double newton_eps; /* of |(r, rho b)| */
    int newton_max;    /* steps for a contact in a sweep */
    enum overlap overlap;
    double small; /* radii: small steps; 0: each step is one solve */
};

/* nsd's own choice. --help shows it from here; nsd-solve(1) and nsd-step(1) repeat it. */
static const struct step_options_usual usual = {
    .packing = CRITERION_VELOCITY, // it sees every contact, however small its reaction
    .fclib = CRITERION_NATURAL,
    .eps[CRITERION_GLOB] = 1e-10,   // a sum of m/s, m/s, N and W: the paper's
    .eps[CRITERION_SCALED] = 1e-3,  // costs as much as the next, or more
    .eps[CRITERION_VELOCITY] = 1,   // g dt; while that is cheap a thousandth [solve/solver.c]
    .eps[CRITERION_NATURAL] = 1e-4, // the loosest with which overlaps do not grow [nsd-methods(7)]
    .fclib_eps = 1e-10,     // one problem deserves its solution: all that we have take a second
    .nlgs_sweeps = 5000,    // the paper's
    .sweeps = 20000,        // which one step in ten thousand does not end with
    .tight_sweeps = 100000, // twice what the slowest of good steps took
    .tight = 1e-6,
    .nlgs_order = ORDER_NATURAL, // the paper's
    .order = ORDER_COLOUR,       // eight contacts at once, on any number of threads
    .relax = 0,                  // each solver has measured its own
    .warm = true,                // of CRITERION_VELOCITY; others start from 0, as the paper
    .newton = NEWTON_LINESEARCH, // plain steps run in circles at some contacts
    .newton_eps = 1e-13,         // about a thousand roundings: as if it were exact
    .newton_max = 100,           // after which the exact solution stands in
    .overlap = OVERLAP_PROJECT,  // bounds overlap, adds no velocity, costs nothing [nsd-methods(7)]
    .small = 0.01,               // a tenth of the overlap at which a step fails [nsd-methods(7)]
};

/* --protocol paper: that of the paper's tables, which does not change with nsd's choice. */
static const struct step_options_usual paper = {
    .packing = CRITERION_GLOB,
    .fclib = CRITERION_GLOB,
    .eps = { 1e-10, 1e-10, 1e-10, 1e-10 },
    .fclib_eps = 1e-10,
    .nlgs_sweeps = 5000,
    .sweeps = 5000,
    .tight_sweeps = 5000,
    .nlgs_order = ORDER_NATURAL,
    .order = ORDER_NATURAL,
    .relax = 1,
    .warm = false,
    .newton = NEWTON_LINESEARCH, // the paper's own Newton is asked for with --newton, --newton-abs
    .newton_eps = 1e-13,
    .newton_max = 100,
    .overlap = OVERLAP_KEEP,
};

struct options options = { .threads = 1 };

const char *options_usual(const void *to)
{
    static char text[100];
    const struct step_options_usual *u = &usual;
    const size_t room = sizeof text;
    if (to == &options.tolerance)
        snprintf(text, room, "%g; %g for FCLIB", u->eps[u->packing], u->fclib_eps);
    if (to == &options.newton) return newton_name[u->newton];
    if (to == &options.warm) return u->warm ? "warm" : "cold";
    if (to == &options.criterion)
        snprintf(text, room, u->packing == u->fclib ? "%s" : "%s; %s for FCLIB",
                 criterion_name[u->packing], criterion_name[u->fclib]);
    if (to == &options.max_sweeps)
        snprintf(text, room, "%d nlgs, else %d; %d below %g", u->nlgs_sweeps, u->sweeps,
                 u->tight_sweeps, u->tight);
    if (to == &options.order)
        snprintf(text, room, u->nlgs_order == u->order ? "%s" : "%s for nlgs, else %s",
                 order_name[u->nlgs_order], order_name[u->order]);
    if (to == &options.relax)
        snprintf(text, room, u->relax > 0 ? "%g" : "%g for nlgs, else the solver's",
                 u->relax > 0 ? u->relax : solver_nlgs.relax);
    if (to == &options.newton_eps) snprintf(text, room, "%g", u->newton_eps);
    if (to == &options.newton_max) snprintf(text, room, "%d", u->newton_max);
    if (to == &options.overlap)
        snprintf(text, room, "the document's; %s", overlap_name[u->overlap]);
    if (to == &options.small) snprintf(text, room, "%g; see the manual", u->small);
    return text;
}

/* ---- the words that options take, from the tables of what there is ---- */

static struct cli_choice method_choice(int k)
{
    if (k == 0) return (struct cli_choice){ "auto", "choose the solver, as --solver auto" };
    const struct method *m = methods[k - 1];
    return m ? (struct cli_choice){ m->name, m->help } : (struct cli_choice){ NULL, NULL };
}

static struct cli_choice solver_choice(int k)
{
    return (struct cli_choice){ solvers[k] ? solvers[k]->name : NULL, NULL };
}

static struct cli_choice protocol_choice(int k)
{
    static const char *const name[] = { "nsd", "paper" }; // options.protocol: is it the paper's?
    return (struct cli_choice){ k < 2 ? name[k] : NULL, NULL };
}

/* Solvers that solved nothing that auto does not [nsd-methods(7)] */
static const struct cli_choice solvers_gone[] = { { "cg", "auto solves all that it solved" },
                                                  { "prox", "auto solves all that it solved" },
                                                  { "ipm", "auto uses it where it pays" },
                                                  { NULL, NULL } };

static struct cli_choice criterion_choice(int k)
{
    return (struct cli_choice){ k < CRITERION_COUNT ? criterion_name[k] : NULL, NULL };
}

static struct cli_choice order_choice(int k)
{
    return (struct cli_choice){ k < ORDER_COUNT ? order_name[k] : NULL, NULL };
}

static struct cli_choice newton_choice(int k)
{
    return (struct cli_choice){ k < NEWTON_COUNT ? newton_name[k] : NULL, NULL };
}

struct cli_choice options_overlap_choice(int k)
{
    return (struct cli_choice){ k + 1 < OVERLAP_COUNT ? overlap_name[k + 1] : NULL, NULL };
}

/* ---- the options ---- */

const struct cli_option options_solve[] = {
    { CLI_CHOICE, 0, "protocol", &options.protocol, .choice = protocol_choice,
      .help = "set the defaults: nsd's, or those of the paper, which needs -m [nsd]" },
    { CLI_CHOICE, 'm', "local", &options.local, .choice = method_choice,
      .help = "solve by Gauss-Seidel with this local method [auto]" },
    { CLI_CHOICE, 0, "solver", &options.solver, .choice = solver_choice, .gone = solvers_gone,
      .help = "solve all contacts with this solver [nlgs with -m, else auto]" },
    { CLI_REAL, 0, "tolerance", &options.tolerance, "TOL", .max = MOST,
      .help = "stop when the criterion is at most TOL", .usual = options_usual },
    { CLI_CHOICE, 0, "criterion", &options.criterion, .choice = criterion_choice,
      .help = "compare this error with TOL", .usual = options_usual },
    { CLI_INT, 0, "max-sweeps", &options.max_sweeps, "N", .max = 2e9,
      .help = "give up after N sweeps", .usual = options_usual },
    { CLI_TIME, 0, "max-seconds", &options.max_seconds, "T", .max = MOST,
      .help = "give up after T: 90 or 90s, 10min; keep the best iterate [no limit]" },
    { CLI_ABOVE, 0, "alpha", &options.alpha, "A", .max = MOST,
      .help = "set rho = A m_red [1.75 (sbp, sal) or 1 (ebp, eal) / lambda_max]" },
    { CLI_CHOICE, 0, "newton", &options.newton, .choice = newton_choice,
      .help = "choose Newton's steps in ebp and eal; plain: the paper", .usual = options_usual },
    { CLI_ABOVE, 0, "newton-tolerance", &options.newton_eps, "TOL", .max = 1,
      .help = "stop Newton when |Z| <= TOL |(r, rho b)|", .usual = options_usual },
    { CLI_ABOVE, 0, "newton-abs", &options.newton_abs, "TOL", .max = MOST,
      .help = "stop Newton when |Z| <= TOL with r in N, as in the paper" },
    { CLI_INT, 0, "newton-max", &options.newton_max, "N", .min = 1, .max = 1e6,
      .help = "make at most N Newton steps per contact and sweep", .usual = options_usual },
    { CLI_BETWEEN, 0, "relax", &options.relax, "OMEGA", .max = 2,
      .help = "relax by OMEGA, between 0 and 2", .usual = options_usual },
    { CLI_CHOICE, 0, "order", &options.order, .choice = order_choice,
      .help = "order contacts; natural: the paper", .usual = options_usual },
    { CLI_FLAG, 0, "every-sweep", &options.every_sweep,
      .help = "evaluate the criterion after every sweep [if it may be met]" },
    { 0 },
};

const struct cli_option options_detect[] = {
    { CLI_REAL, 0, "gap", &options.gap, "G", .max = MOST,
      .help = "detect pairs with a predicted gap of at most G m [0]" },
    { CLI_REAL, 0, "theta", &options.theta, "T", .max = 1,
      .help = "predict the position q + (1 - T) dt qdot [document, else 0.5]" },
    { CLI_CHOICE, 0, "overlap-rule", &options.overlap, .choice = options_overlap_choice,
      .help = "treat overlaps; keep: the paper", .usual = options_usual },
    { 0 },
};

/* ---- which of them are given ---- */

/* Members of which tools have options of their own */
const void *const options_others[] = { &options.warm, &options.small,  &options.bound,
                                       &options.dt,   &options.device, NULL };

/* One bit for each row of both tables, and for each of the others */
static uint64_t bit_of(const void *to)
{
    uint64_t bit = 1;
    for (int t = 0; t < 2; t++)
        for (const struct cli_option *o = t ? options_detect : options_solve; o->kind;
             o++, bit <<= 1)
            if (o->to == to) return bit;
    for (const void *const *other = options_others; *other; other++, bit <<= 1)
        if (*other == to) return bit;
    return 0;
}

void options_give(struct options *o, const void *to)
{
    o->given |= bit_of(to);
}

bool options_has(const struct options *o, const void *to)
{
    return o->given & bit_of(to);
}

void *options_member(struct options *o, const void *to)
{
    return (char *)o + ((const char *)to - (const char *)&options);
}

/* A method that is named stands for the paper's Gauss-Seidel with it. */
static const struct solver *solver_of(const struct options *o)
{
    if (options_has(o, &options.solver)) return solvers[o->solver];
    return o->local ? &solver_nlgs : &solver_auto;
}

/* The option where it is given, else what stands for it */
#define OPTION(name, otherwise) (options_has(o, &options.name) ? o->name : (otherwise))

/* A device needs many contacts at once. */
static int order_usual(const struct options *o, enum order otherwise)
{
    return (int)(o->device ? ORDER_COLOUR : otherwise);
}

struct step_opt options_step_of(const struct options *o, double dt, bool foreign)
{
    const struct step_options_usual *u = o->protocol ? &paper : &usual;
    const struct solver *solver = solver_of(o);
    bool nlgs = solver == &solver_nlgs;
    int criterion = OPTION(criterion, (int)(foreign ? u->fclib : u->packing));
    double eps = OPTION(tolerance, foreign ? u->fclib_eps : u->eps[criterion]);
    const enum order order =
        (enum order)OPTION(order, order_usual(o, nlgs ? u->nlgs_order : u->order));
    int32_t sweeps = nlgs ? u->nlgs_sweeps : eps < u->tight ? u->tight_sweeps : u->sweeps;
    return (struct step_opt){
        .gap = o->gap,
        .alpha = o->alpha,
        .order = order,
        .as_is = o->protocol,
        .bound = o->bound,
        .small_warm = OPTION(warm, true),
        .warm = OPTION(warm, u->warm && criterion == CRITERION_VELOCITY && order != ORDER_BLOCK),
        .solve = { .global = solver,
                   .method = o->local ? methods[o->local - 1] : &local_exact,
                   .local = { .plain = OPTION(newton, (int)u->newton) == NEWTON_PLAIN,
                              .newton_eps = OPTION(newton_eps, u->newton_eps),
                              .newton_abs = o->newton_abs * dt, // forces there, impulses here
                              .newton_max = (int)OPTION(newton_max, u->newton_max) },
                   .criterion = (enum criterion)criterion,
                   .eps = eps,
                   .max_sweeps = (int32_t)OPTION(max_sweeps, sweeps),
                   .max_seconds = o->max_seconds,
                   .relax = OPTION(relax, u->relax > 0 ? u->relax : solver->relax),
                   .threads = (int)o->threads,
                   .every_sweep = o->every_sweep,
                   .history = o->history },
    };
}

char *options_json_of(const struct options *asked, const struct step_opt *o)
{
    const struct solve_opt *n = &o->solve;
    json_t *j = json_object();
    json_object_set_new(j, "global", json_string(n->global->name));
    json_object_set_new(j, "local", json_string(n->method->name));
    json_object_set_new(j, "eps", json_real(n->eps));
    json_object_set_new(j, "criterion", json_string(criterion_name[n->criterion]));
    json_object_set_new(j, "max_sweeps", json_integer(n->max_sweeps));
    if (n->max_seconds > 0) json_object_set_new(j, "max_seconds", json_real(n->max_seconds));
    if (o->alpha > 0)
        json_object_set_new(j, "alpha", json_real(o->alpha));
    else
        json_object_set_new(j, "rho_lambda_max", json_real(n->method->rho));
    json_object_set_new(
        j, "newton", json_string(newton_name[n->local.plain ? NEWTON_PLAIN : NEWTON_LINESEARCH]));
    if (n->local.newton_abs > 0)
        json_object_set_new(j, "newton_abs", json_real(asked->newton_abs));
    else
        json_object_set_new(j, "newton_eps", json_real(n->local.newton_eps));
    json_object_set_new(j, "newton_max", json_integer(n->local.newton_max));
    if (n->relax > 0) json_object_set_new(j, "relax", json_real(n->relax));
    json_object_set_new(j, "order", json_string(order_name[o->order]));
    json_object_set_new(j, "warm", json_boolean(o->small > 0 ? o->small_warm : o->warm));
    if (o->small > 0) json_object_set_new(j, "small_steps", json_real(o->small));
    if (o->small > 0 && o->bound > 0)
        json_object_set_new(j, "missing_impulse", json_real(o->bound));
    char *text = json_dumps(j, JSON_COMPACT);
    json_decref(j);
    return text;
}

/* What a step does about the overlaps of a packing for which nobody has asked for a rule */
static enum overlap overlap_usual(const struct packing *p)
{
    return p->shape ? OVERLAP_GAP_PROJECT : usual.overlap; // corners that open
}

/* Is an option given that chooses how a step is solved? Those that small steps have, too, do not. */
static bool options_solve_once(const struct options *o)
{
    const uint64_t both = bit_of(&options.theta) | bit_of(&options.warm) | bit_of(&options.small) |
                          bit_of(&options.bound);
    return o->given & ~both;
}

double options_small_of(const struct options *o, const struct packing *p)
{
    if (options_has(o, &options.small)) return o->small;
    const bool asks = p->overlap && p->overlap != overlap_usual(p);
    const bool once = asks || packing_has_compliance(p) || options_solve_once(o);
    return once ? 0 : usual.small;
}

bool options_order_alone(const struct options *o, const struct packing *p)
{
    struct options other = *o;
    other.given &= ~bit_of(&options.order);
    return !(options_small_of(o, p) > 0) && options_small_of(&other, p) > 0;
}

enum overlap options_overlap_of(const struct options *o, const struct packing *p, bool detected)
{
    enum overlap now = p->overlap;
    if (!now && !detected) now = overlap_usual(p);
    if (o->protocol) now = paper.overlap;
    return OPTION(overlap, (int)now - 1) + 1;
}

int options_names(const struct options *o, struct failure *failure)
{
    char names[100] = "";
    size_t n = 0;
    if (!o->protocol || o->local) return 0;
    for (int k = 0; methods[k] && n < sizeof names; k++)
        n += (size_t)snprintf(names + n, sizeof names - n, "%s%s", k ? "|" : "", methods[k]->name);
    return failure_set(failure, EX_USAGE, "--protocol paper: needs a local method, -m %s", names);
}
