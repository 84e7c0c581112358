#include "delaunay/read_points.h"

#include <array>
#include <string>

#include "delaunay/internal/point_readers.h"
#include "files/read_file.h"

namespace delray::delaunay {
namespace {

using files::Format;

constexpr std::array kReaders = {
    PointReader{Format::text, "XYZ", "rows of numbers: x y [z], or columns named in a first line",
                ".xyz .csv .txt .tsv .asc .pts", &read_text_points},
    PointReader{Format::ply, "PLY", "ASCII or binary, with or without faces", ".ply",
                &read_ply_points},
    PointReader{Format::obj, "OBJ", "the vertices of a Wavefront model", ".obj", &read_obj_points},
    PointReader{Format::off, "OFF", "the vertices of an object file", ".off", &read_off_points},
    PointReader{Format::las, "LAS", "LiDAR, versions 1.0 to 1.4, not compressed", ".las",
                &read_las_points},
    PointReader{Format::json_points, "JSON", "[[x, y], ...] or [[x, y, z], ...]", ".json",
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

PointCloud read_points(const std::filesystem::path& name, const ReadOptions& options) {
  // The points of a mesh in two files are in the other one.
  const std::filesystem::path path =
      name.extension() == ".ele" ? std::filesystem::path(name).replace_extension(".node") : name;
  const std::string content = files::read_file(path);
  const Input input{path == "-" ? "standard input" : path.string(), content};
  if (content.empty()) fail(input, "", "the file is empty");
  constexpr std::size_t kStart = std::size_t{1} << 16;
  const std::string_view start = std::string_view(content).substr(0, kStart);
  Format format = options.format;
  if (format == Format::unknown) format = files::identify(start, content.size(), path).format;
  for (const PointReader& reader : kReaders) {
    if (reader.format != format) continue;
    PointCloud cloud = reader.read(input);
    if (cloud.size() == 0) fail(input, "", "no points");
    return cloud;
  }
  fail(input, "", "not a file of points; known formats: " + known_formats());
}

}  // namespace delray::delaunay
