// Scenes from memory.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/load.h"

namespace delray::scenes::internal {

// As load; `content` is that of the file `path`, which need not exist. Files that the content names
// are looked for beside `path`.
Scene load_content(const std::filesystem::path& path, std::string content,
                   std::vector<std::string>& warnings, const LoadOptions& options = {});

}  // namespace delray::scenes::internal
