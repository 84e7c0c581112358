#include "files/atomic_file.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include "files/error.h"

namespace delray::files {
namespace {

// The file that is written beside `path`: hidden, unique to process and call, same suffix (image
// libraries choose the format by it).
std::filesystem::path beside(const std::filesystem::path& path) {
  static std::atomic<unsigned> calls{0};
  const std::string name = "." + path.stem().string() + "." + std::to_string(::getpid()) + "." +
                           std::to_string(calls++) + ".part" + path.extension().string();
  return path.parent_path() / name;
}

void write_all(std::FILE* file, std::string_view content, const std::string& name) {
  const bool whole = std::fwrite(content.data(), 1, content.size(), file) == content.size();
  if (!whole || std::fflush(file) != 0) {
    throw FileError(Cause::device, name, "", std::string("cannot write: ") + std::strerror(errno));
  }
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path path)
    : path_(std::move(path)), temporary_(beside(path_)) {}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  if (!committed_) std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::commit() {
  std::error_code error;
  std::filesystem::rename(temporary_, path_, error);
  if (error) throw FileError(Cause::device, path_.string(), "", error.message());
  committed_ = true;
}

void check_folder(const std::filesystem::path& path) {
  if (path.empty() || path == "-") return;
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const auto fail = [&](int error) {
    throw FileError(Cause::device, path.string(), "",
                    std::string("cannot write: ") + std::strerror(error));
  };
  if (::access(folder.c_str(), W_OK | X_OK) != 0) fail(errno);
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored)) fail(ENOTDIR);
  if (std::filesystem::is_directory(path, ignored)) fail(EISDIR);
}

void write_file(const std::filesystem::path& path, std::string_view content) {
  if (path == "-") return write_all(stdout, content, "standard output");
  AtomicFile target(path);
  std::FILE* file = std::fopen(target.temporary().c_str(), "wb");
  if (!file) {
    throw FileError(Cause::device, path.string(), "",
                    std::string("cannot write: ") + std::strerror(errno));
  }
  try {
    write_all(file, content, path.string());
  } catch (...) {
    std::fclose(file);
    throw;
  }
  if (std::fclose(file) != 0) {
    throw FileError(Cause::device, path.string(), "", std::strerror(errno));
  }
  target.commit();
}

}  // namespace delray::files
