// Vertices without lists lie at known places, so that any run of them is a part.
#include "delaunay/files/parts/ply_parts.h"

#include <algorithm>

#include "delaunay/files/ply_vertices.h"

namespace delray::delaunay {
namespace {

constexpr std::size_t kPlyPartRows = 65536;

class PlyParts : public FileParts {
 public:
  PlyParts(ByteSource source, PlyEncoding encoding, PlyElement element, const PlyColumns& columns,
           std::uint64_t begin)
      : source_(std::move(source)),
        encoding_(encoding),
        element_(std::move(element)),
        columns_(columns),
        begin_(begin) {
    facts_.told.file = source_.name();
    facts_.has_z = columns[kZ] >= 0;
    facts_.has_classes = columns[kClass] >= 0;
    facts_.has_ranges = columns[kIntensity] >= 0;
  }
  void warn(const std::string& warning) { facts_.warnings.push_back(warning); }

  std::size_t parts() const override { return (element_.count + kPlyPartRows - 1) / kPlyPartRows; }
  std::uint64_t most_rows(std::size_t part) const override {
    return std::min(kPlyPartRows, element_.count - part * kPlyPartRows);
  }
  void read(std::size_t part, PartPoints& points) const override {
    const std::size_t first = part * kPlyPartRows, stride = element_.smallest_row();
    const auto rows = static_cast<std::size_t>(most_rows(part));
    std::string buffer;
    const std::string_view bytes =
        source_.read(begin_ + std::uint64_t{first} * stride, std::uint64_t{rows} * stride, buffer);
    PlyVertices vertices(element_, columns_, rows);
    const std::size_t bad = read_ply_rows(element_, encoding_, columns_, bytes, vertices);
    if (bad != rows) {
      fail(source_.input(), "vertex " + std::to_string(first + bad), "not a finite number");
    }
    points = {};
    points.cloud = std::move(vertices.cloud);
  }

 private:
  ByteSource source_;
  PlyEncoding encoding_;
  PlyElement element_;
  PlyColumns columns_;
  std::uint64_t begin_;
};

}  // namespace

std::unique_ptr<FileParts> open_ply_parts(const ByteSource& source) {
  constexpr std::uint64_t kMostHeader = std::uint64_t{1} << 20;
  std::string buffer;
  const std::string_view start = source.read(0, std::min(source.size(), kMostHeader), buffer);
  const std::size_t line = start.find_first_of("\r\n");
  const bool old_line_ends =
      line < start.size() && start[line] == '\r' && start.substr(line + 1, 1) != "\n";
  if (old_line_ends || start.find("end_header") == start.npos) return nullptr;
  const PlyHeader header = parse_ply_header(source.input(start));
  if (header.encoding == PlyEncoding::ascii) return nullptr;
  std::uint64_t begin = header.body.byte;
  for (const PlyElement& element : header.elements) {
    const std::uint64_t row = element.smallest_row();
    const bool fits = row > 0 && element.count <= (source.size() - begin) / row;
    if (!fits || element.has_lists()) return nullptr;
    if (element.name != "vertex") {
      begin += element.count * row;
      continue;
    }
    const PlyColumns columns = find_ply_columns(element);
    if (columns[kX] < 0 || columns[kY] < 0) return nullptr;
    auto parts = std::make_unique<PlyParts>(source, header.encoding, element, columns, begin);
    const auto edges = std::ranges::find(header.elements, "edge", &PlyElement::name);
    if (edges != header.elements.end() && edges->count > 0) {
      parts->warn(edges_left_out(edges->count));
    }
    return parts;
  }
  return nullptr;
}

}  // namespace delray::delaunay
