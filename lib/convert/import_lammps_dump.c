/*
 * convert/import_lammps_dump.c: the text of the dumps of LAMMPS and LIGGGHTS [docs.lammps.org, dump]: frames one after
 * another, each of items: TIMESTEP, NUMBER OF ATOMS, BOX BOUNDS (straight, tilted, or by its edges), ATOMS with the
 * names of its columns; others are read over. UNITS, which a file may have once, before its first frame, names the unit
 * system of all.
 */
#include "convert/imported.h"

#include <string.h>

static const char CURE[] = "dump ... id type x y z vx vy vz omegax omegay omegaz radius mass";

static bool import_lammps_dump_looks(const char *bytes, int64_t n)
{
    (void)n;
    return !strncmp(bytes, "ITEM:", 5);
}

/* A frame's item, by the first word behind ITEM: */
enum import_lammps_dump_item { UNITS, STEP, NUMBER, BOX, ATOMS, OTHER };

static enum import_lammps_dump_item item_of(struct word name)
{
    return word_is(name, "timestep") ? STEP
           : word_is(name, "units")  ? UNITS
           : word_is(name, "number") ? NUMBER
           : word_is(name, "box")    ? BOX
           : word_is(name, "atoms")  ? ATOMS
                                     : OTHER;
}

/* The words behind BOX BOUNDS: xy xz yz, or abc origin, and two letters for each direction, p for periodic */
static int read_ends(struct imported_head *h, struct words *w, bool *tilted, bool *general)
{
    struct word word;
    int k = 0;
    *tilted = *general = h->says = false;
    while (words_next(w, &word)) {
        if (word_is(word, "xy") || word_is(word, "xz") || word_is(word, "yz"))
            *tilted = true;
        else if (word_is(word, "abc"))
            *general = true;
        else if (word.n == 2 && word_has_only(word, "pfsm") && k < 3)
            h->repeats[k++] = word_is(word, "pp"), h->says = true;
    }
    return h->says && k != 3 ? soup_fault(w->soup, "needs three of pp, ff, ss, mm, sm ...") : 0;
}

static int import_lammps_dump_read_box(struct imported_head *h, struct words *w)
{
    bool tilted, general;
    double x[3][4] = { { 0 } };
    struct word word;
    if (read_ends(h, w, &tilted, &general)) return w->soup->failure->status;
    const int width = general ? 4 : tilted ? 3 : 2;
    for (int k = 0; k < 3; k++) {
        if (!words_line(w)) return soup_fault(w->soup, "the box ends before its time (truncated?)");
        for (int j = 0; j < width; j++)
            if (words_number(w, &x[k][j])) return w->soup->failure->status;
        if (words_next(w, &word)) return word_fault(w, word, "is too much for a box");
    }
    h->boxed = true;
    if (general) {
        for (int k = 0; k < 3; k++) h->edge[k] = v3(x[k][0], x[k][1], x[k][2]);
        h->origin = v3(x[0][3], x[1][3], x[2][3]);
    } else {
        // bounds go as far as the tilted box does
        const double xy = x[0][2], xz = x[1][2], yz = x[2][2];
        const double left = fmin(fmin(0, xy + xz), fmin(xy, xz)),
                     right = fmax(fmax(0, xy + xz), fmax(xy, xz));
        h->origin = v3(x[0][0] - left, x[1][0] - fmin(0, yz), x[2][0]);
        h->edge[0] = v3(x[0][1] - right - h->origin.x, 0, 0);
        h->edge[1] = v3(xy, x[1][1] - fmax(0, yz) - h->origin.y, 0);
        h->edge[2] = v3(xz, yz, x[2][1] - h->origin.z);
    }
    double volume = v3_dot(h->edge[0], v3_cross(h->edge[1], h->edge[2]));
    return volume > 0 ? 0 : soup_fault(w->soup, "a box without a volume");
}

static int read_whole(struct words *w, int64_t least, const char *what, int64_t *x)
{
    struct word word;
    if (!words_line(w)) return soup_fault(w->soup, "no %s after it (truncated?)", what);
    if (words_whole(w, x)) return w->soup->failure->status;
    if (*x < least) return soup_fault(w->soup, "no %s", what);
    return words_next(w, &word) ? word_fault(w, word, "is too much") : 0;
}

