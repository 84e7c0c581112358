// Fingerprints of files: whether two machines have equal ones, without reading all of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace delray::files {

// Hashes of kParts parts of kPartBytes each, spread evenly over the file from its first byte to its
// last.
struct Fingerprint {
  static constexpr std::size_t kParts = 16, kPartBytes = 65536;

  struct Part {
    std::uint64_t begin = 0;  // its first byte in the file
    std::string hash;         // XXH3-64 of its bytes, 16 lower-case hex digits
  };
  std::uint64_t bytes = 0;
  std::vector<Part> parts;  // all of a file that is no larger is one
};

// Nothing in it for what is no regular file, or cannot be read: then there is nothing to compare.
// A megabyte is read at most.
Fingerprint fingerprint(const std::filesystem::path& path);

}  // namespace delray::files
