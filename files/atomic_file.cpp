// Writes beside, then renames: the name never leads to half a file, not even after a power failure.
#include "files/atomic_file.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "files/error.h"

namespace delray::files {
namespace {

constexpr int kAttempts = 16;  // names are 64 random bits: one is enough but for broken machines
constexpr std::size_t kLongestSuffix = 16;                // longer ones are no format's
constexpr std::size_t kCopyChunk = std::size_t{1} << 20;  // of a copy

// Hidden; with the suffix of `path`, as image libraries choose the format by it.
std::string random_name(const std::filesystem::path& path) {
  std::uint64_t number = 0;
  if (::getrandom(&number, sizeof number, 0) != sizeof number) return {};
  std::string suffix = path.extension().string();
  if (suffix.size() > kLongestSuffix) suffix.clear();
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(number));
  return ".delray-" + std::string(digits) + ".part" + suffix;
}

// Permissions and, where the system lets us, owner of what is replaced.
void take_over(int descriptor, const OutputPath& target) {
  if (!target.mode) return;
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) return;
  if (status.st_uid != *target.owner || status.st_gid != *target.group) {
    [[maybe_unused]] const int ignored = ::fchown(descriptor, *target.owner, *target.group);
  }
  [[maybe_unused]] const int ignored = ::fchmod(descriptor, *target.mode);
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path path)
    : path_(std::move(path)), target_(output_path(path_)) {
  if (!target_.in_place) create(target_.path.parent_path());
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  std::error_code ignored;
  if (!committed_ && !temporary_.empty()) std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::fail(int error) const {
  throw FileError(Cause::device, path_ == "-" ? "standard output" : path_.string(), "",
                  std::string("cannot write: ") + std::strerror(error));
}

void AtomicFile::create(const std::filesystem::path& folder) {
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const std::filesystem::path name = folder / random_name(target_.path);
    descriptor_ = ::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (descriptor_ >= 0) {
      temporary_ = name;
      return take_over(descriptor_, target_);
    }
    if (errno != EEXIST) break;
  }
  fail(errno);
}

void AtomicFile::open_in_place() {
  std::fflush(stdout);  // what comes before it
  if (target_.descriptor) {
    descriptor_ = ::fcntl(*target_.descriptor, F_DUPFD_CLOEXEC, 3);
  } else {
    descriptor_ = ::open(target_.path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
  }
  if (descriptor_ < 0) fail(errno);
}

void AtomicFile::write_to(int descriptor, std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno == EAGAIN) {  // a terminal or pipe that somebody has set to not wait
      pollfd wait{descriptor, POLLOUT, 0};
      ::poll(&wait, 1, -1);
    } else if (errno != EINTR) {
      fail(errno);
    }
  }
}

void AtomicFile::write(std::string_view bytes) {
  if (descriptor_ < 0) open_in_place();
  write_to(descriptor_, bytes);
}

void AtomicFile::read_back(std::uint64_t begin, std::span<char> bytes) const {
  while (!bytes.empty()) {
    const ssize_t got = ::pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(begin));
    if (got == 0) fail(EIO);
    if (got < 0 && errno != EINTR) fail(errno);
    if (got <= 0) continue;
    begin += static_cast<std::uint64_t>(got);
    bytes = bytes.subspan(static_cast<std::size_t>(got));
  }
}

const std::filesystem::path& AtomicFile::temporary() {
  if (!temporary_.empty()) return temporary_;
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  if (error) fail(error.value());
  create(folder);
  return temporary_;
}

void AtomicFile::copy_in_place() {
  const int from = std::exchange(descriptor_, -1);
  open_in_place();
  std::vector<char> chunk(kCopyChunk);
  off_t at = 0;
  ssize_t got = 0;
  while ((got = ::pread(from, chunk.data(), chunk.size(), at)) > 0) {
    write_to(descriptor_, {chunk.data(), static_cast<std::size_t>(got)});
    at += got;
  }
  const int error = errno;
  ::close(from);
  if (got < 0) fail(error);
}

void AtomicFile::close() {
  if (descriptor_ >= 0 && ::close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR) {
    fail(errno);
  }
}

void AtomicFile::complete() {
  if (completed_) return;
  // Pipes and terminals have no disk to wait for.
  if (!target_.in_place && ::fsync(descriptor_) != 0 && errno != EINVAL) fail(errno);
  completed_ = true;
}

void AtomicFile::commit() {
  complete();
  if (target_.in_place) {
    if (!temporary_.empty()) copy_in_place();
    return close();
  }
  struct stat mine {
  }, named{};
  if (::fstat(descriptor_, &mine) != 0 || ::lstat(temporary_.c_str(), &named) != 0) fail(errno);
  // Where everybody can write, somebody may have put another file in its place.
  if (mine.st_dev != named.st_dev || mine.st_ino != named.st_ino) fail(ESTALE);
  if (std::rename(temporary_.c_str(), target_.path.c_str()) != 0) fail(errno);
  committed_ = true;
  close();
}

void write_file(const std::filesystem::path& path, std::string_view content) {
  AtomicFile file(path);
  file.write(content);
  file.commit();
}

}  // namespace delray::files
