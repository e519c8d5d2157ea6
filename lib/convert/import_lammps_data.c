/*
 * convert/import_lammps_data.c: data files of LAMMPS and LIGGGHTS [docs.lammps.org, read_data]: a first line of anything, a
 * head of numbers before their names, and sections. Read are the box, Atoms of style sphere (LIGGGHTS: granular)
 * and Velocities. Which edges are periodic is not in the file.
 */
#include "convert/imported.h"

#include <stdlib.h>
#include <string.h>

static const char *const sections[] = {
    "atoms",  "velocities", "masses",    "ellipsoids", "lines", "triangles", "bodies",   "bonds",
    "angles", "dihedrals",  "impropers", "atom",       "bond",  "angle",     "dihedral", "improper",
    "pair",   "pairij",     "bondbond",  "bondangle",  "types", NULL
};

/* The number of atoms is in one of the first lines of the head. */
static bool import_lammps_data_looks(const char *bytes, int64_t n)
{
    const char *at = bytes, *end = bytes + (n < 4096 ? n : 4096);
    for (int line = 0; line < 12 && at < end; line++) {
        const char *stop = memchr(at, '\n', (size_t)(end - at));
        const char *s = at;
        at = stop ? stop + 1 : end;
        if (!line) continue;
        s += strspn(s, " \t");
        size_t digits = strspn(s, "0123456789");
        if (!digits) continue;
        s += digits + strspn(s + digits, " \t");
        if (s < at && !strncmp(s, "atoms", 5) && strspn(s + 5, " \t\r\n#")) return true;
    }
    return false;
}

/* A ball, by its id */
struct ref {
    int32_t id;
    struct imported_ball *ball;
};

struct data {
    struct imported *to;
    struct words *w;
    int64_t atoms;
    double lo[3], hi[3], tilt[3];
    bool has[3];
    bool read;          /* the section Atoms */
    bool masses;        /* there is a section Masses, which spheres have not */
    struct ref *sorted; /* [atoms] by id, for Velocities */
};

static bool is_section(struct word word)
{
    for (const char *const *s = sections; *s; s++)
        if (word_is(word, *s)) return word.s[0] >= 'A' && word.s[0] <= 'Z';
    return false;
}

static bool is_equals(struct word word)
{
    return word_is(word, "=") || word_is(word, ":");
}

/* "units = cgs", which write_data has in the title, "# units: cgs", "units cgs" */
static int import_lammps_data_read_units(struct data *d)
{
    struct words w = *d->w;
    struct word word;
    w.comments = false;
    while (words_next(&w, &word)) {
        struct word rest = { word.s + 5, word.n - 5 }, first = { word.s, 5 };
        if (rest.n < 0 || !word_is(first, "units")) continue;
        const struct word sign = { rest.s, rest.n ? 1 : 0 };
        bool said = is_equals(sign);
        if (rest.n && !said) continue; // unitsystem
        if (said) rest.s++, rest.n--;
        if (!rest.n && words_next(&w, &rest) && is_equals(rest)) said = words_next(&w, &rest);
        if (said || import_are_units(rest)) return import_find_units(&d->to->units, &w, rest);
    }
    return 0;
}

/* What other atom styles have, and spheres have not */
static const char *const foreign[] = { "ellipsoids", "lines",     "triangles", "bodies", "bonds",
                                       "angles",     "dihedrals", "impropers", NULL };

static bool is_foreign(struct word word)
{
    for (const char *const *s = foreign; *s; s++)
        if (word_is(word, *s)) return true;
    return false;
}

