// Time and memory for each rank of a scene file that is read in parts, under mpirun:
//
//   mpirun -n N scenes_load_parts FILE     seconds, and the largest peak of a rank
//   scenes_load_parts --whole FILE         as one rank that has all of it
//
// The bar is that the peak of n ranks is at most 1.25 n-ths of that of the whole.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "comm/collectives.h"
#include "comm/mpi.h"
#include "files/memory_budget.h"
#include "parallel/arena.h"
#include "scenes/load.h"
#include "scenes/load_part.h"

namespace {

using namespace delray;

std::uint64_t bytes_of(const scenes::Scene& scene) {
  std::uint64_t bytes = 0;
  for (const scenes::Mesh& mesh : scene.meshes) {
    bytes += mesh.positions.size() * sizeof(glm::vec3) + mesh.normals.size() * sizeof(glm::vec3) +
             mesh.uvs.size() * sizeof(glm::vec2) + mesh.colours.size() * sizeof(glm::vec4) +
             mesh.triangles.size() * sizeof(glm::uvec3);
  }
  return bytes;
}

void load(comm::Communicator& communicator, const std::string& file, bool whole) {
  const std::uint64_t before = files::resident_set();
  bench::peak_memory(true);
  std::vector<std::string> warnings;
  const scenes::LoadOptions options{.memory = files::MemoryBudget::unlimited()};
  const double start = communicator.seconds();
  scenes::Scene scene;
  if (whole) {
    scene = scenes::load(file, warnings, options);
    scenes::complete_surfaces(scene);
  } else {
    auto part = scenes::load_part(communicator, file, warnings, options);
    if (!part) throw std::invalid_argument(file + " is not read in parts");
    scene = std::move(part->scene);
  }
  const double seconds = communicator.seconds() - start;
  const std::uint64_t peak = bench::peak_memory(false);
  std::vector<std::uint64_t> most = {peak > before ? peak - before : 0, bytes_of(scene)};
  comm::all_reduce(communicator, std::span(most),
                   [](std::uint64_t a, std::uint64_t b) { return std::max(a, b); });
  const double slowest = comm::all_reduce_value(communicator, seconds,
                                                [](double a, double b) { return std::max(a, b); });
  if (communicator.rank() != 0) return;
  constexpr double kMega = 1e6;
  std::printf("%d ranks: %.3f s, peak %.1f MB a rank at most, kept %.1f MB\n", communicator.size(),
              slowest, static_cast<double>(most[0]) / kMega, static_cast<double>(most[1]) / kMega);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Seconds and memory of each rank that loading a scene file in parts takes");
  std::string file;
  bool whole = false;
  app.add_option("FILE", file, "Scene file")->required();
  app.add_flag("--whole", whole, "Every rank loads all of it");
  CLI11_PARSE(app, argc, argv);
  const parallel::AllowThreads allow(1);
  comm::run_mpi(&argc, &argv, [&](comm::Communicator& communicator) {
    parallel::Arena arena(1);
    arena.execute([&] { load(communicator, file, whole); });
  });
  return 0;
}
