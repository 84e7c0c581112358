// Files that files name.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace delray::files {

// Whether the content of a file may name files that lie elsewhere: --allow-outside.
enum class Outside : std::uint8_t { refused, allowed };

// The file that a file in `folder` calls `name`, as a path without symbolic links: a regular file
// in the folder or below it, unless `outside` are allowed. `name` is relative to the folder or
// absolute, with / or \ between its parts. Throws FileError (input) with that name: it is not
// there, lies elsewhere, or is a folder, pipe or device.
std::filesystem::path resolve(const std::filesystem::path& folder, const std::string& name,
                              Outside outside);

}  // namespace delray::files
