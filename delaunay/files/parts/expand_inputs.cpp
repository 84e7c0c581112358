// The files that inputs stand for: of folders those with a suffix of a reader of points, of
// patterns those that match, both in the order of their names. Texts of a folder may be notes
// beside the points: whether the first rows are points decides.
#include <algorithm>
#include <string>
#include <string_view>

#include "delaunay/files/line_ends.h"
#include "delaunay/files/point_readers.h"
#include "delaunay/files/text_layout.h"
#include "delaunay/open_points.h"
#include "files/error.h"
#include "files/read_file.h"

namespace delray::delaunay {
namespace {

namespace fs = std::filesystem;

// Whether `name` is `pattern` with * for any characters and ? for one. O(pattern name).
bool matches(std::string_view pattern, std::string_view name) {
  std::size_t p = 0, n = 0;
  std::size_t star = std::string_view::npos, after = 0;  // where to go on if what follows * fails
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      after = n;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n])) {
      ++p;
      ++n;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      n = ++after;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

bool has_point_suffix(const fs::path& path) {
  const files::Format format = files::format_of_suffix(path);
  return path.extension() != ".ele" &&
         std::ranges::find(kPointReaders, format, &PointReader::format) != kPointReaders.end();
}

// Whether a file whose format has no mark of its own begins as points do. One that cannot be read
// does: its reader says why.
bool begins_as_points(const fs::path& path) {
  constexpr std::size_t kStart = 1 << 16;
  const files::Format format = files::format_of_suffix(path);
  if (format != files::Format::text && format != files::Format::json_points) return true;
  std::string start;
  try {
    start = files::read_start(path, kStart);
  } catch (const files::FileError&) {
    return true;
  }
  if (start.empty()) return true;
  if (format == files::Format::json_points) {
    const std::size_t outer = start.find_first_not_of(" \t\r\n");
    if (outer == std::string::npos || start[outer] != '[') return false;
    const std::size_t inner = start.find_first_not_of(" \t\r\n", outer + 1);
    return inner == std::string::npos || start[inner] == '[' || start[inner] == ']';
  }
  if (start.size() == kStart) start.resize(start.rfind('\n') + 1);
  const std::string lines = with_line_feeds(format, std::move(start));
  return begins_as_points(Input{path.string(), lines});
}

// The files of a folder that `wanted` holds for, by name; those that begin with a dot are hidden.
template <class Wanted>
void add_files(const fs::path& folder, const fs::path& shown, const Wanted& wanted,
               std::vector<fs::path>& files) {
  const std::size_t begin = files.size();
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const fs::path name = at->path().filename();
    std::error_code ignored;
    if (name.native().starts_with('.') || at->is_directory(ignored)) continue;
    if (wanted(name)) files.push_back(shown / name);
  }
  if (error) {
    throw files::FileError(files::Cause::input, folder.string(), "", error.message());
  }
  std::sort(files.begin() + static_cast<std::ptrdiff_t>(begin), files.end());
}

}  // namespace

std::vector<fs::path> left_out_of_folders(std::span<const fs::path> inputs) {
  std::vector<fs::path> files;
  for (const fs::path& input : inputs) {
    std::error_code error;
    if (input == "-" || !fs::is_directory(input, error)) continue;
    add_files(
        input, input,
        [&](const fs::path& name) {
          return has_point_suffix(name) && !begins_as_points(input / name);
        },
        files);
  }
  return files;
}

std::vector<fs::path> expand_inputs(std::span<const fs::path> inputs) {
  std::vector<fs::path> files;
  for (const fs::path& input : inputs) {
    const std::size_t before = files.size();
    std::error_code error;
    if (input != "-" && fs::is_directory(input, error)) {
      add_files(
          input, input,
          [&](const fs::path& name) {
            return has_point_suffix(name) && begins_as_points(input / name);
          },
          files);
      if (files.size() == before) {
        throw files::FileError(files::Cause::input, input.string(), "",
                               left_out_of_folders({&input, 1}).empty()
                                   ? "the folder has no files of points"
                                   : "the folder has texts, but none that begins with points");
      }
      continue;
    }
    const std::string pattern = input.filename().string();
    const bool is_pattern = pattern.find_first_of("*?") != std::string::npos;
    if (input == "-" || !is_pattern || fs::exists(input, error)) {
      files.push_back(input);
      continue;
    }
    const fs::path folder = input.parent_path();
    const auto wanted = [&](const fs::path& name) { return matches(pattern, name.string()); };
    add_files(folder.empty() ? fs::path(".") : folder, folder, wanted, files);
    if (files.size() == before) {
      throw files::FileError(files::Cause::input, input.string(), "",
                             "no file matches the pattern");
    }
  }
  return files;
}

}  // namespace delray::delaunay
