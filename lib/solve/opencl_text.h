/* solve/opencl_text.h: the text of a device's kernels: those of the CPU where C and OpenCL C agree, in their order. */
#ifndef NSD_OPENCL_TEXT_H
#define NSD_OPENCL_TEXT_H

/* The text, without the includes, which are in it already; NULL when memory is short. To be freed. */
char *opencl_text(void);

#endif
