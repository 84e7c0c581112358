// .poly, numbered from 0 (see read_poly.cpp). A height is the first attribute of a point.
#include "delaunay/files/output.h"
#include "delaunay/outline.h"

namespace delray::delaunay {

void write_outline(const std::filesystem::path& path, const Outline& outline) {
  Output output(path);
  const PointCloud& points = outline.points;
  const int columns = points.has_z ? 3 : 2;
  output.write(std::to_string(points.size()) + " 2 " + std::to_string(columns - 2) + " 0\n");
  write_rows(output, points.size(), [&](std::size_t i, std::string& row) {
    append_number(row, std::uint64_t{i});
    for (int k = 0; k < columns; ++k) {
      row += ' ';
      append_number(row, points.positions[i][k]);
    }
    row += '\n';
  });
  output.write(std::to_string(outline.segments.size()) + " 0\n");
  write_rows(output, outline.segments.size(), [&](std::size_t i, std::string& row) {
    append_number(row, std::uint64_t{i});
    for (const std::uint32_t end : outline.segments[i]) {
      row += ' ';
      append_number(row, std::uint64_t{end});
    }
    row += '\n';
  });
  output.write(std::to_string(outline.holes.size()) + "\n");
  write_rows(output, outline.holes.size(), [&](std::size_t i, std::string& row) {
    append_number(row, std::uint64_t{i});
    for (int k = 0; k < 2; ++k) {
      row += ' ';
      append_number(row, outline.holes[i][k]);
    }
    row += '\n';
  });
  output.close();
  output.commit();
}

}  // namespace delray::delaunay
