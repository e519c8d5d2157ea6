/* run/run_total.c: see run_total.h. */
#include "run/run_total.h"

#include "scene/breaking.h"
#include "scene/stiffness.h"
#include "state/breakable.h"
#include "step/small_step.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* What to do about it, but for what is done already */
static const char *cure(enum account_row row, const struct report *r)
{
    if (row == ACCOUNT_OVERLAP && r->small) return "a smaller R of --small-steps leaves less";
    if (row == ACCOUNT_UNCONVERGED && err_no_solution(r))
        return "no solution, reactions grow without end: walls leave bodies no way out";
    if (row == ACCOUNT_UNCONVERGED && r->given_up) return r->given_up;
    return account_watched[row].cure;
}

/* What has gone worse than it may, when it first does. Returns whether the run ends with this step. */
static bool total_account(struct run_total *total, struct frame *f, bool made)
{
    char text[200];
    const struct account before = total->account;
    account_add(&f->account, &f->report);
    unsigned news = account_add(&total->account, &f->report);
    bool ends = made && options_end_on_failure() && account_fails(&total->account);
    for (int k = 0; k < ACCOUNT_ROWS; k++) {
        const enum account_row row = (enum account_row)k;
        bool fails = account_row_fails(&total->account, row) && !account_row_fails(&before, row);
        if (!made || total->silent || (!fails && !(news & 1U << k))) continue;
        account_says(&total->account, row, &f->packing.names, text, sizeof text);
        warn("%s: %s%s", text, cure(row, &f->report),
             !fails ? ""
             : ends ? ": the step fails, and the run ends with it"
                    : ": the step fails, and the run continues");
    }
    if (ends) total->ended = f->report.step;
    return ends;
}

/* The last line of a run: "worst: overlap 1.3e-05 of a radius (step 70, bodies 3 and 8), ..." */
void run_total_say_worst(const struct run_total *total, const struct names *names)
{
    char text[160 * ACCOUNT_ROWS] = "";
    size_t n = 0;
    for (int k = 0; k < ACCOUNT_ROWS && total->account.steps; k++) {
        n += (size_t)snprintf(text + n, sizeof text - n, k ? ", " : "worst: ");
        account_says(&total->account, (enum account_row)k, names, text + n, sizeof text - n);
        n = strlen(text);
    }
    if (total->growing && n < sizeof text)
        snprintf(text + n, sizeof text - n, ", %lld without a solution", (long long)total->growing);
    if (n) warn("%s", text);
}

static void total_count(struct run_total *total, const struct report *r)
{
    char where[40];
    snprintf(where, sizeof where, "step %lld", (long long)r->step);
    bool news = r->given_up && !total->abandoned;
    total->abandoned += r->given_up != NULL;
    if (news) options_warn(where, r); // of all steps, mostly
    total->sweeps += r->sweeps;
    total->safeguarded += r->safeguarded, total->gave_up += r->gave_up;
    total->seconds += r->seconds;
    if (r->substeps > 1) total->divided++, total->substeps += r->substeps;
    if (r->small)
        total->small++, total->small_steps += r->small, total->limited += r->small_limited;
    total->missing_mean = fmax(total->missing_mean, r->missing_mean);
    if (r->missing > total->missing)
        total->missing = r->missing, total->missing_step = r->step,
        total->missing_id = r->missing_id;
    if (r->distance > total->distance)
        total->distance = r->distance, total->distance_step = r->step;
    if (r->converged) return;
    if (!total->missed++) total->first_missed = r->step;
    double error = err_of(&r->err, r->criterion);
    if (!(error <= total->worst)) total->worst = error; // also where it is not a number
    total->criterion = r->criterion, total->eps = r->eps;
    if (!err_no_solution(r)) return;
    total->growing++, total->approach = fmax(total->approach, r->err.max_penetration_true);
}

