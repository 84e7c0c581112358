// Whole files in memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace delray::files {

// The bytes of a file, or of standard input for "-". A file that does not exist, cannot be read or
// is a folder is Cause::input: the user named the wrong thing.
std::string read_file(const std::filesystem::path& path);

// At most `limit` first bytes of a file, for finding out what it is. Not for "-".
std::string read_start(const std::filesystem::path& path, std::size_t limit);

}  // namespace delray::files
