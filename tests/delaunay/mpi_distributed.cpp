// Every distributed method over MPI: the simplices that triangulate() gives. Run it under mpirun
// with any number of processes.
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "comm/collectives.h"
#include "comm/mpi.h"
#include "delaunay/distributed.h"
#include "delaunay/generate.h"
#include "delaunay/triangulate.h"

namespace {

using namespace delray;

// Whether a method gives what it should.
bool gives_all(comm::Communicator& communicator, const std::vector<glm::dvec3>& positions,
               const delaunay::DistributedOptions& options) {
  std::vector<delaunay::RowPoint> mine;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (static_cast<int>(i) % communicator.size() == communicator.rank())
      mine.push_back({positions[i], i});
  }
  const auto made = triangulate_distributed(communicator, mine, options);
  const auto hash = comm::all_reduce_value(
      communicator, delaunay::hash(made.part.dim, made.part.vertices), std::plus<>());
  const auto expected = triangulate(delaunay::view(positions), options.triangulate).triangulation;
  return hash == delaunay::hash(expected);
}

}  // namespace

int main(int argc, char** argv) {
  bool fine = true;
  comm::run_mpi(&argc, &argv, [&](comm::Communicator& communicator) {
    for (const int dim : {2, 3}) {
      for (const std::string_view name : delaunay::distributed_methods_for(dim)) {
        delaunay::DistributedOptions options;
        options.method = name;
        options.triangulate.dim = dim;
        // Few points: processes that share a core take turns with every message.
        const auto positions = delaunay::generate_points("grid", 30, dim, 1).positions;
        if (gives_all(communicator, positions, options)) continue;
        fine = false;
        std::fprintf(stderr, "%s, %dD: wrong simplices\n", options.method.c_str(), dim);
      }
    }
  });
  return fine ? 0 : 1;
}
