// Films in files, for renderings that are to survive what interrupts them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "files/memory_budget.h"
#include "geometry/rect.h"
#include "raytrace/film.h"
#include "scenes/scene.h"

namespace delray::raytrace {

// Tells whether a film belongs to a rendering: a hash of all of a scene that pictures depend on,
// and of a text that says what is done with it. 32 hex digits. O(scene).
std::string fingerprint(const scenes::Scene& scene, std::string_view settings);

// Something that samples depend on, by the name that users know it by: "--depth", "8".
struct NamedValue {
  std::string name, value;  // printable, without tabs
  bool operator==(const NamedValue&) const = default;
};

// The rendering that a film is of: its scene and options.
struct Rendering {
  std::string scene;               // fingerprint
  std::vector<NamedValue> values;  // all else that samples depend on
  geometry::Rect window;           // of the film: a picture's, grown
  int samples = 1;                 // of a pixel, at most
  // Whether a sample is the same however many there are: then a film goes on to more, or fewer,
  // than it was begun for (Integrator::any_samples, Setting::scattered).
  bool any_samples = false;
};

// Whether there is a file that begins as checkpoints do, of this version or another.
bool is_checkpoint(const std::filesystem::path& path);

// Writes the film whole or not at all. Throws files::FileError (device).
void save_checkpoint(const std::filesystem::path& path, const Rendering& rendering,
                     const Film& film);

// Reads a film of the same scene and values, bit by bit what it was. Throws files::FileError
// (input) for a file that is missing, damaged, or of another rendering, saying what differs; where
// the film cannot go on to another number of samples; and for one that no rendering can have
// written, whatever its checksum: another window, samples that are no whole chunks or too many,
// values that are not numbers or negative where none can be. Memory is taken for the film that is
// expected only.
Film load_checkpoint(const std::filesystem::path& path, const Rendering& rendering,
                     const files::MemoryBudget& memory = {});
// From the content of the file `name`.
Film parse_checkpoint(std::string_view content, const std::string& name,
                      const Rendering& rendering);

}  // namespace delray::raytrace
