#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier): strtod_l
#include "base/number.h"

#include <locale.h>
#include <stdio.h>
#include <stdlib.h>

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
