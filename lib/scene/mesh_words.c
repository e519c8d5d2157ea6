/* scene/mesh_words.c: text taken apart [scene/mesh_words.h]. */
#include "scene/mesh_words.h"

#include "base/mark.h"
#include "base/number.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

enum {
    NUMBER_MOST = 400, /* bytes of a number */
    SHOWN = 40         /* of a word in a message */
};

struct words words_of(struct soup *soup, const char *bytes, int64_t n)
{
    soup->unit = "line", soup->at = 1;
    return (struct words){ soup, bytes + mark_length(bytes, (size_t)n), bytes + n, false, false };
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

/* Is this the backslash before the end of a line? */
static bool mesh_file_goes_on(const struct words *w)
{
    const char *s = w->at + 1;
    return w->joined && *w->at == '\\' && (*s == '\n' || (*s == '\r' && s[1] == '\n'));
}

bool words_next(struct words *w, struct word *word)
{
    while (is_blank(*w->at) || mesh_file_goes_on(w)) {
        if (*w->at++ != '\\') continue;
        w->at = strchr(w->at, '\n') + 1;
        w->soup->at++;
    }
    if (w->comments && *w->at == '#')
        while (w->at < w->end && *w->at != '\n') w->at++;
    word->s = w->at;
    while (w->at < w->end && *w->at != '\n' && !is_blank(*w->at) && !mesh_file_goes_on(w)) w->at++;
    word->n = (int)(w->at - word->s < INT32_MAX ? w->at - word->s : INT32_MAX);
    return word->n > 0;
}

bool words_line(struct words *w)
{
    struct word rest;
    while (words_next(w, &rest)) {
    }
    if (w->at == w->end) return false;
    w->at++, w->soup->at++;
    return true;
}

bool words_any(struct words *w, struct word *word)
{
    while (!words_next(w, word))
        if (!words_line(w)) return false;
    return true;
}

bool word_is(struct word word, const char *what)
{
    for (int k = 0; k < word.n; k++)
        if (!what[k] || tolower((unsigned char)word.s[k]) != what[k]) return false;
    return !what[word.n];
}

bool word_has_only(struct word word, const char *letters)
{
    for (int k = 0; k < word.n; k++)
        if (!word.s[k] || !strchr(letters, word.s[k])) return false;
    return true;
}

int word_fault(struct words *w, struct word word, const char *trouble)
{
    return soup_fault(w->soup, "\"%.*s\" %s", word.n < SHOWN ? word.n : SHOWN, word.s, trouble);
}

int word_number(struct words *w, struct word word, double *x)
{
    char *end = NULL;
    bool decimal = word.n < NUMBER_MOST && word_has_only(word, "+-.0123456789eE"); // no nan, 0x1
    if (decimal) *x = number_read(word.s, &end);
    if (!decimal || end != word.s + word.n)
        return word_fault(w, word, "is no finite decimal number");
    return isfinite(*x) ? 0 : word_fault(w, word, "is too large");
}

int words_number(struct words *w, double *x)
{
    struct word word;
    if (!words_next(w, &word))
        return soup_fault(w->soup, "a number is missing: is the file cut off?");
    return word_number(w, word, x);
}

int words_whole(struct words *w, int64_t *i)
{
    double x = 0;
    if (words_number(w, &x)) return w->soup->failure->status;
    if (!(x == floor(x) && fabs(x) < 1e15)) return soup_fault(w->soup, "%g is no whole number", x);
    *i = (int64_t)x;
    return 0;
}
