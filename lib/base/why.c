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
    return w->status = status;
}
