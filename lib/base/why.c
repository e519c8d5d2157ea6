/* base/why.c: the first reason of a failure is kept. */
#include "base/why.h"

#include <stdarg.h>
#include <stdio.h>

#undef why_set // which is what the analyser takes for it

int why_set(struct why *why, int status, const char *format, ...)
{
    if (why->status) return why->status;
    va_list ap;
    va_start(ap, format);
    vsnprintf(why->text, sizeof why->text, format, ap);
    va_end(ap);
    for (char *c = why->text; *c;
         c++) // names out of files are in it: nothing that moves a terminal
        if ((unsigned char)*c < ' ' || *c == 127) *c = '?';
    return why->status = status;
}