/* The lines of n atoms, kept or only counted */
static int import_lammps_dump_read_atoms(struct imported *to, struct words *w, int64_t n, bool kept)
{
    struct import_columns c = { 0 };
    struct imported_ball b;
    struct word name;
    while (words_next(w, &name))
        if (import_name_column(&c, w, name)) return w->soup->failure->status;
    if (kept && import_check_columns(&c, w, CURE)) return w->soup->failure->status;
    if (kept && !c.has[IMPORT_X] && !to->head.boxed)
        return soup_fault(w->soup, "places in edges of a box, and no box");
    for (int64_t i = 0; i < n; i++) {
        if (!words_line(w))
            return soup_fault(w->soup, "%lld atoms of %lld (truncated?)", (long long)i,
                              (long long)n);
        if (kept && (import_line(&c, w, &to->head, &b) || imported_add(to, &b, w->soup->failure)))
            return w->soup->failure->status;
    }
    return 0;
}

/* The line behind UNITS */
static int import_lammps_dump_read_units(struct imported *to, struct words *w)
{
    struct word name;
    if (!words_line(w) || !words_next(w, &name))
        return soup_fault(w->soup, "no units after it (truncated?)");
    return import_find_units(&to->units, w, name);
}

/* The next frame. *more: false where there is none. kept: false: it is only gone through. */
static int import_lammps_dump_read_frame(struct imported *to, struct words *w, bool kept,
                                         bool *more)
{
    struct word word, name;
    int64_t n = -1;
    to->head = (struct imported_head){ 0 };
    *more = false;
    do {
        if (!words_next(w, &word)) continue; // an empty line
        if (!word_is(word, "item:") || !words_next(w, &name))
            return word_fault(w, word, "where ITEM: NAME should be");
        enum import_lammps_dump_item item = item_of(name);
        *more = true;
        if (item == ATOMS) {
            if (n < 0) return soup_fault(w->soup, "ATOMS before NUMBER OF ATOMS");
            if (import_lammps_dump_read_atoms(to, w, n, kept)) return w->soup->failure->status;
            words_line(w);
            return 0;
        }
        if (item == STEP && read_whole(w, INT64_MIN, "step", &to->head.step))
            return w->soup->failure->status;
        if (item == NUMBER && read_whole(w, 0, "number of atoms", &n))
            return w->soup->failure->status;
        if (item == BOX && import_lammps_dump_read_box(&to->head, w))
            return w->soup->failure->status;
        if (item == UNITS && import_lammps_dump_read_units(to, w)) return w->soup->failure->status;
        if (item == OTHER && !words_line(w)) break; // TIME: a line
    } while (words_line(w));
    return *more ? soup_fault(w->soup, "the frame ends before its atoms (truncated?)") : 0;
}

static int import_lammps_dump_count_frames(struct words w, int64_t *frames)
{
    struct imported none = { 0 };
    bool more = true;
    for (*frames = 0;; ++*frames)
        if (import_lammps_dump_read_frame(&none, &w, false, &more) || !more)
            return w.soup->failure->status;
}

static int import_lammps_dump_read(struct imported *to, struct words *w, int64_t k)
{
    int64_t frames = 0;
    bool more = true;
    if (import_lammps_dump_count_frames(*w, &frames)) return w->soup->failure->status;
    int64_t wanted = k < 0 ? frames + k : k;
    w->soup->at = 1; // the lines are counted again
    if (wanted < 0 || wanted >= frames) {
        w->soup->unit = NULL;
        return soup_fault(w->soup, "no frame %lld: there are %lld", (long long)k,
                          (long long)frames);
    }
    for (int64_t f = 0; f <= wanted; f++)
        if (import_lammps_dump_read_frame(to, w, f == wanted, &more))
            return w->soup->failure->status;
    import_to_si(to);
    return 0;
}

const struct import_format import_lammps_dump = { "a LAMMPS dump", import_lammps_dump_looks,
                                                  import_lammps_dump_read };