/* "0 1 xlo xhi", "0 0 0 xy xz yz", "12 atoms"; what else there is does not matter */
static int read_head_line(struct data *d, struct word first)
{
    struct words *w = d->w;
    double x[3] = { 0 };
    struct word word = first;
    int n = 0;
    do {
        const char c = word.s[0];
        bool number = (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.';
        if (!number) break;
        if (n == 3) return word_fault(w, word, "is too much for a line of the head");
        if (word_number(w, word, &x[n++])) return w->soup->failure->status;
    } while (words_next(w, &word));
    if (n == 1 && word_is(word, "atoms")) {
        if (!(x[0] >= 0 && x[0] <= IMPORTED_MOST && x[0] == (double)(int64_t)x[0]))
            return word_fault(w, first, "is no number of atoms");
        d->atoms = (int64_t)x[0];
    }
    if (n == 1 && x[0] > 0 && is_foreign(word))
        return word_fault(w, word, "are not of atom_style sphere, of which balls are read");
    for (int k = 0; n == 2 && k < 3; k++) {
        const char lo[] = { "xyz"[k], 'l', 'o', 0 };
        if (!word_is(word, lo)) continue;
        if (!(x[0] < x[1])) return soup_fault(w->soup, "a box without a volume");
        d->lo[k] = x[0], d->hi[k] = x[1], d->has[k] = true;
    }
    if (n == 3 && word_is(word, "xy")) memcpy(d->tilt, x, sizeof x);
    return 0;
}

static void import_lammps_data_set_box(struct data *d)
{
    struct imported_head *h = &d->to->head;
    if (!(d->has[0] && d->has[1] && d->has[2])) return;
    h->boxed = true, h->says = false;
    h->origin = v3(d->lo[0], d->lo[1], d->lo[2]);
    h->edge[0] = v3(d->hi[0] - d->lo[0], 0, 0);
    h->edge[1] = v3(d->tilt[0], d->hi[1] - d->lo[1], 0);
    h->edge[2] = v3(d->tilt[1], d->tilt[2], d->hi[2] - d->lo[2]);
}

/* Goes to the next line that has words; *word: the first */
static int import_lammps_data_next_line(struct data *d, int64_t i, const char *what,
                                        struct word *word)
{
    do
        if (!words_line(d->w))
            return soup_fault(d->w->soup, "%lld %s of %lld (truncated?)", (long long)i, what,
                              (long long)d->atoms);
    while (!words_next(d->w, word));
    return 0;
}

/* Goes back to the beginning of the word. */
static void unread(struct words *w, struct word word)
{
    w->at = word.s;
}

static int import_lammps_data_count_words(struct words w)
{
    struct word word;
    int n = 0;
    while (words_next(&w, &word)) n++;
    return n;
}

/* Atoms # style. Of style sphere: id type diameter density x y z, and perhaps three images */
static int import_lammps_data_read_atoms(struct data *d)
{
    static const enum import_column sphere[] = { IMPORT_ID,      IMPORT_TYPE,  IMPORT_DIAMETER,
                                                 IMPORT_DENSITY, IMPORT_X,     IMPORT_Y,
                                                 IMPORT_Z,       IMPORT_OTHER, IMPORT_OTHER,
                                                 IMPORT_OTHER };
    struct import_columns c = { 0 };
    struct word word;
    if (d->read) return soup_fault(d->w->soup, "Atoms a second time");
    d->read = true;
    for (int64_t i = 0; i < d->atoms; i++) {
        struct imported_ball b;
        if (import_lammps_data_next_line(d, i, "atoms", &word)) return d->w->soup->failure->status;
        unread(d->w, word);
        int n = import_lammps_data_count_words(*d->w);
        if (n != 7 && n != 10)
            return soup_fault(
                d->w->soup,
                "%d words, and 7 or 10 are needed: id type diameter density x y z, of "
                "atom_style sphere",
                n);
        if (c.n != n) c = (struct import_columns){ 0 };
        for (int k = c.n; k < n; k++)
            if (import_add_column(&c, d->w, sphere[k])) return d->w->soup->failure->status;
        if (import_line(&c, d->w, &d->to->head, &b) || imported_add(d->to, &b, d->w->soup->failure))
            return d->w->soup->failure->status;
    }
    return 0;
}

static int import_lammps_data_by_id(const void *one, const void *other)
{
    const struct ref *a = one, *b = other;
    return (a->id > b->id) - (a->id < b->id);
}

static int sort_balls(struct data *d)
{
    d->sorted = malloc(((size_t)d->atoms + 1) * sizeof *d->sorted);
    if (!d->sorted)
        return failure_set(d->w->soup->failure, EX_SOFTWARE, "no memory for the balls of a file");
    for (int64_t i = 0; i < d->atoms; i++)
        d->sorted[i] = (struct ref){ d->to->ball[i].id, &d->to->ball[i] };
    qsort(d->sorted, (size_t)d->atoms, sizeof *d->sorted, import_lammps_data_by_id);
    return 0;
}

/* id vx vy vz, and of spheres wx wy wz */
static int read_velocities(struct data *d)
{
    struct word word;
    if (!d->read) return soup_fault(d->w->soup, "Velocities before Atoms");
    if (!d->sorted && sort_balls(d)) return d->w->soup->failure->status;
    for (int64_t i = 0; i < d->atoms; i++) {
        double x[7] = { 0 };
        if (import_lammps_data_next_line(d, i, "velocities", &word))
            return d->w->soup->failure->status;
        unread(d->w, word);
        int n = import_lammps_data_count_words(*d->w);
        if (n != 4 && n != 7)
            return soup_fault(d->w->soup, "%d words, and 4 or 7 are needed: id vx vy vz wx wy wz",
                              n);
        for (int k = 0; k < n; k++)
            if (words_number(d->w, &x[k])) return d->w->soup->failure->status;
        bool whole = x[0] >= 0 && x[0] <= INT32_MAX && x[0] == (double)(int32_t)x[0];
        const struct ref key = { whole ? (int32_t)x[0] : -1, NULL };
        const struct ref *r =
            bsearch(&key, d->sorted, (size_t)d->atoms, sizeof *r, import_lammps_data_by_id);
        if (!r) return word_fault(d->w, word, "is the id of no atom");
        r->ball->v = v3(x[1], x[2], x[3]), r->ball->w = v3(x[4], x[5], x[6]);
    }
    return 0;
}

/* To the next line that begins a section; false at the end */
static bool skip_section(struct words *w, struct word *word)
{
    while (words_line(w))
        if (words_next(w, word) && is_section(*word)) return true;
    return false;
}

static int read_sections(struct data *d, struct word word)
{
    bool more = true;
    while (more) {
        struct word style;
        bool atoms = word_is(word, "atoms"), velocities = word_is(word, "velocities");
        d->w->comments = false; // the style behind # belongs to the section
        bool sphere = false;
        while (words_next(d->w, &style)) {
            if (style.n && *style.s == '#') style.s++, style.n--;
            if (!atoms || !style.n) continue;
            sphere = word_is(style, "sphere") || word_is(style, "granular") ||
                     word_is(style, "granular/sphere");
            if (!sphere)
                return word_fault(d->w, style, "is no atom_style that is read: write spheres");
        }
        d->w->comments = true;
        d->masses = d->masses || word_is(word, "masses");
        if (atoms && d->masses && !sphere)
            return soup_fault(d->w->soup, "Atoms after Masses of types, which atom_style sphere "
                                          "does not have: write spheres");
        if (is_foreign(word))
            return word_fault(d->w, word, "are not of atom_style sphere, of which balls are read");
        if (atoms ? import_lammps_data_read_atoms(d) : velocities ? read_velocities(d) : 0)
            return d->w->soup->failure->status;
        more = skip_section(d->w, &word);
    }
    return 0;
}

static int read_data(struct data *d)
{
    struct word word = { 0 };
    d->w->comments = true;
    if (import_lammps_data_read_units(d)) return d->w->soup->failure->status;
    while (words_line(d->w)) { // behind the first line, a title
        if (import_lammps_data_read_units(d)) return d->w->soup->failure->status;
        if (!words_next(d->w, &word)) continue;
        if (is_section(word)) {
            import_lammps_data_set_box(d);
            return read_sections(d, word);
        }
        if (read_head_line(d, word)) return d->w->soup->failure->status;
    }
    return 0;
}

static int import_lammps_data_read(struct imported *to, struct words *w, int64_t k)
{
    struct data d = { .to = to, .w = w };
    if (k != -1 && k != 0) return soup_fault(w->soup, "no frame %lld: there is one", (long long)k);
    int bad = read_data(&d);
    free(d.sorted);
    if (!bad && !d.read) return soup_fault(w->soup, "no section Atoms (truncated?)");
    if (!bad) import_to_si(to);
    return bad;
}

const struct import_format import_lammps_data = { "a LAMMPS data file", import_lammps_data_looks,
                                                  import_lammps_data_read };
