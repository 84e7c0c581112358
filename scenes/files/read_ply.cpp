// PLY (Turk 1994): elements of any properties in any order.
//
// Values are read one after the other, from text or binary, into the slots that their properties'
// names stand for. Faces are kept as lists until all vertices are known.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>
#include <span>

#include "scenes/files/growth_watch.h"
#include "scenes/files/ply_header.h"
#include "scenes/files/readers.h"
#include "scenes/files/texture_files.h"
#include "scenes/files/vertex_values.h"
#include "scenes/geometry/origin.h"
#include "scenes/geometry/polygon.h"
#include "scenes/geometry/weld.h"

namespace delray::scenes::internal {
namespace {

enum Slot : std::uint8_t { kX, kY, kZ, kNx, kNy, kNz, kR, kG, kB, kA, kU, kV, kSlots };

struct SlotName {
  std::string_view name;
  Slot slot;
};
constexpr std::array kSlotNames = {
    SlotName{"x", kX},         SlotName{"y", kY},         SlotName{"z", kZ},
    SlotName{"nx", kNx},       SlotName{"ny", kNy},       SlotName{"nz", kNz},
    SlotName{"normal_x", kNx}, SlotName{"normal_y", kNy}, SlotName{"normal_z", kNz},
    SlotName{"red", kR},       SlotName{"green", kG},     SlotName{"blue", kB},
    SlotName{"r", kR},         SlotName{"g", kG},         SlotName{"b", kB},
    SlotName{"alpha", kA},     SlotName{"a", kA},         SlotName{"diffuse_red", kR},
    SlotName{"u", kU},         SlotName{"v", kV},         SlotName{"diffuse_green", kG},
    SlotName{"s", kU},         SlotName{"t", kV},         SlotName{"diffuse_blue", kB},
    SlotName{"tx", kU},        SlotName{"ty", kV},        SlotName{"diffuse_alpha", kA},
    SlotName{"texture_u", kU}, SlotName{"texture_v", kV}, SlotName{"texture_s", kU},
    SlotName{"texture_t", kV}};

template <class T>
double decoded(const char* data, bool swap) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), data, sizeof(T));
  if (swap) std::reverse(bytes.begin(), bytes.end());
  return static_cast<double>(std::bit_cast<T>(bytes));
}

double decoded(const char* data, PlyType type, bool swap) {
  switch (type) {
    case PlyType::i8:
      return decoded<std::int8_t>(data, swap);
    case PlyType::u8:
      return decoded<std::uint8_t>(data, swap);
    case PlyType::i16:
      return decoded<std::int16_t>(data, swap);
    case PlyType::u16:
      return decoded<std::uint16_t>(data, swap);
    case PlyType::i32:
      return decoded<std::int32_t>(data, swap);
    case PlyType::u32:
      return decoded<std::uint32_t>(data, swap);
    case PlyType::f32:
      return decoded<float>(data, swap);
    default:
      return decoded<double>(data, swap);
  }
}

// Hands out the values of the body one after the other, from text or binary.
class PlyBody {
 public:
  PlyBody(const Source& source, const PlyHeader& header)
      : source_(source),
        header_(header),
        is_text_(header.coding == PlyCoding::text),
        swap_((header.coding == PlyCoding::big) == (std::endian::native == std::endian::little)),
        rest_(source.content.substr(header.size)),
        lines_(rest_) {}

  void start_item() {
    watch_.step();
    if (!is_text_) return;
    std::string_view line;
    if (!lines_.next_with_words(line, '\0')) fail("the file ends before its last element");
    words_ = Words(line);
  }
  double next(PlyType type) {
    if (is_text_) {
      double value = 0;
      const std::string_view word = words_.next();
      if (word.empty()) fail("the line has too few values");
      if (!parse(word, value)) fail("'" + std::string(word.substr(0, 40)) + "' is not a number");
      return value;
    }
    const std::size_t size = size_of(type);
    if (rest_.size() < size) fail("the file ends before its last element");
    const double value = decoded(rest_.data(), type, swap_);
    rest_.remove_prefix(size);
    return value;
  }
  void next_list(const PlyProperty& property, std::vector<double>& values) {
    const double length = next(property.length);
    const std::size_t room =
        is_text_ ? source_.content.size() : rest_.size() / size_of(property.value);
    if (!(length >= 0) || length != std::floor(length) || length > static_cast<double>(room)) {
      fail("a list is longer than the file");
    }
    values.clear();
    for (double i = 0; i < length; ++i) {
      watch_.step();
      values.push_back(next(property.value));
    }
  }
  [[noreturn]] void fail(const std::string& what) const {
    if (is_text_) source_.fail("line " + std::to_string(header_.lines + lines_.number()), what);
    source_.fail("byte " + std::to_string(source_.content.size() - rest_.size()), what);
  }

