/*
 * solve/device_check.h: whether a device has the bits of the CPU: a small problem of known numbers is swept, judged
 * and mixed on both. A driver that contracts, or rounds otherwise, fails here and not in a result.
 */
#ifndef NSD_DEVICE_CHECK_H
#define NSD_DEVICE_CHECK_H

#include "solve/device.h"

/* EX_UNAVAILABLE where they differ, for problems of this kind and this method; once for each */
int device_check(struct device *d, const struct problem_kind *kind, enum method_id method,
                 struct failure *failure);

#endif
