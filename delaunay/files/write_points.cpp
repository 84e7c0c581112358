// The table of point writers, chosen by suffix, and the writers of plain text: XYZ, CSV and JSON.
// PLY, OBJ and OFF are written by their mesh writers as meshes without simplices.
#include "delaunay/write_points.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <stdexcept>
#include <string>

#include "delaunay/files/mesh_writers.h"
#include "delaunay/files/output.h"
#include "delaunay/mesh/arguments.h"

namespace delray::delaunay {
namespace {

template <void (*kWriter)(const std::filesystem::path&, const MeshView&)>
void without_simplices(const std::filesystem::path& path, const PointCloud& points) {
  kWriter(path, {points, 3, {}});
}

constexpr std::array kPointWriters = {
    PointWriter{"XYZ", "text, coordinates separated by blanks", ".xyz .txt", &write_xyz},
    PointWriter{"CSV", "text, with a line of column names and all attributes", ".csv", &write_csv},
    PointWriter{"PLY", "binary, coordinates as double, with colours", ".ply",
                &without_simplices<write_ply>},
    PointWriter{"JSON", "[[x, y], ...] or [[x, y, z], ...]", ".json", &write_json},
    PointWriter{"OBJ", "Wavefront vertices, text", ".obj", &without_simplices<write_obj>},
    PointWriter{"OFF", "object file, text", ".off", &without_simplices<write_off>},
    PointWriter{"NODE", "points of Triangle and TetGen, text", ".node", &write_node_points},
};

// Whether `suffix` is one of the words of `suffixes`.
bool lists(std::string_view suffixes, std::string suffix) {
  std::ranges::transform(suffix, suffix.begin(), [](unsigned char c) { return std::tolower(c); });
  while (!suffixes.empty()) {
    const std::string_view word = suffixes.substr(0, suffixes.find(' '));
    if (word == suffix) return true;
    suffixes.remove_prefix(std::min(word.size() + 1, suffixes.size()));
  }
  return false;
}

// Appends the coordinates of point i with `separator` between them.
void append_position(std::string& row, const PointCloud& points, std::size_t i,
                     std::string_view separator) {
  for (int k = 0; k < (points.has_z ? 3 : 2); ++k) {
    if (k > 0) row += separator;
    append_number(row, points.positions[i][k]);
  }
}

}  // namespace

void write_xyz(const std::filesystem::path& path, const PointCloud& points) {
  Output output(path);
  write_rows(output, points.size(), [&](std::size_t i, std::string& row) {
    append_position(row, points, i, " ");
    row += '\n';
  });
  output.close();
  output.commit();
}

void write_csv(const std::filesystem::path& path, const PointCloud& points) {
  const bool colours = !points.colours.empty(), intensity = !points.intensity.empty();
  const bool classes = !points.classification.empty();
  Output output(path);
  output.write(std::string("x,y") + (points.has_z ? ",z" : "") +
               (colours ? ",red,green,blue" : "") + (intensity ? ",intensity" : "") +
               (classes ? ",classification" : "") + "\n");
  write_rows(output, points.size(), [&](std::size_t i, std::string& row) {
    append_position(row, points, i, ",");
    for (int k = 0; colours && k < 3; ++k) {
      row += ',';
      append_number(row, std::uint64_t{points.colours[i][k]});
    }
    if (intensity) append_number(row += ',', double{points.intensity[i]});
    if (classes) append_number(row += ',', std::uint64_t{points.classification[i]});
    row += '\n';
  });
  output.close();
  output.commit();
}

void write_json(const std::filesystem::path& path, const PointCloud& points) {
  Output output(path);
  output.write("[");
  write_rows(output, points.size(), [&](std::size_t i, std::string& row) {
    row += i == 0 ? "[" : ",\n[";
    append_position(row, points, i, ", ");
    row += ']';
  });
  output.write("]\n");
  output.close();
  output.commit();
}

std::span<const PointWriter> point_writers() { return kPointWriters; }

const PointWriter& point_writer_for(const std::filesystem::path& path) {
  const std::string suffix = path == "-" ? ".xyz" : path.extension().string();
  for (const PointWriter& writer : kPointWriters) {
    if (lists(writer.suffixes, suffix)) return writer;
  }
  throw std::invalid_argument(path.string() + ": no point format has the suffix \"" + suffix +
                              "\"; legal are " + known_suffixes(kPointWriters));
}

void write_points(const std::filesystem::path& path, const PointCloud& points) {
  internal::check_attributes(points);
  point_writer_for(path).write(path, points);
}

}  // namespace delray::delaunay
