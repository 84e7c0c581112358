// MPI's C interface, without the C++ bindings that some implementations still bring along.
#pragma once

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>
