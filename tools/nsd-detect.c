/* nsd-detect: finds the contacts of packings. */
#include "contact/detect.h"
#include "contact/touching.h"
#include "run/cli.h"
#include "run/options.h"
#include "run/tool_filter.h"
#include "scene/inlet.h"
#include "state/placement.h"

#include <stdlib.h>

/* The two forms of a problem in FCLIB */
enum form { FORM_LOCAL, FORM_GLOBAL, FORM_COUNT };
static const char *const form_name[FORM_COUNT] = { "local", "global" };

static struct cli_choice form_choice(int k)
{
    return (struct cli_choice){ k < FORM_COUNT ? form_name[k] : NULL, NULL };
}

static int form;

static struct problem problem; /* of the frame in hand */

static const struct cli_option own[] = {
    { CLI_CHOICE, 0, "fclib", &form, .choice = form_choice,
      .help = "also write the contact problem in the FCLIB format" },
    { 0 },
};
static const struct cli_option *const tables[] = { options_detect, options_contacts, own, NULL };

const struct cli_tool tool = {
    "nsd-detect", "[FILE ...]",
    "Finds the contacts in the predicted position q + dt/2 qdot, with bases and gaps.\n"
    "Reads packings (every frame of a trajectory), writes each with its contacts.",
    tables,
    "  nsd-gen 500 | nsd-step -n 900 --every 900 | nsd-cat --last | nsd-detect > contacts.h5\n"
    "  nsd-detect --fclib=local < packing.h5 > problem.h5\n"
};

/* The contact problem, which the writer then adds in the FCLIB format; that of the frame before is freed. */
static void add_problem(struct frame *f)
{
    struct failure failure = { 0 };
    problem_free(&problem);
    if (problem_prepare(&problem, &f->packing, &f->contacts,
                        &(struct prepare_opt){ .rho_factor = 1 }, &failure))
        die_why(&failure);
    if (problem.kind.rolls) die(EX_DATAERR, "rolling friction has no place in an FCLIB problem");
    f->export = &problem, f->write_export = fclib_write_problem;
    f->export_global = form == FORM_GLOBAL;
}

/* The step begins: bodies come and go. */
static void flow(struct packing *p)
{
    struct flow scene;
    struct failure failure = { 0 };
    bool changed;
    p->events.n = 0;
    external_force_forget(&p->outside);
    if (flow_read(&scene, p, &failure) || flow_step(&scene, p, NULL, &changed, &failure))
        die_why(&failure);
    flow_free(&scene);
}

static void detect(struct frame *f, const char *where)
{
    struct failure failure = { 0 };
    tool_wants_packing(f, where);
    options_theta(&f->packing, false);
    options_overlap(&f->packing, false);
    options_stiffness(f, NULL);
    flow(&f->packing);
    struct packing *p = &f->packing;
    if (external_force_begin(&p->outside, p->mass, p->n, p->walls, &failure)) die_why(&failure);
    packing_wrap(&f->packing, NULL);
    if (touching_bond(&f->packing, &failure)) die_why(&failure);
    if (detect_contacts(&f->contacts, &f->packing, options.gap, NULL, &failure)) die_why(&failure);
    f->detected = true, f->reported = f->moved = false;
    f->stale = true;
    if (cli_given(&form)) add_problem(f);
}

int tool_main(int argc, char **argv)
{
    tool_filter(argc, argv, detect);
    problem_free(&problem);
    return 0;
}
