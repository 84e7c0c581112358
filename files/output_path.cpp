// Resolves the names of outputs link by link, so that no link is followed unseen.
#include "files/output_path.h"

#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <deque>
#include <string>

#include "files/error.h"

namespace delray::files {
namespace {

namespace fs = std::filesystem;

constexpr int kMostLinks = 40;  // as Linux
constexpr long kProcMagic = 0x9fa0;

[[noreturn]] void fail(const fs::path& path, const std::string& why) {
  throw FileError(Cause::device, path.string(), "", "cannot write: " + why);
}

const char* folder_name(const fs::path& folder) { return folder.empty() ? "." : folder.c_str(); }

// Whether somebody else may have put an entry there for us to fall over.
bool may_be_planted(const fs::path& folder, const struct stat& entry) {
  struct stat status {};
  if (::stat(folder_name(folder), &status) != 0) return true;
  return (status.st_mode & S_IWOTH) != 0 && entry.st_uid != ::geteuid() &&
         entry.st_uid != status.st_uid;
}

// Links in /proc/PID/fd lead to open files, whatever they say.
bool leads_to_open_file(const fs::path& folder) {
  struct statfs status {};
  return ::statfs(folder_name(folder), &status) == 0 && status.f_type == kProcMagic &&
         folder.filename() == "fd";
}

std::optional<int> own_descriptor(const fs::path& folder, const std::string& name) {
  if (folder.parent_path().filename() != std::to_string(::getpid())) return {};
  int descriptor = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), descriptor);
  if (error != std::errc() || end != name.data() + name.size()) return {};
  return descriptor;
}

fs::path target_of(const fs::path& path, const fs::path& link) {
  std::error_code error;
  fs::path target = fs::read_symlink(link, error);
  if (error) fail(path, error.message());
  return target;
}

// `path` without links, but for those to open files; its last name may be new.
OutputPath resolve(const fs::path& path) {
  OutputPath result;
  fs::path& folder = result.path;
  std::deque<fs::path> rest(path.begin(), path.end());
  for (int links = 0; !rest.empty();) {
    const fs::path name = rest.front();
    rest.pop_front();
    if (name.is_absolute() || name == ".." || name == "." || name.empty()) {
      folder /= name;
      continue;
    }
    struct stat entry {};
    if (::lstat((folder / name).c_str(), &entry) != 0) {
      if (errno != ENOENT || !rest.empty()) fail(path, std::strerror(errno));
    } else if (S_ISLNK(entry.st_mode)) {
      if (may_be_planted(folder, entry)) {
        fail(path, (folder / name).string() +
                       " is a link that another user made in a folder that is open to all");
      }
      if (++links > kMostLinks) fail(path, std::strerror(ELOOP));
      if (!leads_to_open_file(folder)) {
        const fs::path target = target_of(path, folder / name);
        rest.insert(rest.begin(), target.begin(), target.end());
        if (target.is_absolute()) folder.clear();
        continue;
      }
      result.in_place = rest.empty();
      result.descriptor = own_descriptor(folder, name.string());
    }
    folder /= name;
  }
  return result;
}

bool is_same(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

bool read_status(const NamedFile& file, struct stat& status) {
  if (file.path == "-") return ::fstat(file.stream, &status) == 0;
  return ::stat(file.path.c_str(), &status) == 0;
}

}  // namespace

OutputPath output_path(const fs::path& path) {
  if (path == "-") return {path, true, STDOUT_FILENO, {}, {}, {}};
  if (path.empty()) fail(path, std::strerror(ENOENT));
  OutputPath result = resolve(path);
  struct stat status {};
  if (::stat(result.path.c_str(), &status) != 0) {
    if (errno != ENOENT || !result.path.has_filename()) fail(path, std::strerror(errno));
    return result;
  }
  if (S_ISDIR(status.st_mode)) fail(path, std::strerror(EISDIR));
  if (::access(result.path.c_str(), W_OK) != 0 && !result.descriptor) {
    fail(path, std::strerror(errno));
  }
  if (result.in_place) return result;
  const bool planted = may_be_planted(result.path.parent_path(), status);
  result.in_place = !S_ISREG(status.st_mode);
  if (result.in_place && planted) {
    fail(path, "it was made by another user in a folder that is open to all");
  }
  if (!result.in_place && !planted) {
    result.mode = status.st_mode & static_cast<mode_t>(S_IRWXU | S_IRWXG | S_IRWXO);
    result.owner = status.st_uid;
    result.group = status.st_gid;
  }
  return result;
}

fs::path output_folder(const fs::path& path) {
  const fs::path named = path.has_filename() ? path : path.parent_path();
  if (named.empty()) fail(path, std::strerror(ENOENT));
  const fs::path folder = resolve(named).path;
  struct stat status {};
  const bool exists = ::stat(folder.c_str(), &status) == 0;
  if (!folder.has_filename() || (!exists && errno != ENOENT)) {
    fail(path, std::strerror(exists ? EBUSY : errno));
  }
  if (exists && !S_ISDIR(status.st_mode)) fail(path, std::strerror(ENOTDIR));
  if (exists && may_be_planted(folder.parent_path(), status)) {
    fail(path, "it was made by another user in a folder that is open to all");
  }
  if (::access(folder_name(folder.parent_path()), W_OK | X_OK) != 0) {
    fail(path, std::strerror(errno));
  }
  return folder;
}

void check_writable(const fs::path& path) {
  if (path.empty()) return;
  const OutputPath target = output_path(path);
  if (target.in_place) return;
  const fs::path folder = target.path.parent_path();
  if (::access(folder_name(folder), W_OK | X_OK) != 0) fail(path, std::strerror(errno));
}

bool is_same_file(const NamedFile& a, const NamedFile& b) {
  struct stat of_a {
  }, of_b{};
  const bool has_a = read_status(a, of_a), has_b = read_status(b, of_b);
  if (has_a != has_b) return false;
  if (has_a) return S_ISREG(of_a.st_mode) && is_same(of_a, of_b);
  if (a.path.filename() != b.path.filename()) return false;
  return ::stat(folder_name(a.path.parent_path()), &of_a) == 0 &&
         ::stat(folder_name(b.path.parent_path()), &of_b) == 0 && is_same(of_a, of_b);
}

}  // namespace delray::files
