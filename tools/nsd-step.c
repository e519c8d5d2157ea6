/* nsd-step: makes many steps: detects, solves and moves in a loop. */
#include "file/background_writer.h"
#include "file/reader.h"
#include "file/writer.h"
#include "run/cli.h"
#include "run/driver.h"
#include "run/loop.h"
#include "run/options.h"
#include "run/processes.h"
#include "run/run_total.h"
#include "run/tool_filter.h"
#include "scene/inlet.h"
#include "step/small_step.h"

#include <float.h>
#include <malloc.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum {
    KEEP_BLOCK = 1 << 25, /* bytes of a block of memory that is kept, at most: no more can be had */
    KEEP_MEMORY = 1 << 28 /* bytes that are kept */
};

static int64_t steps = 1; /* to make */
static struct cli_every every = { 1, 0 };
static double until;             /* s of the motion */
static double lines, save_every; /* s of real time */
static bool contacts, forces, sums, in_place;
static const char *output;

static const struct cli_option own[] = {
    { CLI_INT, 'n', "steps", &steps, "N", "make N steps [1]", .max = 1e15 },
    { CLI_TIME, 0, "until", &until, "T", "make steps until the time is T: 2 or 2s, 5ms [by -n]",
      .min = -1e300, .max = 1e300 },
    { CLI_TEXT, 0, "dt", &options.dt, "DT",
      .help = "set dt, 1e-4 or 0.1ms: one solve per step [document's, small steps]" },
    { CLI_REAL, 0, "small-steps", &options.small, "R", .min = 0, .max = 0.1,
      .help = "make small steps of R radii; 0: one solve", .usual = options_usual },
    { CLI_REAL, 0, "missing-impulse", &options.bound, "B", .min = 0, .max = 1,
      .help = "sweep until at most a part B of the impulses is missing [none]" },
    { CLI_EVERY, 0, "every", &every, "K|T",
      "keep every K-th step, or one per time T: 0.1s, 5ms, and the last [1]", .max = 1e15 },
    { CLI_FLAG, 0, "contacts", &contacts, .help = "also keep the contacts of each frame" },
    { CLI_FLAG, 0, "forces", &forces,
      .help = "also keep their forces as vectors in N; implies --contacts" },
    { CLI_FLAG, 0, "wall-loads", &sums,
      .help = "sum forces and work on walls over steps: nsd-stat -m wall_loads" },
    { CLI_FLAG, 'w', "warm", &options.warm,
      .help = "start each solve from the reactions of the last step" },
    { CLI_UNFLAG, 0, "cold", &options.warm,
      .help = "start each solve from reactions 0, as in the paper", .usual = options_usual },
    { CLI_FLAG, 'i', "in-place", &in_place, .silent = true,
      .help = "append to FILE; default if standard output is a terminal" },
    { CLI_TIME, 0, "progress", &lines, "T", .max = 1e9, .silent = true,
      .help = "report every T of real time: 30 or 30s, 10min [only on a terminal]" },
    { CLI_FLAG, 'k', "keep-going", &options.keep_going, .silent = true,
      .help = "under -e, make all steps, also after one that fails" },
    { CLI_TIME, 0, "save", &save_every, "T", .max = 1e9, .silent = true,
      .help = "checkpoint to OUTPUT.save every T of real time: 90s, 10min [never]" },
    { CLI_TEXT, 'o', "output", &output, "FILE", "write to FILE [standard output]", .silent = true },
    { 0 },
};
static const struct cli_option *const tables[] = {
    own, options_solve, options_detect, options_contacts, options_run, options_loop, NULL
};

const struct cli_tool tool = {
    "nsd-step", "[FILE ...]",
    "Makes N time steps from the last frame that it reads. To a file: "
    "one trajectory, each frame on\n"
    "disk as soon as it is made; to a pipe: one document per frame.",
    tables,
    "  nsd-gen 500 | nsd-step -n 1000 > out.h5\n"
    "  nsd-step -n 100 -o more.h5 out.h5\n"
    "  nsd-step -n 100 --in-place out.h5\n"
    "  nsd-step -n 20 --with 'jq -c --unbuffered {gravity:[1,0,-9.81]}' a.h5 > leaning.h5\n"
};

static struct run_total total;

