#include "report.h"

#include <stdlib.h>

void report_free(struct report *r)
{
    free(r->options), free(r->history);
    *r = (struct report){ 0 };
}