 private:
  const Source& source_;
  GrowthWatch watch_{source_};
  const PlyHeader& header_;
  bool is_text_, swap_;
  std::string_view rest_;
  Lines lines_;
  Words words_{""};
};

class PlyReader {
 public:
  explicit PlyReader(const Source& source)
      : source_(source), header_(read_ply_header(source)), body_(source, header_) {
    if (header_.vertices >= kNone) source.fail("header", "a mesh is too large");
  }

  Scene run() {
    for (const PlyElement& element : header_.elements) {
      if (element.properties.empty()) continue;
      if (element.name == "vertex") {
        read_vertices(element);
      } else {
        read_lists(element);
      }
    }
    if (!has_polygons_) source_.fail("", kNoTriangles);
    const glm::dvec3 origin = place_vertices();
    if (left_out_ > 0) source_.warn(std::to_string(left_out_) + " points and lines left out");
    normalize_or_clear(mesh_.normals);
    if (!corner_uvs_.empty()) give_corners_their_uvs();
    const std::uint32_t* corner = corners_.data();
    for (const std::uint32_t size : sizes_) {
      triangulate_polygon({corner, size}, mesh_.positions, mesh_.triangles);
      corner += size;
    }
    Scene scene = scene_of(std::move(mesh_), origin);
    add_texture(scene);
    return scene;
  }

 private:
  void read_vertices(const PlyElement& element) {
    std::vector<Slot> slots;
    std::array<bool, kSlots> has{};
    std::array<double, kSlots> scale{};
    for (const PlyProperty& property : element.properties) {
      const auto* known =
          std::find_if(kSlotNames.begin(), kSlotNames.end(),
                       [&](const SlotName& s) { return s.name == property.name && !has[s.slot]; });
      const bool used = known != kSlotNames.end() && !property.is_list();
      slots.push_back(used ? known->slot : kSlots);
      if (!used) continue;
      has[known->slot] = true;
      scale[known->slot] = 1 / full_scale(property.value);
      single_precision_ |=
          known->slot == kX && property.value == PlyType::f32 && header_.coding != PlyCoding::text;
    }
    if (!has[kX] || !has[kY]) source_.fail("header", "the vertices have no x or no y");
    const bool normals = has[kNx] && has[kNy] && has[kNz], uvs = has[kU] && has[kV];
    const bool colours = has[kR] && has[kG] && has[kB];
    std::array<double, kSlots + 1> v{};
    for (std::uint64_t i = 0; i < element.count; ++i) {
      body_.start_item();
      for (std::size_t k = 0; k < slots.size(); ++k) {
        const PlyProperty& property = element.properties[k];
        if (property.is_list()) {
          body_.next_list(property, values_);
        } else {
          v[slots[k]] = body_.next(property.value);
        }
      }
      const glm::dvec3 p(v[kX], v[kY], v[kZ]);
      if (const char* wrong = wrong_with(p)) body_.fail(wrong);
      places_.push_back(p);
      if (normals) mesh_.normals.emplace_back(v[kNx], v[kNy], v[kNz]);
      if (uvs) mesh_.uvs.push_back(usable_uv(v[kU], v[kV]));
      if (colours) {
        mesh_.colours.push_back(
            linear_colour({v[kR] * scale[kR], v[kG] * scale[kG], v[kB] * scale[kB],
                           has[kA] ? v[kA] * scale[kA] : 1.0}));
      }
    }
  }

  // Returns the origin.
  glm::dvec3 place_vertices() {
    source_.require_memory(places_.size() * sizeof(glm::vec3));
    const geometry::Box3d box = box_of(places_);
    if (single_precision_) warn_if_coarse(source_, reach_of(box), glm::length(box.size()));
    const glm::dvec3 origin = origin_of(box);
    mesh_.positions = relative_to(origin, places_);
    std::vector<glm::dvec3>().swap(places_);
    return origin;
  }

  // v of PLY grows upwards.
  static glm::vec2 usable_uv(double u, double v) {
    const glm::vec2 uv(u, 1 - v);
    return std::isfinite(uv.x) && std::isfinite(uv.y) ? uv : glm::vec2(0);
  }