/* Would words get between the frames? */
static bool words_are_output(void)
{
    struct stat out, err;
    return !output && !in_place && !fstat(STDOUT_FILENO, &out) && !fstat(STDERR_FILENO, &err) &&
           S_ISREG(out.st_mode) && out.st_dev == err.st_dev && out.st_ino == err.st_ino;
}

/* ---- how far it is ---- */

static double seconds_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* s: over which the speed of a run is taken, once or twice: piles grow, and with them the time of a step */
static const double RECENT = 15;

/* Steps made up to a moment of real time */
struct mark {
    double at;
    int64_t made;
};

/* Steps a second, lately */
static double speed(int64_t made)
{
    static struct mark older, newer;
    double now = seconds_now();
    if (newer.at == 0) older = newer = (struct mark){ now, made - 1 };
    if (now - newer.at > RECENT) older = newer, newer = (struct mark){ now, made };
    return (double)(made - older.made) / fmax(now - older.at, 1e-9);
}

/* MB: that the process has in memory now */
static double memory_now(void)
{
    unsigned long long all = 0, here = 0;
    FILE *f = fopen("/proc/self/statm", "r");
    if (f && fscanf(f, "%llu %llu", &all, &here) != 2) here = 0;
    if (f) fclose(f);
    return 1e-6 * (double)here * (double)sysconf(_SC_PAGESIZE);
}

/* "step 120, 12 % of 1000, 35/s, 0:25 left: 812 contacts, 40 sweeps, natural 9e-05, 25 MB of memory, 3.1 MB written" */
static void tell(const struct report *r, int64_t made, const struct writer *out)
{
    double rate = speed(made);
    if (!progress_due()) return;
    double left = (double)(steps - made) / rate, hours = floor(left / 3600);
    double minutes = floor(left / 60) - 60 * hours;
    char clock[40];
    if (hours >= 1)
        snprintf(clock, sizeof clock, "%.0f:%02.0f h", hours, minutes);
    else
        snprintf(clock, sizeof clock, "%.0f:%02.0f", minutes, floor(left - 60 * minutes));
    progress_now("step %lld, %.0f %% of %lld, %.3g/s, %s left: %lld contacts, %d sweeps, %s %.2g, "
                 "%.3g MB of memory, %.3g MB written",
                 (long long)r->step, floor(100.0 * (double)made / (double)steps), (long long)steps,
                 rate, clock, (long long)r->err.contacts, r->sweeps, options_error(r->criterion),
                 err_of(&r->err, r->criterion), memory_now(), 1e-6 * (double)writer_size(out));
}

/* ---- the end that comes from outside ---- */

static volatile sig_atomic_t stopped_by; /* the signal, or 0 */

static void stop(int number)
{
    stopped_by = number;
    signal(number, SIG_DFL); // the next one does not wait for a step
}

/* Where mpirun has started several, it stops them by SIGTERM also when one has died, and no step can be made. */
static void take_signals(void)
{
    static const int signals[] = { SIGINT, SIGTERM, SIGHUP };
    struct sigaction act = { .sa_handler = stop, .sa_flags = SA_RESTART }, was;
    for (int k = 0; k < 3 && !processes_started(); k++)
        if (!sigaction(signals[k], NULL, &was) && was.sa_handler != SIG_IGN)
            sigaction(signals[k], &act, NULL);
}

/* ---- the run ---- */

/* A run from frame f on */
struct run {
    struct frame f;
    struct writer *out;
    struct background_writer *background; /* NULL: one thread makes the steps, and writes */
    struct driver driver;
    bool fails;           /* the run ends with the step that was made */
    char end[200];        /* why the next step was not made, or "" */
    struct failure ended; /* why that program has ended the run; status 0: it said so, or has not */
    bool told_to_stop;
    double saved;    /* s of real time: when the state was saved last */
    char *save_path; /* where; NULL: nowhere */
};

/* ---- checkpoints ---- */

static void save_begin(struct run *r, const char *path)
{
    if (!(save_every > 0)) return;
    if (!path) die_usage("--save requires -o FILE or -i");
    size_t room = strlen(path) + sizeof ".save";
    if (!(r->save_path = malloc(room))) die(EX_SOFTWARE, "no memory");
    snprintf(r->save_path, room, "%s.save", path);
    r->saved = seconds_now();
}