void run_total_say_steps(const struct run_total *total, int64_t made)
{
    char worst[80] = "";
    if (!(total->worst <= total->eps)) // not only those that have no solution
        snprintf(worst, sizeof worst, "; the largest %s is %.3g, not %g",
                 options_error(total->criterion), total->worst, total->eps);
    warn("%lld steps, %lld sweeps, %.3g s in the solver", (long long)made, (long long)total->sweeps,
         total->seconds);
    if (total->safeguarded || total->gave_up)
        warn("%lld local solves safeguarded, %lld given up", (long long)total->safeguarded,
             (long long)total->gave_up);
    if (total->small)
        warn("%lld steps were made in %lld small ones", (long long)total->small,
             (long long)total->small_steps);
    if (total->missing > 0)
        warn("impulse missing to the laws, over the load: %.2g in all bodies, %.2g at most (step "
             "%lld, body %lld)",
             total->missing_mean, total->missing, (long long)total->missing_step,
             (long long)total->missing_id);
    if (total->distance > 0)
        warn("reactions of kept frames differ from those of converged sweeps by up to %.2g of "
             "these, root mean square "
             "(step %lld)",
             total->distance, (long long)total->distance_step);
    if (total->limited)
        warn("%lld small steps have ended at the limit of their sweeps", (long long)total->limited);
    if (total->radii > 0 && !total->lacks && total->small < made)
        warn(
            "%lld steps were made at once: sweeps of small steps carry reactions too slowly there, "
            "or bodies are too fast for them",
            (long long)(made - total->small));
    if (total->divided)
        warn("%lld steps that were made at once were divided into %lld parts",
             (long long)total->divided, (long long)total->substeps);
    if (total->abandoned)
        warn("%lld steps were given up before their limits", (long long)total->abandoned);
    if (total->missed)
        warn("%lld steps NOT CONVERGED, the first is step %lld%s", (long long)total->missed,
             (long long)total->first_missed, worst);
    if (total->growing)
        warn("%lld of them have no solution: reactions grow without end, and bodies still approach "
             "at "
             "up to %.3g m/s",
             (long long)total->growing, total->approach);
}

static const char *range_text(char *text, size_t size, double least, double most)
{
    if (least < most)
        snprintf(text, size, "%.3g to %.3g", least, most);
    else
        snprintf(text, size, "%.3g", most);
    return text;
}

/* With which stiffness the contacts were solved, where they have one */
static void say_stiffness(const struct run_total *total, const struct packing *p)
{
    struct stiffness of[2];
    const double soft = stiffness_softness(p);
    char range[60];
    stiffness_range(p, of);
    if (of[1].soft > 0)
        warn("stiffness of contacts auto: compliance %s of the W of each",
             range_text(range, sizeof range, of[0].soft, of[1].soft));
    if (of[1].k > 0)
        warn("stiffness of contacts %s N/m, compliance %.2g of W%s",
             range_text(range, sizeof range, of[0].k, of[1].k), soft,
             soft < COMPLIANCE_SOFT && !total->small
                 ? ": too stiff for dt to keep sweeps from growing with the packing"
                 : "");
}

/* What small steps cannot do */
static void say_lacks(struct run_total *total, const struct packing *p, bool distributed)
{
    const char *lacks =
        distributed ? "bodies that no process has all of (--order block)" : small_lacks(p);
    if (!(total->radii > 0) || !lacks || total->lacks) return;
    warn("no small steps with %s yet: such steps are made at once", lacks);
    total->lacks = true;
}

/* Grains that were to break, and have not */
static void count_waiting(struct run_total *total, const struct packing *p)
{
    const int64_t n = breakage_total(p).waiting;
    if (n && !total->waited++)
        warn("step %lld: %lld grains that are due to break wait: %d break in a step, and the table "
             "of "
             "shapes has %d rows",
             (long long)p->step + 1, (long long)n, BREAKING_MOST, SHAPES_MOST);
}

/* What has broken in the document */
static void say_broken(const struct run_total *total, const struct packing *p)
{
    const struct broken b = breakage_total(p);
    if (!p->breakage) return;
    warn("%lld grains have broken into %lld fragments and %.3g kg of dust, which had %.3g J",
         (long long)b.grains, (long long)b.fragments, b.dust, b.kinetic + b.potential);
    if (total->waited)
        warn("in %lld steps grains waited that were due to break, %lld at the end",
             (long long)total->waited, (long long)b.waiting);
}

/* ---- what callers see ---- */

void run_total_begin_step(struct run_total *total, const struct packing *p, bool distributed)
{
    say_lacks(total, p, distributed);
    count_waiting(total, p);
}

bool run_total_add(struct run_total *total, struct frame *f, bool made)
{
    total_count(total, &f->report);
    return total_account(total, f, made);
}

void run_total_say_packing(const struct run_total *total, const struct packing *p)
{
    say_broken(total, p);
    say_stiffness(total, p);
}
