#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier): fopencookie, strtod_l
#include "base/text.h"

#include <locale.h>
#include <stdlib.h>
#include <string.h>

/* The C library has it, and makes no other: it is not to be freed. */
static locale_t plain(void)
{
    return newlocale(LC_ALL_MASK, "C", (locale_t)0);
}

double number_read(const char *text, char **end)
{
    return strtod_l(text, end, plain());
}

void number_write(char *text, size_t room, int digits, char form, double x)
{
    locale_t was = uselocale(plain());
    snprintf(text, room, form == 'e' ? "%.*e" : "%.*g", digits, x);
    uselocale(was);
}

void number_shortest(char text[NUMBER_ROOM], double x)
{
    for (int digits = 15; digits <= 17; digits++) {
        number_write(text, NUMBER_ROOM, digits, 'g', x);
        if (number_read(text, NULL) == x) return;
    }
}

/* ---- a text in memory ---- */

static ssize_t text_put(void *to, const char *bytes, size_t n)
{
    struct text *t = to;
    if (t->size + n + 1 > t->room && !t->lost) {
        size_t room = 2 * t->room + n + 1;
        char *more = realloc(t->bytes, room);
        t->lost = !more;
        if (more) t->bytes = more, t->room = room;
    }
    if (t->lost) return 0;
    memcpy(t->bytes + t->size, bytes, n);
    t->size += n;
    return (ssize_t)n;
}

FILE *text_open(struct text *t)
{
    *t = (struct text){ 0 };
    return fopencookie(t, "w", (cookie_io_functions_t){ .write = text_put });
}

char *text_close(struct text *t, FILE *stream, size_t *size)
{
    bool bad = !stream || ferror(stream);
    if (stream && fclose(stream)) bad = true;
    if (!bad && !t->bytes) text_put(t, "", 0);
    if (bad || t->lost || !t->bytes) return free(t->bytes), NULL;
    t->bytes[t->size] = 0;
    *size = t->size;
    return t->bytes;
}
