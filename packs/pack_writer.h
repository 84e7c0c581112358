// Writing packs, mesh by mesh, in bounded memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "files/memory_budget.h"
#include "packs/page.h"
#include "parallel/progress.h"
#include "scenes/scene.h"

namespace delray::packs {

// The bytes that a file of packs begins with, and the version of the format.
inline constexpr char kMagic[8] = {'D', 'E', 'L', 'R', 'A', 'Y', 'P', 'K'};
inline constexpr std::uint32_t kVersion = 4;

// What is written besides what was given.
struct WriteOptions {
  bool levels = true;  // coarser ones, for pictures with a bound of error
  // Told how far the levels of each mesh are, which take longest. Once it is asked to stop, what
  // appends throws parallel::Interrupted, and no file is left.
  parallel::Progress* progress = nullptr;
  // As many groups of a level are made at once as it has room for. Of points each may take 60 MB;
  // FileError (memory) where one does not fit.
  files::MemoryBudget memory = files::MemoryBudget::unlimited();
};

// A file that appears whole or not at all. Besides what it is given it needs some pages, a row for
// each that it has written, and for levels what WriteOptions::memory says. See docs/packs.md for
// the format.
class PackWriter {
 public:
  // Throws FileError (device), as all of it does. Where levels are written the file has to be one
  // that can be replaced.
  explicit PackWriter(const std::filesystem::path& path, const WriteOptions& options = {});
  ~PackWriter();
  PackWriter(const PackWriter&) = delete;
  PackWriter& operator=(const PackWriter&) = delete;

  // Appends the pages of a mesh, of which all triangles keep their numbers and vertices their bits;
  // of vertices without triangles nothing is left. Returns its number. Parallel. O(triangles), and
  // O(triangles log triangles) for levels.
  // A mesh without triangles is std::invalid_argument. REQUIRES: coordinates are finite.
  std::uint32_t add_mesh(const scenes::Mesh& mesh);

  // The same in parts, which follow each other: a mesh has the triangles of all parts that were
  // appended since the last one was ended. Parts have the same attributes; vertices that are alike
  // to the last bit are one to levels. Wherever parts of multiples of kBlockTriangles are cut, the
  // file is the same. `shape` is that of all parts, of the kind that each has.
  static constexpr std::uint32_t kBlockTriangles = 1U << 14;
  void append_part(const scenes::Mesh& part);
  std::uint32_t end_mesh(const std::string& name, std::uint32_t material, std::uint64_t vertices,
                         const scenes::Shape& shape = {});

  // Appends what the scene has besides its meshes, which are those that were added, and gives the
  // file its name. `lit_by_emission` as scenes::is_lit_by_emission says of the whole.
  void commit(const scenes::Scene& rest, bool lit_by_emission);

  std::uint64_t bytes() const;  // written so far

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// A whole scene, completed as for rendering (scenes::complete_surfaces), as a pack. Parallel.
void write_pack(const std::filesystem::path& path, const scenes::Scene& scene,
                const WriteOptions& options = {});

}  // namespace delray::packs