static bool save_due(const struct run *r)
{
    return r->save_path && seconds_now() - r->saved >= save_every;
}

/* The frame with the forces that last, borrowed: those of a document. What a program answers is kept as it said it. */
static struct frame with_forces(struct run *r)
{
    struct failure failure = { 0 };
    struct frame f = r->f;
    if (loop_asks() || !steps) return f;
    if (r->driver.acts.id && control_arrays(&r->driver.acts, &r->f.packing, &failure))
        die_why(&failure);
    f.packing.outside.lasts = control_lend(&r->driver.acts, f.packing.walls);
    return f;
}

/* The state as a document of its own, which takes the place of the one before in one stroke */
static void save_state(struct run *r)
{
    struct failure failure = { 0 };
    struct writer *out;
    struct frame f = with_forces(r);
    f.detected = f.detected || options.warm; // a warm step begins with these
    bool background = r->background;
    if (background_close(r->background, &failure))
        die_why(&failure); // libhdf5 has one user at a time
    r->background = NULL;
    if (writer_open(&out, r->save_path, WRITER_COPY, &failure) || writer_frame(out, &f, &failure) ||
        writer_close(out, &failure))
        die_why(&failure);
    if (background) background_open(&r->background, r->out, &(struct failure){ 0 });
    r->saved = seconds_now();
}

static void save_end(struct run *r)
{
    if (r->save_path) unlink(r->save_path); // what the output has, too
    free(r->save_path);
}

/* ---- steps ---- */

/* Is the frame after a step, the k-th of this run, one to keep? By seconds: the first at or after each
   multiple of them, wherever the run began. */
static bool is_kept(const struct packing *p, int64_t step, int64_t k)
{
    if (every.steps) return k % every.steps == 0;
    double now = packing_time(p, step), before = packing_time(p, step - 1);
    return floor((now + driver_slack(p, now)) / every.seconds) >
           floor((before + driver_slack(p, before)) / every.seconds);
}

/* The step to come begins. */
static void begin_step(struct run *r)
{
    struct failure failure = { 0 };
    struct packing *p = &r->f.packing;
    if (driver_begin(&r->driver, p, &r->f.contacts, &failure)) die_why(&failure);
    run_total_begin_step(&total, p, r->f.distributed);
}

/* Is the balance of the step read? Where each process has its own bodies it takes an exchange, and only kept frames have it. */
static bool is_bare(const struct run *r, int64_t k, bool last)
{
    const struct packing *p = &r->f.packing;
    const bool gathers = processes_size() > 1 && r->driver.o.order == ORDER_BLOCK;
    if (loop_asks() || options.log || last || (options_end_on_failure() && !gathers)) return false;
    return !is_kept(p, p->step + 1, k);
}

/* Makes one step, the k-th; false where it cannot be made, and the bodies have not moved. */
static bool advance(struct run *r, int64_t k, bool saves)
{
    struct failure failure = { 0 };
    struct frame *f = &r->f;
    struct report *rep = &f->report;
    begin_step(r);
    const struct packing *p = &f->packing;
    bool last = k == steps;
    r->driver.o.bare = !saves && is_bare(r, k, last);
    r->driver.o.compare = (contacts || forces) && !r->driver.o.bare && is_kept(p, p->step + 1, k);
    const struct changes changes = { r->driver.other_bodies,
                                     loop_asks() || control_any(&r->driver.acts) };
    if (processes_step(f, &r->driver.memory, changes, &r->driver.o, &failure)) die_why(&failure);
    f->reported = f->moved = true;
    const bool good = report_made(rep);
    r->fails = run_total_add(&total, f, good);
    if (!good) report_says_end(rep, r->end, sizeof r->end);
    options_log(rep, last || !good || r->fails ? &total.account : NULL, &p->names);
    char where[40];
    snprintf(where, sizeof where, "step %lld", (long long)rep->step);
    options_warn_cpu(where, rep);
    return good;
}

static void write_frame(struct run *r)
{
    struct failure failure = { 0 };
    const struct frame f = with_forces(r);
    if ((r->background ? background_frame(r->background, &f, &failure)
                       : writer_frame(r->out, &f, &failure)))
        die_why(&failure);
    r->f.packing.events.n = r->f.packing.outside.length = 0; // they are written
}

