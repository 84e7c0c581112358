// Declares the functions of HXT that Gmsh's library exports without a header, and calls them on a
// copy of the points. The clock runs during hxtDelaunay alone; tetrahedra with a ghost vertex are
// not counted.
#include "bench/peers/hxt.h"

#include <gmsh.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>

// Gmsh exports these functions but ships no header with their types: what is here is how Gmsh 4.8
// lays them out, and so another version is refused below.
extern "C" {
struct HxtMesh {
  double* coordinates;  // x, y, z and one that it uses itself
  std::uint32_t vertices, vertices_reserved;
  std::uint32_t* corners;  // four to a tetrahedron
  std::uint64_t* neighbours;
  void* unused;
  std::uint16_t* flags;
  std::uint64_t tetrahedra, tetrahedra_reserved;
  void* others[64];
};
struct HxtOptions {
  void *box, *sizes;
  std::uint32_t vertices_in_mesh, first_inserted;
  double partitionability;
  int perfect, verbosity, reproducible, threads;
};
int hxtMeshCreate(HxtMesh** mesh);
int hxtMeshDelete(HxtMesh** mesh);
int hxtDelaunay(HxtMesh* mesh, HxtOptions* options);
int hxtSetMessageCallback(int (*callback)(void* message));
}

namespace delray::bench {

HxtResult triangulate_with_hxt(std::span<const glm::dvec3> points, int threads) {
  if (std::string(GMSH_API_VERSION).substr(0, 3) != "4.8") {
    throw std::runtime_error("HXT's types are known for Gmsh 4.8 alone");
  }
  // It would print a line for every duplicate.
  hxtSetMessageCallback([](void*) { return 0; });
  HxtMesh* mesh = nullptr;
  if (hxtMeshCreate(&mesh) < 0) throw std::runtime_error("HXT makes no mesh");
  constexpr std::size_t kAlignment = 64, kPerVertex = 4;
  mesh->coordinates = static_cast<double*>(std::aligned_alloc(
      kAlignment,
      (points.size() * kPerVertex * sizeof(double) + kAlignment - 1) / kAlignment * kAlignment));
  if (mesh->coordinates == nullptr) throw std::bad_alloc();
  mesh->vertices = mesh->vertices_reserved = static_cast<std::uint32_t>(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int k = 0; k < 3; ++k) mesh->coordinates[kPerVertex * i + k] = points[i][k];
    mesh->coordinates[kPerVertex * i + 3] = 0;
  }
  HxtOptions options{};
  options.perfect = 1;
  options.threads = threads;
  HxtResult result;
  const auto start = std::chrono::steady_clock::now();
  const int status = hxtDelaunay(mesh, &options);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (status < 0) throw std::runtime_error("HXT fails with status " + std::to_string(status));
  constexpr std::uint32_t kGhost = 0xffffffffU;
  for (std::uint64_t t = 0; t < mesh->tetrahedra; ++t) {
    bool finite = true;
    for (int k = 0; k < 4; ++k) finite &= mesh->corners[4 * t + k] != kGhost;
    result.tetrahedra += finite ? 1 : 0;
  }
  hxtMeshDelete(&mesh);
  return result;
}

}  // namespace delray::bench
