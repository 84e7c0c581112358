// Files that only this program reads again: every failure names the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace delray::delaunay {

// All throw files::FileError (device).
class ScratchFile {
 public:
  enum class Mode : std::uint8_t { read, append, replace };

  ScratchFile(std::filesystem::path path, Mode mode);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  // One behind the other, by one call where the system does not cut it.
  void write(std::span<const std::byte> bytes, std::span<const std::byte> more = {});
  // REQUIRES: Mode::read.
  std::uint64_t size() const;
  // False if the file ends before.
  bool read(std::uint64_t offset, std::span<std::byte> bytes) const;
  [[noreturn]] void fail(const std::string& what) const;

 private:
  [[noreturn]] void fail_with_error(const char* doing) const;

  std::filesystem::path path_;
  int descriptor_ = -1;
};

std::uint64_t check_sum(std::span<const std::byte> bytes);

}  // namespace delray::delaunay
