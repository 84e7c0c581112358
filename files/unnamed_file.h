// Scratch files that nobody else can open and that end with the process, however that ends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace delray::files {

// Any thread may read and write, at any offset. Everything throws FileError (device), naming the
// folder.
class UnnamedFile {
 public:
  // In `folder`, or that of the system where it is empty; `what` it is for messages.
  UnnamedFile(std::filesystem::path folder, std::string what);
  ~UnnamedFile();
  UnnamedFile(const UnnamedFile&) = delete;
  UnnamedFile& operator=(const UnnamedFile&) = delete;

  void write(std::uint64_t offset, std::span<const std::byte> bytes) const;
  // What was never written counts as the end of the file, which is an error.
  void read(std::uint64_t offset, std::span<std::byte> bytes) const;

 private:
  [[noreturn]] void fail(const char* doing, int error) const;

  std::filesystem::path folder_;
  std::string what_;
  int descriptor_ = -1;
};

}  // namespace delray::files
