// Scenes from files.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/format.h"
#include "files/memory_budget.h"
#include "files/resolve.h"
#include "parallel/progress.h"
#include "scenes/scene.h"

namespace delray::scenes {

// Limits of a file that is read.
struct LoadOptions {
  files::MemoryBudget memory;  // for all that the file unpacks to, and those that it names
  // Whether buffers, textures and materials may lie outside of the scene's folder.
  files::Outside outside = files::Outside::refused;
  parallel::Progress* progress = nullptr;
  // Called once with the scene as soon as it can be shown: all is there, but triangles are in the
  // order of the file.
  std::function<void(const Scene& scene)> on_read = {};
};

namespace internal {
struct Source;
}

// A way to read scenes.
struct SceneReader {
  files::Format format;
  std::string_view name;         // "OBJ"
  std::string_view description;  // one line
  Scene (*read)(const internal::Source& source);
  bool in_parts = false;  // reads ranges of a file, which need not be in memory as a whole
};

std::span<const SceneReader> scene_readers();

// Loads what scene_readers() lists, from a file or stream. Bad geometry (indices out of
// range, NaN or infinite vertices, degenerate triangles) never reaches the scene: an index or
// coordinate that is wrong is bad input (files::FileError); triangles with two corners in one place
// are dropped and told in `warnings`. A file whose content takes more than `memory` is FileError
// (memory).
Scene load(const std::filesystem::path& path, std::vector<std::string>& warnings,
           const LoadOptions& options = {});

}  // namespace delray::scenes