  // Faces, strips, and whatever else has properties.
  void read_lists(const PlyElement& element) {
    const bool is_face = element.name == "face", is_strip = element.name == "tristrips";
    for (std::uint64_t i = 0; i < element.count; ++i) {
      body_.start_item();
      const std::size_t before = corners_.size();
      std::vector<double>& uvs = face_uvs_;
      uvs.clear();
      for (const PlyProperty& property : element.properties) {
        if (!property.is_list()) {
          body_.next(property.value);
          continue;
        }
        const bool is_uv = is_face && property.name == "texcoord";
        body_.next_list(property, is_uv ? uvs : values_);
        const bool is_index = property.name == "vertex_indices" || property.name == "vertex_index";
        if (is_index && is_face) add_face();
        if (is_index && is_strip) add_strips();
      }
      if (is_face) add_corner_uvs(before);
    }
  }

  std::uint32_t vertex(double value) const {
    if (!(value >= 0 && value < static_cast<double>(header_.vertices)) ||
        value != std::floor(value)) {
      const double shown = std::isfinite(value) ? std::clamp(value, -1e18, 1e18) : -1;
      body_.fail("there is no vertex " + std::to_string(static_cast<std::int64_t>(shown)) + " (" +
                 std::to_string(header_.vertices) + " vertices, from 0)");
    }
    return static_cast<std::uint32_t>(value);
  }

  void add_face() {
    for (const double value : values_) corners_.push_back(vertex(value));
    sizes_.push_back(static_cast<std::uint32_t>(values_.size()));
    if (values_.size() < 3) ++left_out_;
    has_polygons_ |= values_.size() >= 3;
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
      has_polygons_ = true;
      if (last[0] == last[1] || last[1] == last[2] || last[2] == last[0]) continue;
      const std::size_t odd = (length - 3) % 2;
      corners_.insert(corners_.end(), {last[odd], last[1 - odd], last[2]});
      sizes_.push_back(3);
    }
  }

  // `before`: where the corners of the face begin.
  void add_corner_uvs(std::size_t before) {
    const std::size_t corners = corners_.size() - before;
    if (corners == 0 || (face_uvs_.empty() && corner_uvs_.empty())) return;
    corner_uvs_.resize(before, glm::vec2(0));
    for (std::size_t k = 0; k < corners; ++k) {
      const bool given = 2 * k + 1 < face_uvs_.size();
      corner_uvs_.push_back(given ? usable_uv(face_uvs_[2 * k], face_uvs_[2 * k + 1])
                                  : glm::vec2(0));
    }
  }

  // Every corner gets a vertex of its own; equal ones are joined again.
  void give_corners_their_uvs() {
    if (corners_.size() >= kNone) source_.fail("", "a mesh is too large");
    Mesh mesh;
    mesh.uvs = std::move(corner_uvs_);
    mesh.uvs.resize(corners_.size(), glm::vec2(0));
    for (const std::uint32_t v : corners_) {
      mesh.positions.push_back(mesh_.positions[v]);
      if (!mesh_.normals.empty()) mesh.normals.push_back(mesh_.normals[v]);
      if (!mesh_.colours.empty()) mesh.colours.push_back(mesh_.colours[v]);
    }
    const std::vector<std::uint32_t> number = weld(mesh);
    corners_ = number;
    mesh_ = std::move(mesh);
  }

  void add_texture(Scene& scene) const {
    if (header_.textures.empty() || scene.meshes[0].uvs.empty()) return;
    if (header_.textures.size() > 1) source_.warn("of its textures only the first is read");
    TextureFiles textures(source_, scene.textures);
    const std::uint32_t texture =
        textures.from_file(std::string(header_.textures[0]), TextureUse{true});
    scene.materials[0].base_colour_texture = texture;
    if (texture != kNone) scene.materials[0].base_colour = glm::vec4(1);
  }

  const Source& source_;
  PlyHeader header_;
  PlyBody body_;
  std::vector<glm::dvec3> places_;  // positions as the file gives them
  bool single_precision_ = false;   // of these
  Mesh mesh_;
  std::vector<std::uint32_t> corners_, sizes_;  // of all polygons
  std::vector<glm::vec2> corner_uvs_;           // of corners_, if any face has them
  std::vector<double> values_, face_uvs_;       // of a list
  std::uint64_t left_out_ = 0;
  bool has_polygons_ = false;
};

}  // namespace

Scene read_ply(const Source& source) { return PlyReader(source).run(); }

}  // namespace delray::scenes::internal