/* Writes the last step that could be made, the k-th, without its contacts, unless it is written. */
static void keep_last(struct run *r, int64_t k)
{
    if (k && is_kept(&r->f.packing, r->f.packing.step, k)) return;
    r->f.reported = r->f.detected = false;
    write_frame(r);
}

/* The program in the loop has ended the run after k steps: the last one is kept, or what there was. */
static void keep_stopped(struct run *r, int64_t k)
{
    if (k ? !is_kept(&r->f.packing, r->f.packing.step, k) : !in_place) write_frame(r);
    steps = k ? k : 1; // and not written again
}

/* Where processes exchange velocities for longer than they sweep, fewer are faster. */
static void warn_processes(const struct frame *f, const struct step_opt *o)
{
    const bool breaks = f->packing.breakage != NULL;
    const enum order order = o->order;
    // bodies of a process that pay for its exchanges, measured with 2 and 4 [docs/scale]: colour has one for each colour
    const bool small = o->small > 0 && !f->distributed && !small_lacks(&f->packing);
    const double least = small ? 10000 : order == ORDER_BLOCK ? 2000 : 20000;
    const char *whole = small ? small_undivided(&f->packing, o->bound) : NULL;
    const double n = f->distributed ? (double)f->distributed->n : (double)f->packing.n;
    const int size = processes_size(), most = (int)fmax(1, fmin(n / least, size));
    if (size > 1 && steps && breaks) {
        warn("%d processes: the first makes all steps of grains that break, and the others wait: "
             "use threads, nsd-step -j %d",
             size, size);
        return;
    }
    if (size > 1 && steps && whole) {
        warn("%d processes: the first makes all small steps, and the others wait, because of %s: "
             "use threads, nsd-step -j %d, or --small-steps 0",
             size, whole, size);
        return;
    }
    if (size <= most || !steps) return;
    if (most == 1)
        warn(
            "%d processes for %.0f bodies are slower than one, and use more CPU: below %.0f bodies "
            "per process use threads, nsd-step -j %d",
            size, n, least, size);
    else
        warn("%d processes for %.0f bodies are slower than fewer: use %.0f bodies per process or "
             "more, "
             "mpirun -n %d",
             size, n, least, most);
}

static void begin(struct run *r)
{
    struct failure failure = { 0 };
    struct frame *f = &r->f;
    r->driver.o = options_step(f->packing.dt, false);
    total.silent = words_are_output();
    total.radii = options_small_of(&options, &f->packing);
    if (options_order_alone(&options, &f->packing))
        warn("one solve per step, as --order asks for: small steps have an order of their own");
    if (!f->distributed) r->driver.o.small = total.radii;
    warn_processes(f, &r->driver.o);
    if (flow_read(&r->driver.flow, &f->packing, &failure)) die_why(&failure);
    if (!steps) return;
    f->packing.events.n = 0; // they belong to the frame that was read
    if (f->packing.outside.length && !loop_asks())
        warn("a program (--with) acted on the run so far, and nothing acts on it now: --with or "
             "--replay");
    if (control_take(&r->driver.acts, &f->packing, &failure)) die_why(&failure);
    external_force_forget(&f->packing.outside);
    report_free(&f->report);
    f->report.options = options_json(&r->driver.o);
    f->detected = contacts || forces;
    f->forces = forces;
    f->stale = true;
}

/* Makes the steps, writes those to keep and the last, and returns how many were made. */
static int64_t run(struct run *r)
{
    int64_t made = 0;
    bool good = true;
    struct failure failure = { 0 };
    begin(r);
    // where there is no other thread, this one writes; and with others, who have the bodies
    // and beside a program in the loop, which may want documents
    if (options.threads > 1 && steps && !r->f.distributed && !loop_asks())
        background_open(&r->background, r->out, &(struct failure){ 0 });
    bool ends = !steps;
    while (!ends) {
        if (stopped_by) steps = made + 1; // the next one is the last, and its frame is kept
        if (loop_asks() && !loop_before_step(&r->f, &r->driver.acts, !made, &r->ended)) {
            r->told_to_stop = true;
            break;
        }
        bool saves = save_due(r);
        if (!(good = advance(r, made + 1, saves))) break;
        const struct packing *p = &r->f.packing;
        ends = ++made == steps || r->fails;
        tell(&r->f.report, made, r->out);
        if (ends && r->driver.o.bare)
            keep_last(r, made);
        else if (is_kept(p, p->step, made) || ends)
            write_frame(r);
        if (saves) save_state(r);
    }
    if (ends) steps = made;
    if (r->told_to_stop) keep_stopped(r, made);
    if (!good) keep_last(r, made);
    if (!steps && !in_place) write_frame(r);
    driver_free(&r->driver);
    if (background_close(r->background, &failure)) die_why(&failure);
    return made;
}

