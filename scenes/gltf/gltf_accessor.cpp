// Accessors: typed elements at regular distances in a buffer view, with sparse replacements. Bounds
// are checked before anything is allocated; an accessor without data is all zeros, and its size is
// limited by that of the file.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "scenes/gltf/gltf_document.h"

namespace delray::scenes::internal {
namespace {

// Elements of an accessor without data are zeros but for those that a sparse part replaces. There
// may be this many, or one for each byte of the file: more would fill the memory with nothing.
constexpr std::uint64_t kFewZeros = 1U << 16;

struct Component {
  std::uint64_t code;
  std::size_t size;
  bool is_signed, is_real;
};
constexpr std::array kComponents = {
    Component{5120, 1, true, false},  Component{5121, 1, false, false},
    Component{5122, 2, true, false},  Component{5123, 2, false, false},
    Component{5125, 4, false, false}, Component{5126, 4, true, true}};

const Component& component_of(const JsonView& type) {
  const std::uint64_t code = type.whole();
  for (const Component& c : kComponents) {
    if (c.code == code) return c;
  }
  type.fail("there is no component type " + std::to_string(code));
}

int components_of(const JsonView& accessor) {
  const std::string type = accessor["type"].text();
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4" || type == "MAT2") return 4;
  if (type == "MAT3") return 9;
  if (type == "MAT4") return 16;
  accessor["type"].fail("is not a type of accessor");
}

// Elements at regular distances within some bytes.
struct Elements {
  const char* data = nullptr;
  std::size_t stride = 0, count = 0;
  Component component{};
  bool normalized = false;

  template <class T>
  T raw(std::size_t i, int k) const {
    T value;
    std::memcpy(&value, data + i * stride + static_cast<std::size_t>(k) * sizeof(T), sizeof(T));
    return value;
  }
  std::uint32_t whole(std::size_t i, int k) const {
    if (component.size == 1) return raw<std::uint8_t>(i, k);
    return component.size == 2 ? raw<std::uint16_t>(i, k) : raw<std::uint32_t>(i, k);
  }
  float real(std::size_t i, int k) const {
    if (component.is_real) return raw<float>(i, k);
    const int bits = static_cast<int>(component.size) * 8;
    double value = whole(i, k);
    if (component.is_signed && value >= std::ldexp(1.0, bits - 1)) value -= std::ldexp(1.0, bits);
    if (!normalized) return static_cast<float>(value);
    const double most = std::ldexp(1.0, bits - (component.is_signed ? 1 : 0)) - 1;
    return static_cast<float>(std::max(value / most, -1.0));
  }
};

Elements elements_at(const GltfDocument& document, const JsonView& where, std::uint64_t count,
                     const Component& component, std::size_t element_size) {
  const JsonView views = document.root()["bufferViews"];
  const std::uint32_t number = where["bufferView"].reference(views.size());
  if (number == kNone) where["bufferView"].fail("is missing");
  const std::string_view bytes = buffer_view(document, number);
  const std::uint64_t offset = where["byteOffset"].whole(0);
  const std::uint64_t stride = views[number]["byteStride"].whole(element_size);
  if (stride < component.size || stride > 4096) views[number]["byteStride"].fail("is out of range");
  const bool fits = offset <= bytes.size() &&
                    (count == 0 || (bytes.size() - offset >= element_size &&
                                    (bytes.size() - offset - element_size) / stride >= count - 1));
  if (!fits) {
    where.fail("its " + std::to_string(count) + " elements reach beyond bufferViews[" +
               std::to_string(number) + "] of " + std::to_string(bytes.size()) + " bytes");
  }
  return {bytes.data() + offset, stride, count, component, false};
}

struct Accessor {
  JsonView json;
  std::uint64_t count;
  int components;
  Component component;
  bool normalized;

