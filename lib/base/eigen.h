/* base/eigen.h: eigenvalues of small matrices, the same bits on every machine. */
#ifndef NSD_EIGEN_H
#define NSD_EIGEN_H

enum { EIGEN_MOST = 6 };

/* The largest eigenvalue of the symmetric part of A[n n], n at most EIGEN_MOST, to a few roundings of the
   largest of all in magnitude. It has the unit of A's entries. */
double eigen_largest(int n, const double *A);

#endif
