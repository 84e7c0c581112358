// Whole files in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "files/memory_budget.h"

namespace delray::files {

// The bytes of a file, or of a stream to its end. A file that does not exist, cannot be read or is
// a folder is FileError (input): the user named the wrong thing; so is a stream that does not end
// within `memory`. A file that is larger than that is FileError (memory).
std::string read_file(const std::filesystem::path& path, const MemoryBudget& memory = {});

// At most `limit` first bytes of a file or stream, for finding out what it is. Those of a stream
// are kept, with the stream open, for who looks again and for read_file.
std::string read_start(const std::filesystem::path& path, std::size_t limit,
                       const MemoryBudget& memory = {});

// Fills `bytes` from byte `begin` of a regular file on, from any thread. Throws FileError (input)
// where the file cannot be read or ends before.
void read_range(const std::filesystem::path& path, std::uint64_t begin, std::span<char> bytes);

// Whether `path` can be read but once: standard input ("-"), a pipe or a device.
bool is_stream(const std::filesystem::path& path);

}  // namespace delray::files
