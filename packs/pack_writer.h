// Writing packs, mesh by mesh, in bounded memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "packs/page.h"
#include "scenes/scene.h"

namespace delray::packs {

// The bytes that a file of packs begins with, and the version of the format.
inline constexpr char kMagic[8] = {'D', 'E', 'L', 'R', 'A', 'Y', 'P', 'K'};
inline constexpr std::uint32_t kVersion = 1;

// A file that appears whole or not at all. Besides a mesh that it is given it needs some pages, and
// a row for each that it has written. See docs/packs.md for the format.
class PackWriter {
 public:
  // Throws FileError (device), as all of it does.
  explicit PackWriter(const std::filesystem::path& path);
  ~PackWriter();
  PackWriter(const PackWriter&) = delete;
  PackWriter& operator=(const PackWriter&) = delete;

  // Appends the pages of a mesh, of which all triangles keep their numbers and vertices their bits;
  // of vertices without triangles nothing is left. Returns its number. Parallel. O(triangles).
  // A mesh without triangles is std::invalid_argument. REQUIRES: coordinates are finite.
  std::uint32_t add_mesh(const scenes::Mesh& mesh);

  // Appends what the scene has besides its meshes, which are those that were added, and gives the
  // file its name. `lit_by_emission` as scenes::is_lit_by_emission says of the whole.
  void commit(const scenes::Scene& rest, bool lit_by_emission);

  std::uint64_t bytes() const;  // written so far

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// A whole scene, completed as for rendering (scenes::complete_surfaces), as a pack. Parallel.
void write_pack(const std::filesystem::path& path, const scenes::Scene& scene);

}  // namespace delray::packs
