// Lists are read value by value; triangles, whose rows are all of one size, are copied and checked.
#include "scenes/files/ply_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "scenes/files/ply_vertices.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {
namespace {

// Reads faces, strips, and whatever else has properties.
class PolygonRows {
 public:
  PolygonRows(const PlyFile& file, const PlyElement& element, const PlyBlock& block)
      : element_(element),
        rows_(file, block),
        row_count_(block.rows),
        vertices_(file.header.vertices),
        is_face_(element.name == "face"),
        is_strip_(element.name == "tristrips") {}

  Polygons run() {
    for (std::uint64_t i = 0; i < row_count_; ++i) read_row();
    return std::move(to_);
  }

 private:
  void read_row() {
    rows_.start_row();
    const std::size_t before = to_.corners.size();
    face_uvs_.clear();
    for (const PlyProperty& property : element_.properties) {
      if (!property.is_list()) {
        rows_.next(property.value);
        continue;
      }
      const bool is_uv = is_face_ && property.name == "texcoord";
      rows_.next_list(property, is_uv ? face_uvs_ : values_);
      const bool is_index = property.name == "vertex_indices" || property.name == "vertex_index";
      if (is_index && is_face_) add_face();
      if (is_index && is_strip_) add_strips();
    }
    rows_.end_row();
    if (is_face_) add_corner_uvs(before);
  }

  std::uint32_t vertex(double value) const {
    if (!(value >= 0 && value < static_cast<double>(vertices_)) || value != std::floor(value)) {
      const double shown = std::isfinite(value) ? std::clamp(value, -1e18, 1e18) : -1;
      rows_.fail("there is no vertex " + std::to_string(static_cast<std::int64_t>(shown)) + " (" +
                 std::to_string(vertices_) + " vertices, from 0)");
    }
    return static_cast<std::uint32_t>(value);
  }

  void add_face() {
    for (const double value : values_) to_.corners.push_back(vertex(value));
    to_.sizes.push_back(static_cast<std::uint32_t>(values_.size()));
    if (values_.size() < 3) ++to_.left_out;
    to_.any |= values_.size() >= 3;
  }

  // Every second triangle of a strip has the other sense. -1 begins the next strip; where two
  // strips are joined by repeated vertices there is no triangle.
  void add_strips() {
    std::size_t length = 0;
    std::array<std::uint32_t, 3> last{};
    for (const double value : values_) {
      if (value == -1 || value == double{kNone}) {
        length = 0;
        continue;
      }
      last = {last[1], last[2], vertex(value)};
      if (++length < 3) continue;
      to_.any = true;
      if (last[0] == last[1] || last[1] == last[2] || last[2] == last[0]) continue;
      const std::size_t odd = (length - 3) % 2;
      to_.corners.insert(to_.corners.end(), {last[odd], last[1 - odd], last[2]});
      to_.sizes.push_back(3);
    }
  }

  // `before`: where the corners of the face begin.
  void add_corner_uvs(std::size_t before) {
    const std::size_t corners = to_.corners.size() - before;
    if (corners == 0 || (face_uvs_.empty() && to_.uvs.empty())) return;
    to_.uvs.resize(before, glm::vec2(0));
    for (std::size_t k = 0; k < corners; ++k) {
      const bool given = 2 * k + 1 < face_uvs_.size();
      to_.uvs.push_back(given ? usable_uv(face_uvs_[2 * k], face_uvs_[2 * k + 1]) : glm::vec2(0));
    }
  }

  const PlyElement& element_;
  PlyRows rows_;
  std::uint64_t row_count_, vertices_;
  bool is_face_, is_strip_;
  Polygons to_;
  std::vector<double> values_, face_uvs_;  // of a list
};

}  // namespace

Polygons read_polygons(const PlyFile& file, const PlyElement& element, const PlyBlock& block) {
  return PolygonRows(file, element, block).run();
}

std::optional<EvenTriangles> even_triangles(const PlyFile& file, const PlyElement& element) {
  const auto is_polygons = [](const PlyElement& e) {
    return (e.name == "face" || e.name == "tristrips") && !e.properties.empty();
  };
  if (element.name != "face" || element.count == 0 || file.is_text() ||
      std::ranges::count_if(file.header.elements, is_polygons) != 1 ||
      std::ranges::count_if(element.properties, &PlyProperty::is_list) != 1) {
    return std::nullopt;
  }
  EvenTriangles faces;
  const auto list = std::ranges::find_if(element.properties, &PlyProperty::is_list);
  for (auto p = element.properties.begin(); p != list; ++p) faces.offset += size_of(p->value);
  if (list->name != "vertex_indices" && list->name != "vertex_index") return std::nullopt;
  faces.list = &*list;
  return faces;
}

bool read_even_triangles(const PlyFile& file, const EvenTriangles& faces, const PlyBlock& block,
                         glm::uvec3* to) {
  thread_local std::string buffer;
  const std::string_view bytes = file.bytes.read(block.begin, block.bytes, buffer);
  const std::size_t stride = bytes.size() / block.rows;
  const std::size_t each = size_of(faces.list->value), length = size_of(faces.list->length);
  if (stride < faces.offset + length + 3 * each) return false;  // the first list is shorter
  const bool swap = file.swap();
  const bool plain =
      !swap && (faces.list->value == PlyType::i32 || faces.list->value == PlyType::u32);
  const auto count = static_cast<std::uint32_t>(file.header.vertices);
  bool good = true;
  const char* row = bytes.data() + faces.offset;
  for (std::uint64_t i = 0; i < block.rows; ++i, row += stride) {
    good &= length == 1 ? *row == 3 : ply_value(row, faces.list->length, swap) == 3;
    glm::uvec3 t;
    if (plain) {
      std::memcpy(&t, row + length, sizeof t);  // negative ones become large
    } else {
      for (int k = 0; k < 3; ++k) {
        const double v = ply_value(row + length + k * each, faces.list->value, swap);
        good &= v >= 0 && v < count && v == std::floor(v);
        t[k] = v >= 0 && v < count ? static_cast<std::uint32_t>(v) : 0;
      }
    }
    good &= t.x < count && t.y < count && t.z < count;
    to[i] = t;
  }
  return good;
}

}  // namespace delray::scenes::internal
