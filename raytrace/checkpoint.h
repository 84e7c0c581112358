// Films in files, for renderings that are to survive what interrupts them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "files/memory_budget.h"
#include "geometry/rect.h"
#include "raytrace/film.h"
#include "scenes/scene.h"

namespace delray::raytrace {

// Tells whether a film belongs to a rendering: a hash of all of a scene that pictures depend on,
// and of a text that says what is done with it. 32 hex digits. O(scene).
std::string fingerprint(const scenes::Scene& scene, std::string_view settings);

// Writes the film whole or not at all. Throws files::FileError (device).
void save_checkpoint(const std::filesystem::path& path, std::string_view fingerprint,
                     const Film& film);

// The rendering that a film is to be of.
struct Resumed {
  std::string_view fingerprint;
  geometry::Rect window;  // of the film: a picture's, grown
  int samples = 0;        // of a pixel, at most
};

// Reads a film that was written with the same fingerprint, bit by bit what it was. Throws
// files::FileError (input) for a file that is missing, damaged, or of another rendering, and for
// one that no rendering can have written, whatever its checksum: another window, samples that are
// no whole chunks or too many, values that are not numbers or negative where none can be. Memory is
// taken for the film that is expected only.
Film load_checkpoint(const std::filesystem::path& path, const Resumed& resumed,
                     const files::MemoryBudget& memory = {});
// From the content of the file `name`.
Film parse_checkpoint(std::string_view content, const std::string& name, const Resumed& resumed);

}  // namespace delray::raytrace
