/*
 * base/embedded.h: whether this is the library in the program of somebody else. Then the process is not ours: its signals
 * stay as they are, and it may have other threads.
 */
#ifndef NSD_GUEST_H
#define NSD_GUEST_H

#include <stdbool.h>

void embedded_set(void);
bool embedded_is(void);

#endif
