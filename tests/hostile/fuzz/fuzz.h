/* tests/hostile/fuzz/fuzz.h: what the fuzz targets share. */
#ifndef NSD_FUZZ_H
#define NSD_FUZZ_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* 0: done; -1: not to be kept in the corpus */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#endif
