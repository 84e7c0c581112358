// Chooses the reader of a point file from the table in point_readers.h, by the format that the
// caller gives or files::identify_format() finds.
#include "delaunay/read_points.h"

#include <algorithm>
#include <string>

#include "delaunay/files/line_ends.h"
#include "delaunay/files/point_readers.h"
#include "files/read_file.h"

namespace delray::delaunay {
namespace {

using files::Format;

std::string known_formats() {
  std::string list;
  for (const PointReader& reader : kPointReaders) {
    list += (list.empty() ? "" : ", ") + std::string(reader.name);
  }
  return list;
}

}  // namespace

std::span<const PointReader> point_readers() { return kPointReaders; }

PointCloud read_points(const std::filesystem::path& given, const ReadOptions& options) {
  // The points of a mesh in two files are in the other one.
  const std::filesystem::path path =
      given.extension() == ".ele" ? std::filesystem::path(given).replace_extension(".node") : given;
  const std::string name = path == "-" ? "standard input" : path.string();
  if (files::read_start(path, 1, options.memory).empty()) fail({name, ""}, "", "the file is empty");
  Format format = options.format;
  if (format == Format::unknown) format = files::identify_format(path, options.memory);
  const auto reader = std::ranges::find(kPointReaders, format, &PointReader::format);
  // A stream of something else need not be read to its end, if it has one.
  if (reader == kPointReaders.end()) {
    fail({name, ""}, "", "not a file of points; known formats: " + known_formats());
  }
  const std::string content = with_line_feeds(format, files::read_file(path, options.memory));
  const Input input{name, content, options.memory};
  PointCloud cloud = reader->read(input);
  if (cloud.size() == 0) fail(input, "", "no points");
  return cloud;
}

}  // namespace delray::delaunay
