/*
 * convert/import_yade.c: the tables that Yade's export.text and export.textExt write [yade-dem.org, yade.export]:
 * "#format x_y_z_r", "..._matId", "id_x_y_z_r_matId" or "x_y_z_r_attrs", the last with a comment "# x y z r NAME ..."
 * for its columns; then a line a ball. Members of clumps (textClumps) are no balls, and refused.
 */
#include "convert/imported.h"

#include <string.h>

static bool import_yade_looks(const char *bytes, int64_t n)
{
    (void)n;
    return !strncmp(bytes, "#format ", 8);
}

/* x_y_z_r_matId: the columns' names between underscores */
static int import_yade_read_format(struct import_columns *c, struct words *w, bool *attributes)
{
    struct word format;
    if (!words_next(w, &format)) return soup_fault(w->soup, "#format of nothing");
    for (int from = 0; from < format.n;) {
        struct word name = { format.s + from, 0 };
        while (from + name.n < format.n && name.s[name.n] != '_') name.n++;
        from += name.n + 1;
        if (word_is(name, "clumpid"))
            return soup_fault(
                w->soup, "members of clumps, which are not balls: export.textExt writes balls");
        if (word_is(name, "attrs"))
            *attributes = true;
        else if (import_name_column(c, w, name))
            return w->soup->failure->status;
    }
    return import_check_columns(c, w, "export.textExt(..., format='x_y_z_r_matId')");
}

/* The columns of a comment that begins with "x y z r", in place of those of the format */
static int read_comment(struct import_columns *c, struct words *w)
{
    struct import_columns named = { 0 };
    struct word name;
    while (words_next(w, &name))
        if (import_name_column(&named, w, name)) return w->soup->failure->status;
    if (named.n > 4 && named.of[0] == IMPORT_X && named.of[1] == IMPORT_Y &&
        named.of[2] == IMPORT_Z && named.of[3] == IMPORT_RADIUS)
        *c = named;
    return 0;
}

static int import_yade_count_words(struct words w)
{
    struct word word;
    int n = 0;
    while (words_next(&w, &word)) n++;
    return n;
}

static int import_yade_read(struct imported *to, struct words *w, int64_t k)
{
    struct import_columns c = { 0 };
    bool attributes = false;
    struct word word;
    if (k != -1 && k != 0) return soup_fault(w->soup, "no frame %lld: there is one", (long long)k);
    do {
        if (!words_next(w, &word)) continue;
        struct imported_ball b;
        if (word_is(word, "#format")) {
            if (import_yade_read_format(&c, w, &attributes)) return w->soup->failure->status;
        } else if (*word.s == '#') {
            if (word.n > 1) w->at = word.s + 1;
            if (attributes && read_comment(&c, w)) return w->soup->failure->status;
        } else {
            w->at = word.s;
            // attributes without names are read over
            for (int n = attributes && c.n == 4 ? import_yade_count_words(*w) : 0; c.n < n;)
                if (import_add_column(&c, w, IMPORT_OTHER)) return w->soup->failure->status;
            if (import_line(&c, w, &to->head, &b) || imported_add(to, &b, w->soup->failure))
                return w->soup->failure->status;
        }
    } while (words_line(w));
    return 0;
}

const struct import_format import_yade_text = { "a table of Yade", import_yade_looks,
                                                import_yade_read };
