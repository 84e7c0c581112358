// Hashes parts of a file at even distances, the last one at its end; a small file is hashed as a
// whole.
#include "files/fingerprint.h"

#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <system_error>

namespace delray::files {
namespace {

std::string hex(std::uint64_t value) {
  std::array<char, 17> digits{};
  std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(value));
  return digits.data();
}

}  // namespace

Fingerprint fingerprint(const std::filesystem::path& path) {
  Fingerprint result;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return result;
  result.bytes = std::filesystem::file_size(path, error);
  std::ifstream file(path, std::ios::binary);
  if (error || !file) return {};
  constexpr std::uint64_t kAll = Fingerprint::kParts * Fingerprint::kPartBytes;
  const bool is_small = result.bytes <= kAll;
  const std::uint64_t parts = is_small ? 1 : Fingerprint::kParts;
  std::vector<char> content(is_small ? result.bytes : Fingerprint::kPartBytes);
  for (std::uint64_t i = 0; i < parts; ++i) {
    const std::uint64_t rest = is_small ? 0 : result.bytes - Fingerprint::kPartBytes;
    const std::uint64_t begin = i + 1 == parts ? rest : rest / parts * i;
    file.seekg(static_cast<std::streamoff>(begin));
    file.read(content.data(), static_cast<std::streamsize>(content.size()));
    const auto size = static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0));
    file.clear();
    result.parts.push_back({begin, hex(XXH3_64bits(content.data(), size))});
  }
  return result;
}

}  // namespace delray::files
