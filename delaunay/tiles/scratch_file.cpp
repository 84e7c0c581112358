// POSIX files, each call repeated until all bytes are through.
#include "delaunay/tiles/scratch_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "files/error.h"

namespace delray::delaunay {

ScratchFile::ScratchFile(std::filesystem::path path, Mode mode) : path_(std::move(path)) {
  constexpr int kModes[] = {O_RDONLY, O_WRONLY | O_CREAT | O_APPEND, O_WRONLY | O_CREAT | O_TRUNC};
  constexpr mode_t kOwnerOnly = 0600;
  descriptor_ =
      ::open(path_.c_str(), kModes[static_cast<int>(mode)] | O_CLOEXEC | O_NOFOLLOW, kOwnerOnly);
  if (descriptor_ < 0) fail_with_error("cannot be opened");
}

ScratchFile::~ScratchFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void ScratchFile::fail(const std::string& what) const {
  throw files::FileError(files::Cause::device, path_.string(), "", what);
}

void ScratchFile::fail_with_error(const char* doing) const {
  const std::string why = std::generic_category().message(errno);
  if (descriptor_ >= 0) ::close(descriptor_);
  throw files::FileError(files::Cause::device, path_.string(), "", std::string(doing) + ": " + why);
}

void ScratchFile::write(std::span<const std::byte> bytes, std::span<const std::byte> more) {
  while (!bytes.empty() || !more.empty()) {
    const iovec pieces[] = {{const_cast<std::byte*>(bytes.data()), bytes.size()},
                            {const_cast<std::byte*>(more.data()), more.size()}};
    const ssize_t written = ::writev(descriptor_, pieces, 2);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail_with_error("cannot be written");
    const std::size_t first = std::min(bytes.size(), static_cast<std::size_t>(written));
    bytes = bytes.subspan(first);
    more = more.subspan(static_cast<std::size_t>(written) - first);
  }
}

std::uint64_t ScratchFile::size() const {
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) fail_with_error("cannot be read");
  return static_cast<std::uint64_t>(status.st_size);
}

bool ScratchFile::read(std::uint64_t offset, std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t got =
        ::pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail_with_error("cannot be read");
    if (got == 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(got));
    offset += static_cast<std::uint64_t>(got);
  }
  return true;
}

std::uint64_t check_sum(std::span<const std::byte> bytes) {
  return XXH3_64bits(bytes.data(), bytes.size());
}

}  // namespace delray::delaunay