  std::size_t element_size() const { return component.size * static_cast<std::size_t>(components); }
};

Accessor accessor_at(const GltfDocument& document, std::size_t number) {
  const JsonView json = document.root()["accessors"][number];
  Accessor accessor{json, json["count"].whole(), components_of(json),
                    component_of(json["componentType"]), json["normalized"].flag(false)};
  if (accessor.count > 0xFFFFFFFEU) json["count"].fail("is larger than 2^32 - 2");
  if (json["bufferView"]) {
    // Before anything is allocated for as many elements.
    elements_at(document, json, accessor.count, accessor.component, accessor.element_size());
  } else if (accessor.count > std::max<std::uint64_t>(kFewZeros, document.source.content.size())) {
    json.fail("has no data for its " + std::to_string(accessor.count) + " elements");
  }
  return accessor;
}

// Calls store(element, its place in the source, the source) for the dense part and then for the
// elements that the sparse part replaces.
template <class Store>
void for_each_element(const GltfDocument& document, const Accessor& accessor, Store&& store) {
  if (accessor.json["bufferView"]) {
    Elements dense = elements_at(document, accessor.json, accessor.count, accessor.component,
                                 accessor.element_size());
    dense.normalized = accessor.normalized;
    for (std::size_t i = 0; i < accessor.count; ++i) store(i, i, dense);
  }
  const JsonView sparse = accessor.json["sparse"];
  if (!sparse) return;
  const std::uint64_t count = sparse["count"].whole();
  const Component& index_type = component_of(sparse["indices"]["componentType"]);
  if (index_type.is_signed) sparse["indices"].fail("must be unsigned");
  const Elements indices =
      elements_at(document, sparse["indices"], count, index_type, index_type.size);
  Elements values =
      elements_at(document, sparse["values"], count, accessor.component, accessor.element_size());
  values.normalized = accessor.normalized;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t target = indices.whole(i, 0);
    if (target >= accessor.count) sparse["indices"].fail("an index is out of range");
    store(target, i, values);
  }
}

}  // namespace

bool is_all_zero(const GltfDocument& document, std::size_t number) {
  const JsonView accessor = document.root()["accessors"][number];
  return !accessor["bufferView"] && !accessor["sparse"];
}

int component_count(const GltfDocument& document, std::size_t number) {
  return components_of(document.root()["accessors"][number]);
}

template <int N>
std::vector<glm::vec<N, float>> read_vectors(const GltfDocument& document, std::size_t number) {
  const Accessor accessor = accessor_at(document, number);
  if (accessor.components != N) {
    accessor.json["type"].fail("has " + std::to_string(accessor.components) + " components, not " +
                               std::to_string(N));
  }
  document.source.require_memory(accessor.count * sizeof(glm::vec<N, float>),
                                 accessor.json.place());
  std::vector<glm::vec<N, float>> values(accessor.count, glm::vec<N, float>(0));
  for_each_element(document, accessor,
                   [&](std::size_t target, std::size_t i, const Elements& elements) {
                     for (int k = 0; k < N; ++k) values[target][k] = elements.real(i, k);
                   });
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (int k = 0; k < N; ++k) {
      if (!std::isfinite(values[i][k])) {
        accessor.json.fail("element " + std::to_string(i) + " is not finite");
      }
    }
  }
  return values;
}

template std::vector<glm::vec2> read_vectors<2>(const GltfDocument&, std::size_t);
template std::vector<glm::vec3> read_vectors<3>(const GltfDocument&, std::size_t);
template std::vector<glm::vec4> read_vectors<4>(const GltfDocument&, std::size_t);

std::vector<std::uint32_t> read_indices(const GltfDocument& document, std::size_t number) {
  const Accessor accessor = accessor_at(document, number);
  if (accessor.components != 1 || accessor.component.is_signed) {
    accessor.json.fail("indices must be unsigned scalars");
  }
  document.source.require_memory(accessor.count * sizeof(std::uint32_t), accessor.json.place());
  std::vector<std::uint32_t> values(accessor.count, 0);
  for_each_element(document, accessor,
                   [&](std::size_t target, std::size_t i, const Elements& elements) {
                     values[target] = elements.whole(i, 0);
                   });
  return values;
}

}  // namespace delray::scenes::internal
