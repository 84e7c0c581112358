#include "files/read_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "files/error.h"

namespace delray::files {
namespace {

constexpr std::size_t kChunk = std::size_t{1} << 20;  // one read; large enough to amortise the call

std::string read_up_to(const std::filesystem::path& path, std::size_t limit) {
  const bool standard_input = path == "-";
  const std::string name = standard_input ? "standard input" : path.string();
  std::error_code ignored;
  if (!standard_input && std::filesystem::is_directory(path, ignored)) {
    throw FileError(Cause::input, name, "", "is a folder, not a file");
  }
  std::FILE* file = standard_input ? stdin : std::fopen(path.c_str(), "rb");
  if (!file) throw FileError(Cause::input, name, "", std::strerror(errno));
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> closer(standard_input ? nullptr : file,
                                                               &std::fclose);
  std::string content;
  const std::uintmax_t size = standard_input ? 0 : std::filesystem::file_size(path, ignored);
  if (!ignored) content.reserve(std::min<std::uintmax_t>(size, limit));
  while (content.size() < limit) {
    const std::size_t old = content.size();
    content.resize(old + std::min(kChunk, limit - old));
    const std::size_t got = std::fread(content.data() + old, 1, content.size() - old, file);
    content.resize(old + got);
    if (got == 0) break;
  }
  if (std::ferror(file)) {
    throw FileError(Cause::device, name, "byte " + std::to_string(content.size()),
                    std::strerror(errno));
  }
  return content;
}

}  // namespace

std::string read_file(const std::filesystem::path& path) {
  return read_up_to(path, static_cast<std::size_t>(-1));
}

std::string read_start(const std::filesystem::path& path, std::size_t limit) {
  return read_up_to(path, limit);
}

}  // namespace delray::files
