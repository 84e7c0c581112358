// Whole packs in memory.
#pragma once

#include "files/memory_budget.h"
#include "packs/pack_reader.h"

namespace delray::packs {

// The scene that was packed, for who needs all of it at once: the same triangles in the same order,
// with the same bits at their corners; vertices that pages share are there once for each page.
// Takes the textures out of the pack. Parallel. Throws FileError, (memory) before it takes more
// than that.
scenes::Scene unpack(PackReader& pack, const files::MemoryBudget& memory = {});

// Appends the triangles of a page, with vertices of their own, to a mesh of the same attributes.
void append_page(const scenes::Mesh& page, scenes::Mesh& mesh);

}  // namespace delray::packs