/* How many steps --until needs, of a packing at this time: up to the first whose time reaches it, which
   depends on where the time is counted from and not on where this run began */
static void count_steps(const struct packing *p)
{
    if (!cli_given(&until)) return;
    double n = ceil((until - p->t) / p->dt), reached = until - driver_slack(p, until);
    if (n > 1e15) die_usage("--until %g: more than 1e15 steps of %g s", until, p->dt);
    steps = n > 0 ? (int64_t)n : 0; // but for rounding
    while (steps && packing_time(p, p->step + steps - 1) >= reached) steps--;
    while (packing_time(p, p->step + steps) < reached &&
           !packing_check_clock(p, &(struct failure){ 0 }))
        steps++;
}

/* ---- from where, and where to ---- */

static double read_dt(void)
{
    struct failure failure = { 0 };
    double x;
    if (!options.dt) return 0;
    if (driver_read_dt(options.dt, &x, &failure)) die_usage("--dt: %s", failure.text);
    return x;
}

/* Sets the time step of --dt; path: of a trajectory that the run is appended to, else NULL. */
static void set_dt(struct packing *p, double asked, const char *path)
{
    struct failure failure = { 0 };
    if (!(asked > 0)) return;
    if (path && asked != p->dt)
        die_usage("--dt: %s has %g s, and a trajectory has one: use -o FILE for another", path,
                  p->dt);
    if (driver_set_dt(p, asked, &failure)) die_why(&failure);
}

/* The frames of the file go into the one that takes its place, the last one stays in f. */
static void copy_all(struct reader *in, struct writer *out, struct frame *f)
{
    struct frame next = { 0 };
    struct failure failure = { 0 };
    bool more;
    int64_t frames = 0;
    while (!reader_next(in, NULL, &next, &more, &failure) && more) {
        tool_wants_packing(&next, reader_where(in));
        const char *lost = reader_loses(in);
        if (lost)
            die(EX_DATAERR,
                "%s: %s is not known, and depends on time: use -o FILE to continue without it",
                reader_where(in), lost);
        if (!frames++ && frame_note(&next, cli_history(), &failure)) break;
        if (writer_frame(out, &next, &failure))
            die(failure.status, "%s: %s", reader_where(in), failure.text);
        frame_free(f);
        *f = next, next = (struct frame){ 0 };
        progress("%lld frames copied", (long long)frames);
    }
    if (failure.status) die_why(&failure);
    if (!frames) die(EX_DATAERR, "%s: no frame to start from", reader_where(in));
}

static void start_in_place(struct run *r, struct reader *in, const char *path, double asked)
{
    struct failure failure = { 0 };
    if (writer_open(&r->out, path, WRITER_IN_PLACE, &failure)) die_why(&failure);
    copy_all(in, r->out, &r->f);
    double theta = r->f.packing.theta;
    set_dt(&r->f.packing, asked, path);
    options_theta(&r->f.packing, false);
    options_overlap(&r->f.packing, false);
    options_stiffness(&r->f, path);
    if (theta != r->f.packing.theta)
        die_usage("--theta: %s has %g, and a trajectory has one", path, theta);
    if (writer_take_place(r->out, &failure)) die_why(&failure);
}

static void start(struct run *r, struct reader *in, double asked)
{
    struct failure failure = { 0 };
    bool more;
    if (reader_last(in, &r->f, &more, &failure)) die_why(&failure);
    if (!more) die(EX_DATAERR, "%s: no frame to start from", reader_where(in));
    tool_wants_packing(&r->f, reader_where(in));
    set_dt(&r->f.packing, asked, NULL);
    options_theta(&r->f.packing, false);
    options_overlap(&r->f.packing, false);
    options_stiffness(&r->f, NULL);
    if (writer_open(&r->out, output, WRITER_TRAJECTORY, &failure)) die_why(&failure);
    if (frame_note(&r->f, cli_history(), &failure)) die_why(&failure);
}

