// Files that appear whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

#include "files/output_path.h"

namespace delray::files {

// A file beside `path`, with the same suffix and a name that nobody can foresee, that a writer
// fills and then commits. Not committed, or destroyed by an exception, it is removed and `path`
// stays as it was. It has the permissions of the file that it replaces, else those of the umask.
//
// A file that cannot be replaced (OutputPath::in_place; "-" is standard output) is written as it
// is: the bytes of write() at once, those of a temporary file, which then lies in the folder for
// such files, on commit.
//
// Everything throws FileError (device), naming `path`.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // Appends; a call costs a system call. Not together with temporary().
  void write(std::string_view bytes);
  // Fills `bytes` with what was written from `begin` on. Any thread, while nobody writes. REQUIRES:
  // so much was written, and not in place.
  void read_back(std::uint64_t begin, std::span<char> bytes) const;
  // Whether it is written as it is.
  bool is_in_place() const { return target_.in_place; }
  // The name of the temporary file, for those who open it themselves.
  const std::filesystem::path& temporary();
  // After the last byte: everything has reached the disk, and only the name is missing.
  void complete();
  // Completes the file and gives it its name.
  void commit();

 private:
  [[noreturn]] void fail(int error) const;
  void create(const std::filesystem::path& folder);
  void open_in_place();
  void copy_in_place();
  void close();
  void write_to(int descriptor, std::string_view bytes) const;

  std::filesystem::path path_, temporary_;  // as the user named it; empty while there is none
  OutputPath target_;
  int descriptor_ = -1;  // of what write() appends to
  bool completed_ = false, committed_ = false;
};

// Writes `content` to `path` whole or not at all; "-" is standard output. Throws FileError
// (device).
void write_file(const std::filesystem::path& path, std::string_view content);

}  // namespace delray::files
