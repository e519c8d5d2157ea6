/* base/failure.c: the first reason of a failure is kept. */
#include "base/failure.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>

#undef failure_set // which is what the analyser takes for it

/* How many bytes the UTF-8 character at s has, with the number in *is; 0: it is none */
static int failure_character(const unsigned char *s, unsigned *is)
{
    int n = *s < 0x80 ? 1 : *s < 0xc2 ? 0 : *s < 0xe0 ? 2 : *s < 0xf0 ? 3 : *s < 0xf5 ? 4 : 0;
    *is = n < 2 ? *s : *s & (0x7fU >> n);
    for (int k = 1; k < n; k++) {
        if ((s[k] & 0xc0) != 0x80) return 0;
        *is = *is << 6 | (s[k] & 0x3f);
    }
    return n;
}

void failure_plain(char *text)
{
    for (unsigned char *s = (unsigned char *)text; *s;) {
        unsigned is;
        int n = failure_character(s, &is);
        bool moves = !n || is < ' ' || (is >= 0x7f && is < 0xa0); // C0, DEL, C1
        for (int k = 0; k < (n ? n : 1); k++, s++)
            if (moves) *s = '?';
    }
}

int failure_set(struct failure *failure, int status, const char *format, ...)
{
    if (failure->status) return failure->status;
    va_list ap;
    va_start(ap, format);
    vsnprintf(failure->text, sizeof failure->text, format, ap);
    va_end(ap);
    failure_plain(failure->text);
    return failure->status = status;
}
