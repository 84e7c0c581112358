// Ranges by pread: any number of threads, and no open file between the calls, as an input may be
// thousands of files.
#include "files/file_bytes.h"

#include <span>
#include <system_error>

#include "files/error.h"
#include "files/read_file.h"

namespace delray::files {

FileBytes::FileBytes(const std::filesystem::path& path, const MemoryBudget& memory)
    : name_(path.string()), path_(path), memory_(memory) {
  std::error_code error;
  size_ = std::filesystem::file_size(path, error);
  if (error) throw FileError(Cause::input, name_, "", error.message());
}

std::string_view FileBytes::read(std::uint64_t begin, std::uint64_t size,
                                 std::string& buffer) const {
  if (path_.empty()) return content_.substr(begin, size);
  constexpr std::uint64_t kLarge = std::uint64_t{1} << 26;  // more than a part usually has
  if (size > kLarge) memory_.require(size, name_);
  buffer.resize(size);
  read_range(path_, begin, std::span(buffer.data(), buffer.size()));
  return buffer;
}

}  // namespace delray::files
