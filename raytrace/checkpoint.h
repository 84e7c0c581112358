// Films in files, for renderings that are to survive what interrupts them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "files/memory_budget.h"
#include "raytrace/film.h"
#include "scenes/scene.h"

namespace delray::raytrace {

// Tells whether a film belongs to a rendering: a hash of all of a scene that pictures depend on,
// and of a text that says what is done with it. 32 hex digits. O(scene).
std::string fingerprint(const scenes::Scene& scene, std::string_view settings);

// Writes the film whole or not at all. Throws files::FileError (device).
void save_checkpoint(const std::filesystem::path& path, std::string_view fingerprint,
                     const Film& film);

// Reads a film that was written with the same fingerprint, bit by bit what it was. Throws
// files::FileError (input) for a file that is missing, damaged, or of another rendering.
Film load_checkpoint(const std::filesystem::path& path, std::string_view fingerprint,
                     const files::MemoryBudget& memory = {});

}  // namespace delray::raytrace
