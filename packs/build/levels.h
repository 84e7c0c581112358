// Coarser levels of a mesh.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "files/memory_budget.h"
#include "packs/build/encoded_page.h"
#include "packs/page.h"
#include "parallel/progress.h"

namespace delray::packs::internal {

struct LevelBuilder {
  // Reads a page that was written.
  std::function<Page(std::uint32_t page)> read;
  // Appends pages to the file and to the table.
  std::function<void(std::vector<EncodedPage>&& pages)> append;
  // Of a file without a name: two to four bytes for each triangle of the finest level.
  std::filesystem::path scratch;
  parallel::Progress* progress = nullptr;  // counts triangles that others are measured against
  files::MemoryBudget memory = files::MemoryBudget::unlimited();
  std::string name;  // of the pack, for errors
};

// Simplifies the finest level of the mesh, and what becomes of it, level by level, as long as that
// leaves fewer triangles. Pages get the groups that they are simplified in; groups and levels are
// appended. Parallel over groups, as many at a time as there is memory for; the same for every
// number of threads. Throws FileError (memory), before anything is made, where there is none for
// the largest group of points.
// O(triangles log triangles).
void build_levels(const LevelBuilder& builder, std::vector<PageRow>& pages,
                  std::vector<Group>& groups, MeshRow& mesh);

}  // namespace delray::packs::internal
