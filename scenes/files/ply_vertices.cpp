// Rows of three floats are copied; others are taken apart value by value into the slots that their
// properties' names stand for.
#include "scenes/files/ply_vertices.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "parallel/grow.h"
#include "scenes/files/vertex_values.h"

namespace delray::scenes::internal {
namespace {

using enum VertexLayout::Slot;

struct SlotName {
  std::string_view name;
  VertexLayout::Slot slot;
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

}  // namespace

VertexLayout::VertexLayout(const PlyElement& element) {
  bool lists = false;
  for (const PlyProperty& property : element.properties) {
    const auto* known = std::find_if(kSlotNames.begin(), kSlotNames.end(), [&](const SlotName& s) {
      return s.name == property.name && !has[s.slot];
    });
    const bool used = known != kSlotNames.end() && !property.is_list();
    slots.push_back(used ? known->slot : kSlots);
    if (used) {
      has[known->slot] = true;
      scale[known->slot] = 1 / full_scale(property.value);
      type[known->slot] = property.value;
      offset[known->slot] = stride;
    }
    lists |= property.is_list();
    stride += size_of(property.value);
  }
  if (lists) stride = 0;
}

bool VertexLayout::single() const {
  return type[kX] == PlyType::f32 && type[kY] == PlyType::f32 &&
         (!has[kZ] || type[kZ] == PlyType::f32);
}

bool VertexLayout::bare() const {
  return stride > 0 && has[kZ] && single() && offset[kY] == offset[kX] + sizeof(float) &&
         offset[kZ] == offset[kY] + sizeof(float) && !normals() && !uvs() && !colours();
}

glm::vec2 usable_uv(double u, double v) {
  const glm::vec2 uv(u, 1 - v);
  return std::isfinite(uv.x) && std::isfinite(uv.y) ? uv : glm::vec2(0);
}

PlyVertexReader::PlyVertexReader(const PlyFile& file, const PlyElement& element)
    : file_(file),
      element_(element),
      layout_(element),
      direct_(!file.is_text() && layout_.single()) {
  if (!layout_.has[kX] || !layout_.has[kY]) {
    file.source.fail("header", "the vertices have no x or no y");
  }
}

void PlyVertexReader::allocate(std::uint64_t count, Mesh& mesh,
                               std::vector<glm::dvec3>& places) const {
  const bool normals = layout_.normals(), uvs = layout_.uvs(), colours = layout_.colours();
  file_.source.require_memory(count *
                              (sizeof(glm::vec3) + (direct_ ? 0 : sizeof(glm::dvec3)) +
                               (normals ? sizeof(glm::vec3) : 0) + (uvs ? sizeof(glm::vec2) : 0) +
                               (colours ? sizeof(glm::vec4) : 0)));
  if (direct_) {
    parallel::grow(mesh.positions, count);
  } else {
    parallel::grow(places, count);
  }
  if (normals) parallel::grow(mesh.normals, count);
  if (uvs) parallel::grow(mesh.uvs, count);
  if (colours) parallel::grow(mesh.colours, count);
}

// False where a coordinate is wrong; whoever reads the block row by row says which.
bool PlyVertexReader::read_bare(const PlyBlock& block, std::uint64_t to, Mesh& mesh,
                                geometry::Box3d& all) const {
  thread_local std::string buffer;
  const std::string_view bytes = file_.bytes.read(block.begin, block.bytes, buffer);
  if (bytes.size() != block.rows * layout_.stride) return false;
  const bool swap = file_.swap();
  const char* from = bytes.data() + layout_.offset[kX];
  geometry::Box3 box;
  bool good = true;
  for (std::uint64_t i = 0; i < block.rows; ++i, from += layout_.stride) {
    glm::vec3 p;
    if (swap) {
      for (int k = 0; k < 3; ++k) {
        p[k] = static_cast<float>(ply_value(from + k * sizeof(float), PlyType::f32, true));
      }
    } else {
      std::memcpy(&p, from, sizeof p);
    }
    constexpr auto kLargest = static_cast<float>(kLargestCoordinate);
    good &= std::abs(p.x) <= kLargest && std::abs(p.y) <= kLargest && std::abs(p.z) <= kLargest;
    box.include(p);
    mesh.positions[to + i] = p;
  }
  if (good) all = {box.low, box.high};
  return good;
}

geometry::Box3d PlyVertexReader::read(const PlyBlock& block, std::uint64_t to, Mesh& mesh,
                                      std::vector<glm::dvec3>& places) const {
  geometry::Box3d box;
  if (direct_ && layout_.bare() && read_bare(block, to, mesh, box)) return box;
  PlyRows rows(file_, block);
  const auto& has = layout_.has;
  const auto& scale = layout_.scale;
  std::array<double, VertexLayout::kSlots + 1> v{};
  std::vector<double> values;
  for (std::uint64_t i = to; i < to + block.rows; ++i) {
    rows.start_row();
    for (std::size_t k = 0; k < layout_.slots.size(); ++k) {
      const PlyProperty& property = element_.properties[k];
      if (property.is_list()) {
        rows.next_list(property, values);
      } else {
        v[layout_.slots[k]] = rows.next(property.value);
      }
    }
    rows.end_row();
    const glm::dvec3 p(v[kX], v[kY], v[kZ]);
    if (const char* wrong = wrong_with(p)) rows.fail(wrong);
    box.include(p);
    if (direct_) {
      mesh.positions[i] = p;
    } else {
      places[i] = p;
    }
    if (!mesh.normals.empty()) mesh.normals[i] = glm::vec3(v[kNx], v[kNy], v[kNz]);
    if (!mesh.uvs.empty()) mesh.uvs[i] = usable_uv(v[kU], v[kV]);
    if (!mesh.colours.empty()) {
      mesh.colours[i] = linear_colour({v[kR] * scale[kR], v[kG] * scale[kG], v[kB] * scale[kB],
                                       has[kA] ? v[kA] * scale[kA] : 1.0});
    }
  }
  return box;
}

}  // namespace delray::scenes::internal
