// The file that ranks fill at a time, or a stream.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "comm/communicator.h"
#include "files/atomic_file.h"

namespace delray::delaunay::internal {

// Everything throws FileError (device), naming the path as the user gave it.
class MeshFileTarget {
 public:
  // Of writer 0, which makes the file; others write into the one of that.
  MeshFileTarget(const std::filesystem::path& path, bool is_first);
  ~MeshFileTarget();
  MeshFileTarget(const MeshFileTarget&) = delete;
  MeshFileTarget& operator=(const MeshFileTarget&) = delete;

  bool is_stream() const { return path_ == "-"; }
  // The name to open() on other ranks; makes room for so many bytes. Writer 0 only.
  std::string prepare(std::uint64_t bytes);
  void open(const std::string& name);
  // Any thread. To a stream bytes go in the order of the calls.
  void write(std::uint64_t offset, std::string_view bytes);
  // What was written is on the disk.
  void complete();
  // Writer 0 only.
  void commit() { file_->commit(); }

 private:
  [[noreturn]] void fail(int error) const;

  std::filesystem::path path_;
  std::optional<files::AtomicFile> file_;
  int descriptor_ = -1;
};

}  // namespace delray::delaunay::internal
