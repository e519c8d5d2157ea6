/* nsd-move: makes the second half of a step: moves the bodies by the reactions. */
#include "run/cli.h"
#include "run/tool_filter.h"
#include "state/rotation.h"
#include "step/move.h"
#include "step/step.h"
#include "step/sum_step.h"

static const struct cli_option *const tables[] = { NULL };

const struct cli_tool tool = {
    "nsd-move", "[FILE ...]",
    "Moves the bodies by the reactions: velocities, then positions. One step is\n"
    "nsd-detect | nsd-solve | nsd-move. Reads solved contacts, writes packings.",
    tables, "  nsd-detect packing.h5 | nsd-solve | nsd-move > next.h5\n"
};

static void move(struct frame *f, const char *where)
{
    struct failure failure = { 0 };
    tool_wants_solution(f, where);
    struct impulses sum = { 0 };
    if (f->packing.sums.n && !impulses_init(&sum, &f->packing, &f->contacts, false, &failure))
        sum_step(&f->packing, &f->contacts, &sum, &failure);
    impulses_free(&sum);
    struct projected did = { 0 };
    f->report.balance.peculiar_change = -energy_peculiar(&f->packing, NULL);
    if (failure.status || move_step(&f->packing, &f->contacts, &did, &failure)) die_why(&failure);
    did.peculiar = energy_peculiar(&f->packing, NULL);
    if (f->reported) step_report_moved(&f->report, &f->packing, &did);
    f->detected = false, f->stale = true;
}

int tool_main(int argc, char **argv)
{
    tool_filter(argc, argv, move);
    return 0;
}
