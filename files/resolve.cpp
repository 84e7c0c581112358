// Symbolic links are resolved first, then paths are compared part by part: neither "..", nor links,
// nor a folder whose name begins with that of the allowed one lead out of it.
#include "files/resolve.h"

#include <algorithm>

#include "files/error.h"

namespace delray::files {
namespace {

bool lies_in(const std::filesystem::path& folder, const std::filesystem::path& path) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
         folder.end();
}

}  // namespace

std::filesystem::path resolve(const std::filesystem::path& folder, const std::string& name,
                              Outside outside) {
  const auto fail = [&](const std::string& what) {
    throw FileError(Cause::input, name.empty() ? "''" : name, "", what);
  };
  if (name.empty() || name.find('\0') != std::string::npos) fail("is not the name of a file");
  std::string portable = name;
  std::replace(portable.begin(), portable.end(), '\\', '/');
  std::error_code error;
  const std::filesystem::path root =
      std::filesystem::canonical(folder.empty() ? "." : folder, error);
  if (error) fail(error.message());
  const std::filesystem::path path = std::filesystem::canonical(root / portable, error);
  if (error) fail(error.message());
  if (!std::filesystem::is_regular_file(path, error)) fail("is not a regular file");
  if (outside == Outside::refused && !lies_in(root, path)) {
    fail("lies outside of the folder of the file that names it; --allow-outside lets it be read");
  }
  return path;
}

}  // namespace delray::files
