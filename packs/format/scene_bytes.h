// What a scene has besides triangles, as bytes, and back.
#pragma once

#include <string>
#include <vector>

#include "files/memory_budget.h"
#include "packs/format/bytes.h"
#include "packs/page.h"
#include "scenes/scene.h"

namespace delray::packs::internal {

// Instances, materials, textures, lights, environment, cameras and what else is no mesh; of
// animations only how meshes move. Texels are compressed in blocks.
void write_scene(const scenes::Scene& scene, ByteWriter& to);
// Throws FileError for what is no scene of so many meshes: numbers that are out of range,
// transforms that are not finite; FileError (memory) for textures that do not fit.
void read_scene(ByteReader& from, std::size_t meshes, const files::MemoryBudget& memory,
                const std::string& file, scenes::Scene& scene);

// The rows of meshes, pages and groups.
struct Table {
  std::vector<MeshRow> meshes;
  std::vector<PageRow> pages;
  std::vector<Group> groups;
  // Whether surfaces that glow light the scene: scenes::is_lit_by_emission of what was packed.
  bool lit_by_emission = false;
};
void write_table(const Table& table, ByteWriter& to);
// `data_end` is where pages end in the file. Throws FileError (input) for rows that cannot be.
void read_table(ByteReader& from, std::uint64_t data_end, Table& table);

}  // namespace delray::packs::internal
