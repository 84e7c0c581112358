#include "delaunay/read_points.h"

#include <algorithm>
#include <array>
#include <string>

#include "delaunay/files/point_readers.h"
#include "files/read_file.h"

namespace delray::delaunay {
namespace {

using files::Format;

constexpr std::array kReaders = {
    PointReader{Format::text, "XYZ",
                "points as rows of numbers: x y [z], or columns named in a first line",
                ".xyz .csv .txt .tsv .asc .pts", &read_text_points},
    PointReader{Format::ply, "PLY", "points, ASCII or binary, or the vertices of faces", ".ply",
                &read_ply_points},
    PointReader{Format::obj, "OBJ", "points, or the vertices of a Wavefront model", ".obj",
                &read_obj_points},
    PointReader{Format::off, "OFF", "points, or the vertices of an object file", ".off",
                &read_off_points},
    PointReader{Format::las, "LAS", "LiDAR points, versions 1.0 to 1.4, not compressed", ".las",
                &read_las_points},
    PointReader{Format::json_points, "JSON", "points as [[x, y], ...] or [[x, y, z], ...]", ".json",
                &read_json_points},
    PointReader{Format::node, "NODE", "points of Triangle and TetGen", ".node", &read_node_points},
    PointReader{Format::vtu, "VTU", "the points of an unstructured grid that delray wrote", ".vtu",
                &read_vtu_points},
};

std::string known_formats() {
  std::string list;
  for (const PointReader& reader : kReaders) {
    list += (list.empty() ? "" : ", ") + std::string(reader.name);
  }
  return list;
}

}  // namespace

std::span<const PointReader> point_readers() { return kReaders; }

PointCloud read_points(const std::filesystem::path& given, const ReadOptions& options) {
  // The points of a mesh in two files are in the other one.
  const std::filesystem::path path =
      given.extension() == ".ele" ? std::filesystem::path(given).replace_extension(".node") : given;
  const std::string name = path == "-" ? "standard input" : path.string();
  if (files::read_start(path, 1, options.memory).empty()) fail({name, ""}, "", "the file is empty");
  Format format = options.format;
  if (format == Format::unknown) format = files::identify_format(path, options.memory);
  const auto reader = std::ranges::find(kReaders, format, &PointReader::format);
  // A stream of something else need not be read to its end, if it has one.
  if (reader == kReaders.end()) {
    fail({name, ""}, "", "not a file of points; known formats: " + known_formats());
  }
  const std::string content = files::read_file(path, options.memory);
  const Input input{name, content, options.memory};
  PointCloud cloud = reader->read(input);
  if (cloud.size() == 0) fail(input, "", "no points");
  return cloud;
}

}  // namespace delray::delaunay
