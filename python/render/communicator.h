// Ranks of a communicator that Python gives: those of mpi4py, or threads.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "comm/communicator.h"

namespace delray::python {

// Behind delray.Communicator: a duplicate of an MPI communicator.
struct MpiRanks {
  std::unique_ptr<comm::Communicator> communicator;
};

}  // namespace delray::python
