// Fills a folder beside, then renames; a folder that is replaced changes names with it in one step
// (renameat2(2)). A lock (flock(2)) on the folder keeps other runs out and ends with the process.
#include "files/atomic_folder.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <utility>

#include "files/error.h"
#include "files/output_path.h"

namespace delray::files {
namespace {

namespace fs = std::filesystem;

bool is_same(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

fs::path parent_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

}  // namespace

AtomicFolder::AtomicFolder(fs::path path, Options options)
    : path_(std::move(path)), target_(output_folder(path_)), options_(std::move(options)) {
  const bool joins = options_.unfinished == Unfinished::joined;
  if (!joins) check_replaceable();
  keep_ = joins;
  temporary_ = parent_of(target_) / ("." + target_.filename().string() + ".delray-part");
  constexpr int kAttempts = 4;  // another run may remove its own between two of our steps
  for (int attempt = 0; attempt < kAttempts && !open_partial(); ++attempt) {
  }
  if (descriptor_ < 0) fail(EBUSY);
  if (options_.unfinished != Unfinished::removed) return;
  if (const std::string foreign = foreign_to_unfinished(); !foreign.empty()) {
    ::close(descriptor_);
    fail(temporary_.string() + ", where it would be made, has other files, such as " + foreign);
  }
  remove_all(descriptor_);
}

AtomicFolder::~AtomicFolder() {
  if (descriptor_ < 0) return;
  if (!committed_ && !keep_) {
    try {
      remove_all(descriptor_);
    } catch (const FileError&) {  // what cannot be removed stays
    }
    ::rmdir(temporary_.c_str());
  }
  ::close(descriptor_);
}

void AtomicFolder::fail(const std::string& why) const {
  throw FileError(Cause::device, path_.string(), "", "cannot write: " + why);
}
void AtomicFolder::fail(int error) const { fail(std::strerror(error)); }

// Makes or opens the folder and locks it; false if it was removed meanwhile.
bool AtomicFolder::open_partial() {
  const bool joins = options_.unfinished == Unfinished::joined;
  if (!joins && ::mkdir(temporary_.c_str(), 0777) != 0 && errno != EEXIST) fail(errno);
  const int folder = ::open(temporary_.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (folder < 0) {
    if (errno == ENOENT) return false;
    fail(temporary_.string() + ": " + std::strerror(errno));
  }
  struct stat mine {
  }, named{};
  const bool locked = joins || ::flock(folder, LOCK_EX | LOCK_NB) == 0;
  if (!locked || ::fstat(folder, &mine) != 0) {
    ::close(folder);
    fail("another run is at work on it, in " + temporary_.string());
  }
  if (mine.st_uid != ::geteuid() || (mine.st_mode & S_IWOTH) != 0) {
    ::close(folder);
    fail(temporary_.string() + " is another user's, or open to all");
  }
  if (::lstat(temporary_.c_str(), &named) != 0 || !is_same(mine, named)) {
    ::close(folder);
    return false;
  }
  descriptor_ = folder;
  return true;
}

std::vector<std::string> AtomicFolder::names_in(int folder) const {
  const int copy = ::openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const std::unique_ptr<DIR, int (*)(DIR*)> entries(copy < 0 ? nullptr : ::fdopendir(copy),
                                                    &::closedir);
  if (!entries) fail(errno);
  std::vector<std::string> names;
  while (const dirent* entry = ::readdir(entries.get())) {
    const std::string name = entry->d_name;
    if (name != "." && name != "..") names.push_back(name);
  }
  std::ranges::sort(names);
  return names;
}

std::vector<std::string> AtomicFolder::names() const { return names_in(descriptor_); }

// A file of the unfinished folder that no run has made, or nothing.
std::string AtomicFolder::foreign_to_unfinished() const {
  for (const std::string& name : names()) {
    const bool is_temporary = options_.is_temporary != nullptr && options_.is_temporary(name);
    if (name != options_.index && !options_.is_own(name) && !is_temporary) return name;
  }
  return {};
}

void AtomicFolder::check_replaceable() const {
  const int folder = ::open(target_.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (folder < 0) {
    if (errno == ENOENT) return;
    fail(errno);
  }
  const std::vector<std::string> present = names_in(folder);
  ::close(folder);
  const auto is_foreign = [&](const std::string& name) {
    return name != options_.index && !options_.is_own(name);
  };
  auto foreign = std::ranges::find_if(present, is_foreign);
  if (foreign == present.end() && !present.empty() &&
      std::ranges::find(present, options_.index) == present.end()) {
    foreign = present.begin();
  }
  if (foreign != present.end()) {
    fail("the folder has other files, such as " + *foreign + "; name a new or empty one");
  }
}

// Files only: a folder in it is not ours.
void AtomicFolder::remove_all(int folder) const {
  for (const std::string& name : names_in(folder)) {
    if (::unlinkat(folder, name.c_str(), 0) != 0) fail(name + ": " + std::strerror(errno));
  }
}

int AtomicFolder::create(const std::string& name) const {
  const int file = ::openat(descriptor_, name.c_str(),
                            O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (file < 0) fail(name + ": " + std::strerror(errno));
  return file;
}

int AtomicFolder::append(const std::string& name) const {
  const int file = ::openat(descriptor_, name.c_str(),
                            O_RDWR | O_APPEND | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (file < 0) fail(name + ": " + std::strerror(errno));
  return file;
}

void AtomicFolder::rename(const std::string& from, const std::string& to) const {
  if (::renameat(descriptor_, from.c_str(), descriptor_, to.c_str()) != 0) fail(errno);
}

void AtomicFolder::remove(const std::string& name) const {
  if (::unlinkat(descriptor_, name.c_str(), 0) != 0) fail(name + ": " + std::strerror(errno));
}

void AtomicFolder::commit() {
  // Everything of the file system at once: one wait instead of one for each piece.
  if (::syncfs(descriptor_) != 0) fail(errno);
  struct stat mine {
  }, named{};
  if (::fstat(descriptor_, &mine) != 0 || ::lstat(temporary_.c_str(), &named) != 0) fail(errno);
  if (!is_same(mine, named)) fail(ESTALE);
  check_replaceable();
  const int old = ::open(target_.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  const auto change = [&](unsigned how) {
    return ::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, target_.c_str(), how) == 0;
  };
  const bool changed = change(old < 0 ? RENAME_NOREPLACE : RENAME_EXCHANGE);
  const int error = errno;
  if (changed && old >= 0) {
    remove_all(old);
    ::rmdir(temporary_.c_str());
  }
  if (old >= 0) ::close(old);
  // File systems without these steps: rename(2) replaces an empty folder at most.
  if (!changed && (error != EINVAL || std::rename(temporary_.c_str(), target_.c_str()) != 0)) {
    fail(changed ? errno : error);
  }
  committed_ = true;
}

}  // namespace delray::files
