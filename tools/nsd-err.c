/* nsd-err: says how good a solution is, recomputed from the problem and the reactions. */
#include "file/reader.h"
#include "file/report_json.h"
#include "run/cli.h"
#include "solve/err.h"
#include "solve/prepare.h"
#include "step/move.h"

static const struct cli_option *const tables[] = { NULL };

const struct cli_tool tool = {
    "nsd-err", "[FILE ...]",
    "Computes eps_glob and its four terms, the true penetration and the natural-map errors of\n"
    "solutions, from the problem and the reactions alone. Reads documents, writes one line of\n"
    "JSON for each solution.",
    tables,
    "  nsd-err solved.h5 | jq .natural\n  nsd-step --solver auto --contacts -n 10 out.h5 | "
    "nsd-err\n"
};

/* The problem that the reactions of a packing solve, with the reactions in it. */
static int prepare_own(struct problem *p, struct frame *f, struct failure *failure)
{
    if (f->moved && move_back(&f->packing, &f->contacts, failure)) return failure->status;
    if (prepare_packing(p, &f->packing, &f->contacts, &(struct prepare_opt){ .rho_factor = 1 },
                        failure))
        return failure->status;
    f->report.err.max_overlap = contacts_max_overlap(&f->contacts);
    return 0;
}

/* The same of an FCLIB problem, whose velocities are the ones in the document. */
static int prepare_foreign(struct problem *p, struct frame *f, struct failure *failure)
{
    struct delassus *W = &f->problem.W;
    if (problem_prepare_delassus(p, W, &(struct prepare_opt){ .rho_factor = 1 }, failure))
        return failure->status;
    for (int64_t i = 0; i < p->slots; i++) {
        double r[3], u[3];
        if (p->contact[i] < 0) continue;
        slot_get(p, i, r, u);
        for (int k = 0; k < W->d; k++) u[k] = f->u[W->d * p->contact[i] + k];
        slot_set(p, i, r, u);
    }
    return 0;
}

static void print(struct frame *f, struct failure *failure)
{
    if (f->packed && f->moved && contacts_summed(&f->contacts)) {
        json_line(json_pack("{s:I, s:b}", "step", (json_int_t)f->packing.step, "substeps", 1));
        return;
    }
    struct problem p = { 0 };
    f->report.err.max_overlap = 0;
    int64_t step = f->packing.step; // the frame's own, not that of the step before, which is judged
    if ((f->foreign ? prepare_foreign : prepare_own)(&p, f, failure)) return;
    double overlap = f->report.err.max_overlap;
    struct err err;
    err_eval(&err, &p, true, ERR_ALL, 1);
    err.max_overlap = overlap;
    double ratio;
    int e = self_stress(&p, &ratio);
    problem_free(&p);
    if (e) {
        failure_set(failure, EX_SOFTWARE, "out of memory");
        return;
    }
    json_t *line = json_object(), *terms = json_err(&err);
    if (f->packed) json_object_set_new(line, "step", json_integer(step));
    if (f->reported) json_object_set_new(line, "method", json_string(f->report.method));
    json_object_update(line, terms);
    json_object_set_new(line, "self_stress", json_number(ratio));
    json_decref(terms);
    json_line(line);
}

int tool_main(int argc, char **argv)
{
    struct reader *in;
    struct frame f = { 0 };
    struct failure failure = { 0 };
    bool more;
    if (reader_open(&in, argc, argv, &failure)) die_why(&failure);
    begin_stdout();
    while (!reader_next(in, NULL, &f, &more, &failure) && more) {
        const char *where = reader_where(in);
        if (f.foreign && !f.u) die(EX_DATAERR, "%s: no /solution: nsd-solve comes before", where);
        if (f.packed && !f.detected)
            die(EX_DATAERR, "%s: no group /contacts (nsd-step keeps them with --contacts)", where);
        if (f.packed && !f.contacts.found && f.contacts.n)
            die(EX_DATAERR, "%s: the contacts are not solved: nsd-solve comes before", where);
        print(&f, &failure);
        if (failure.status) break;
    }
    if (failure.status) die_why(&failure);
    frame_free(&f);
    reader_close(in);
    finish_stdout();
    return 0;
}
