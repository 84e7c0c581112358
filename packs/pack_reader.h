// Reading packs: the table at once, pages when they are asked for.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "files/memory_budget.h"
#include "packs/page.h"
#include "scenes/scene.h"

namespace delray::packs {

// Whether the file begins as a pack does.
bool is_pack(const std::filesystem::path& path);

// An open pack. Any thread may read pages.
class PackReader {
 public:
  // Reads and checks everything but pages. Throws FileError (input) for what is no pack, was cut
  // short or changed, names the place; FileError (memory).
  explicit PackReader(const std::filesystem::path& path, const files::MemoryBudget& memory = {});
  ~PackReader();
  PackReader(const PackReader&) = delete;
  PackReader& operator=(const PackReader&) = delete;

  // What was packed, but for the content of meshes: they have no triangles, and of each attribute
  // that their vertices have a single value, since what is drawn how depends on which there are.
  const scenes::Scene& scene() const { return scene_; }
  // That scene for someone who changes it; the textures go along, so that scene() has none after
  // it.
  scenes::Scene take_scene();
  bool lit_by_emission() const { return lit_by_emission_; }

  std::span<const MeshRow> meshes() const { return meshes_; }
  std::span<const PageRow> pages() const { return pages_; }
  std::span<const Group> groups() const { return groups_; }
  std::uint32_t mesh_of(std::uint32_t page) const;  // O(log meshes)
  // As scenes::first_primitives, of the scene that was packed.
  std::span<const std::uint64_t> first_primitives() const { return first_primitives_; }
  // Of all instances: triangles, points and segments, and vertices.
  std::uint64_t triangles() const { return first_primitives_.back() - splats_; }
  std::uint64_t splats() const { return splats_; }
  std::uint64_t vertices() const { return vertices_; }
  std::uint64_t file_bytes() const { return file_bytes_; }
  const std::string& name() const { return name_; }

  // A page, checked. Throws FileError: (input) where its checksum is another or it is none,
  // (device) where the disk cannot be read. O(its bytes).
  Page read(std::uint32_t page) const;
  // Into `into`, whose memory is used again. Returns for how many seconds the disk was waited for;
  // 0: what was read was in the system's memory, or the system does not tell.
  double read(std::uint32_t page, Page& into) const;
  // Has the system read these pages into its memory, and what little lies between them; does not
  // wait for it. Ascending ones are read in the fewest pieces.
  void will_need(std::span<const std::uint32_t> pages) const;

 private:
  void open(std::uint64_t bytes, const files::MemoryBudget& memory);
  void read_bytes(std::uint64_t begin, std::span<char> bytes) const;
  double read_and_time(std::uint64_t begin, std::span<char> bytes) const;

  std::string name_;
  int descriptor_ = -1;
  std::uint64_t file_bytes_ = 0;
  scenes::Scene scene_;
  bool lit_by_emission_ = false;
  std::vector<MeshRow> meshes_;
  std::vector<PageRow> pages_;
  std::vector<Group> groups_;
  std::vector<std::uint64_t> first_primitives_;
  std::uint64_t vertices_ = 0, splats_ = 0;
};

}  // namespace delray::packs
