#include "base/embedded.h"

#include <stdatomic.h>

static atomic_bool embedded;

void embedded_set(void)
{
    atomic_store(&embedded, true);
}

bool embedded_is(void)
{
    return atomic_load(&embedded);
}
