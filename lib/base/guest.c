#include "base/guest.h"

#include <stdatomic.h>

static atomic_bool guest;

void guest_set(void)
{
    atomic_store(&guest, true);
}

bool guest_is(void)
{
    return atomic_load(&guest);
}
