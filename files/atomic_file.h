// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>

namespace delray::files {

// A name beside `path`, with the same suffix, that a writer fills and then commits. Not committed,
// or destroyed by an exception, the temporary file is removed and `path` stays as it was.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& temporary() const { return temporary_; }
  // Renames the temporary file to `path`; throws FileError (device) where that fails.
  void commit();

 private:
  std::filesystem::path path_, temporary_;
  bool committed_ = false;
};

// Throws the FileError (device) that writing `path` would throw for its folder, before the work
// that makes the content; "-" and an empty path are fine.
void check_folder(const std::filesystem::path& path);

// Writes `content` to `path` whole or not at all; "-" is standard output. Throws FileError
// (device).
void write_file(const std::filesystem::path& path, std::string_view content);

}  // namespace delray::files
