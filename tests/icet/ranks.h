// The processes of a program over MPI.
#pragma once

#include <mpi.h>

struct Ranks {
  int rank = 0, size = 1;
};
inline Ranks ranks() {
  Ranks result;
  MPI_Comm_rank(MPI_COMM_WORLD, &result.rank);
  MPI_Comm_size(MPI_COMM_WORLD, &result.size);
  return result;
}