/* Memory of a step is kept for the next, and not given back and asked for page by page each time. */
static void keep_memory(void)
{
#ifdef M_MMAP_THRESHOLD
    mallopt(M_MMAP_THRESHOLD, KEEP_BLOCK), mallopt(M_TRIM_THRESHOLD, KEEP_MEMORY);
#endif
}

int tool_main(int argc, char **argv)
{
    struct reader *in;
    struct run r = { 0 };
    struct failure failure = { 0 };
    bool file = argc == 1 && strcmp(argv[0], "-") != 0;
    options_check();
    loop_check();
    keep_memory();
    if (!processes_join()) return processes_follow();
    double asked = read_dt();
    if (options.device && processes_started())
        die_usage("--device: needs a single process, without mpirun");
    if (options.keep_going && !options.strict) die_usage("--keep-going: needs -e");
    if (cli_given(&until) && cli_given(&steps)) die_usage("-n and --until exclude each other");
    if (in_place && output) die_usage("-i and -o exclude each other");
    if (in_place && !file) die_usage("-i: one FILE, to which it appends");
    if (file && !output && isatty(STDOUT_FILENO) && !processes_started()) in_place = true;
    if (processes_started() && !output && !in_place)
        die_usage("under mpirun the output goes to a file: -o FILE, or -i");
    progress_lines(lines);
    if (reader_open(&in, argc, argv, &failure)) die_why(&failure);
    reader_copies(in);
    // a program in the loop needs all bodies, and their contacts, in one place; --dt auto and springs all bodies
    struct distributed *others = processes_take_bodies(contacts || forces || sums || loop_asks());
    const bool whole = loop_asks() || options_adds_springs();
    reader_hands_over(in, whole ? NULL : others);
    if (output && reader_reads(argc, argv, output))
        die_usage("%s: is also the input; -i appends to it", output);
    if (in_place)
        start_in_place(&r, in, argv[0], asked);
    else
        start(&r, in, asked);
    if (sums && !r.f.packing.sums.n) {
        if (in_place)
            die_usage("--wall-loads: %s keeps none, and a trajectory has them from its first "
                      "frame: -o FILE",
                      argv[0]);
        if (sums_begin(&r.f.packing.sums, r.f.packing.walls, r.f.packing.wall, r.f.packing.t,
                       &failure))
            die_why(&failure);
    }
    count_steps(&r.f.packing);
    loop_choose_walls(&r.f.packing);
    if (steps && !in_place && writer_begin(r.out, &r.f, &failure)) die_why(&failure);
    options_log_open(argc, argv, output);
    save_begin(&r, in_place ? argv[0] : output);
    if (r.save_path && reader_reads(argc, argv, r.save_path))
        die_usage("--save: %s is also the input", r.save_path);
    if (loop_asks()) loop_open(&r.f.packing, &stopped_by);
    take_signals();
    const int64_t wanted = steps;
    const int64_t made = run(&r);
    if (writer_close(r.out, &failure)) die_why(&failure);
    save_end(&r);
    options_log_close();
    if (loop_asks()) loop_close(&r.ended);
    const char *told = processes_leave();
    run_total_say_steps(&total, made);
    run_total_say_packing(&total, &r.f.packing);
    options_leave_device();
    if (told) warn("%s", told);
    run_total_say_worst(&total, &r.f.packing.names);
    reader_close(in);
    if (r.ended.status) die_why(&r.ended);
    bool stopped = stopped_by && made < wanted;
    if (r.told_to_stop && !stopped)
        warn("stopped by the program after step %lld", (long long)r.f.packing.step);
    if (stopped)
        warn("stopped by signal %d after step %lld, which is kept", (int)stopped_by,
             (long long)r.f.packing.step);
    if (total.ended && made < wanted)
        warn("step %lld, which is kept, fails and ends the run: --keep-going makes all steps",
             (long long)total.ended);
    if (*r.end) warn("%s: the run ends before it", r.end);
    frame_free(&r.f);
    if (stopped) return 128 + stopped_by;
    return *r.end || total.growing || (options.strict && account_fails(&total.account));
}
