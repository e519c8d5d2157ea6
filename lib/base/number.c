#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier): strtod_l
#include "base/number.h"

#include <locale.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

static locale_t plain; /* "C", which the C library has without an allocation */
static pthread_once_t once = PTHREAD_ONCE_INIT;

static void make(void)
{
    plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
}

double number_read(const char *text, char **end)
{
    pthread_once(&once, make);
    return strtod_l(text, end, plain);
}

void number_write(char *text, size_t room, int digits, char form, double x)
{
    pthread_once(&once, make);
    locale_t was = uselocale(plain);
    snprintf(text, room, form == 'e' ? "%.*e" : "%.*g", digits, x);
    uselocale(was);
}
