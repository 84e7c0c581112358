// Refinement over MPI: the same points and triangles as by so many simulated ranks. Run it under
// mpirun with any number of processes.
#include <cstdio>

#include "comm/mpi.h"
#include "comm/simulated.h"
#include "delaunay/generate.h"
#include "delaunay/outline.h"
#include "delaunay/refine.h"
#include "delaunay/verify.h"

namespace {

using namespace delray;

delaunay::Refined refine_simulated(int ranks, const delaunay::Outline& outline,
                                   const delaunay::RefineOptions& options) {
  delaunay::Refined result;
  comm::run_simulated(ranks, comm::any_order(), 1, [&](comm::Communicator& communicator) {
    delaunay::Refined refined = refine(communicator, outline, options);
    if (communicator.rank() == 0) result = std::move(refined);
  });
  return result;
}

// Says what is wrong, if anything.
const char* difference(const delaunay::Refined& refined, const delaunay::Refined& expected) {
  if (refined.points != expected.points) return "other points";
  if (refined.triangulation.vertices != expected.triangulation.vertices) return "other triangles";
  if (refined.inside != expected.inside || refined.segments != expected.segments) {
    return "another domain";
  }
  if (refined.counts.rounds != expected.counts.rounds) return "other rounds";
  const auto verdict =
      verify_triangles(delaunay::view(refined.points), refined.triangulation.vertices);
  return verdict.canonical ? nullptr : "not the Delaunay triangulation";
}

}  // namespace

int main(int argc, char** argv) {
  bool fine = true;
  comm::run_mpi(&argc, &argv, [&](comm::Communicator& communicator) {
    const bool is_first = communicator.rank() == 0;
    for (const delaunay::OutlineGenerator& kind : delaunay::outline_generators()) {
      const delaunay::Outline outline = delaunay::generate_outline(kind.name, 400, 2);
      const delaunay::RefineOptions options{.min_angle = 25, .max_area = 2e-4};
      const delaunay::Refined refined =
          refine(communicator, is_first ? outline : delaunay::Outline{}, options);
      if (!is_first) continue;
      const char* wrong =
          difference(refined, refine_simulated(communicator.size(), outline, options));
      if (wrong == nullptr) continue;
      fine = false;
      std::fprintf(stderr, "%s: %s\n", std::string(kind.name).c_str(), wrong);
    }
  });
  return fine ? 0 : 1;
}
