// The interface of the sparse factorisation MA27, as Ipopt calls it, over a dense one: LAPACK's Bunch-Kaufman
// factorisation (dsytrf) of the equilibrated matrix. Everything is kept in the caller's work arrays, so any number of
// threads may factorise at once; Ipopt's default, MUMPS, allows one (docs/decisions/0008-ipopt-in-parallel.md).
//
// Arguments are those of the MA27 subroutines that Ipopt uses; Fortran indices count from 1. Of INFO are set: 1 (flag:
// 0, or -3, -4 workspace too short, with the length that is needed in 2, or -5 singular), 5 and 6 (lengths of A and IW
// that MA27BD needs), 15 (number of negative eigenvalues).
#pragma once

extern "C" {

// Defaults of the control parameters.
void cellmirror_ma27id(int* icntl, double* cntl);

// "Analysis": gives the lengths of the work arrays for a matrix of order n with nz entries.
void cellmirror_ma27ad(int* n, int* nz, const int* irn, const int* icn, int* iw, int* liw, int* ikeep, int* iw1,
                       int* nsteps, int* iflag, int* icntl, double* cntl, int* info, double* ops);

// Factorises. A holds the nz values on entry (entries of the same place add up) and the factor on exit.
void cellmirror_ma27bd(int* n, int* nz, const int* irn, const int* icn, double* a, int* la, int* iw, int* liw,
                       int* ikeep, int* nsteps, int* maxfrt, int* iw1, int* icntl, double* cntl, int* info);

// Solves for one right hand side, in place.
void cellmirror_ma27cd(int* n, double* a, int* la, int* iw, int* liw, double* w, int* maxfrt, double* rhs, int* iw1,
                       int* nsteps, int* icntl, double* cntl);

}  // extern "C"
