// A temporary file beside the path, opened by its name in each process.
#include "delaunay/pieces/mesh_file_target.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "files/error.h"

namespace delray::delaunay::internal {

MeshFileTarget::MeshFileTarget(const std::filesystem::path& path, bool is_first) : path_(path) {
  if (is_first) file_.emplace(path);
}

MeshFileTarget::~MeshFileTarget() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void MeshFileTarget::fail(int error) const {
  throw files::FileError(files::Cause::device, is_stream() ? "standard output" : path_.string(), "",
                         std::string("cannot write: ") + std::strerror(error));
}

std::string MeshFileTarget::prepare(std::uint64_t bytes) {
  if (is_stream()) return {};
  const std::string name = file_->temporary().string();
  open(name);
  // A full disk shows now rather than in the end; not every file system can tell.
  while (::fallocate(descriptor_, 0, 0, static_cast<off_t>(bytes)) != 0) {
    if (errno == EINTR) continue;
    if (errno == ENOSPC || errno == EFBIG || errno == EDQUOT) fail(errno);
    break;
  }
  return name;
}

void MeshFileTarget::open(const std::string& name) {
  if (is_stream() || descriptor_ >= 0) return;
  descriptor_ = ::open(name.c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC);
  if (descriptor_ < 0) fail(errno);
}

void MeshFileTarget::write(std::uint64_t offset, std::string_view bytes) {
  if (is_stream()) return file_->write(bytes);
  while (!bytes.empty()) {
    const ssize_t moved =
        ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (moved < 0 && errno == EINTR) continue;
    if (moved <= 0) fail(moved < 0 ? errno : ENOSPC);
    bytes.remove_prefix(static_cast<std::size_t>(moved));
    offset += static_cast<std::uint64_t>(moved);
  }
}

void MeshFileTarget::complete() {
  if (descriptor_ < 0) return;
  if (::fsync(descriptor_) != 0 && errno != EINVAL) fail(errno);
  if (::close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR) fail(errno);
}

}  // namespace delray::delaunay::internal
