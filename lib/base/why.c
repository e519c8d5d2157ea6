#include "base/why.h"

#include <stdarg.h>
#include <stdio.h>

int why_set(struct why *w, int status, const char *format, ...)
{
    if (w->status) return w->status;
    va_list ap;
    va_start(ap, format);
    vsnprintf(w->text, sizeof w->text, format, ap);
    va_end(ap);
    for (char *c = w->text; *c; c++) // names out of files are in it: nothing that moves a terminal
        if ((unsigned char)*c < ' ' || *c == 127) *c = '?';
    return w->status = status;
}
