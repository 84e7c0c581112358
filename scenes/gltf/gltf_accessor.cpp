// Accessors: typed elements at regular distances in a buffer view, with sparse replacements. Bounds
// are checked before anything is allocated; an accessor without data is all zeros, and its size is
// limited by that of the file.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>

#include "parallel/grow.h"
#include "parallel/parallel_for.h"

#include "scenes/gltf/gltf_document.h"

namespace delray::scenes::internal {
namespace {

// Elements of an accessor without data are zeros but for those that a sparse part replaces. There
// may be this many, or one for each byte of the file: more would fill the memory with nothing.
constexpr std::uint64_t kFewZeros = 1U << 16;
// Bytes that are read at once: less than a millisecond of work, and they stay in the cache.
constexpr std::size_t kBlockBytes = std::size_t{1} << 18;

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
  std::size_t stride = 0;
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

// Where elements are, of which as many as wanted are read at a time.
struct ElementRange {
  GltfBytes bytes;
  std::uint64_t offset = 0, stride = 0, element_size = 0;
  Component component{};
  bool normalized = false;

  // Elements [first, last). REQUIRES: first < last.
  Elements read(std::uint64_t first, std::uint64_t last, std::string& buffer) const {
    const std::uint64_t size = (last - first - 1) * stride + element_size;
    return {bytes.read(offset + first * stride, size, buffer).data(), stride, component,
            normalized};
  }
};

ElementRange elements_at(const GltfDocument& document, const JsonView& where, std::uint64_t count,
                         const Component& component, std::size_t element_size) {
  const JsonView views = document.root()["bufferViews"];
  const std::uint32_t number = where["bufferView"].reference(views.size());
  if (number == kNone) where["bufferView"].fail("is missing");
  const GltfBytes bytes = buffer_view(document, number);
  const std::uint64_t offset = where["byteOffset"].whole(0);
  const std::uint64_t stride = views[number]["byteStride"].whole(element_size);
  if (stride < component.size || stride > 4096) views[number]["byteStride"].fail("is out of range");
  const bool fits = offset <= bytes.size &&
                    (count == 0 || (bytes.size - offset >= element_size &&
                                    (bytes.size - offset - element_size) / stride >= count - 1));
  if (!fits) {
    where.fail("its " + std::to_string(count) + " elements reach beyond bufferViews[" +
               std::to_string(number) + "] of " + std::to_string(bytes.size) + " bytes");
  }
  return {bytes, offset, stride, element_size, component, false};
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
  } else if (accessor.count > std::max(kFewZeros, document.source.bytes().size())) {
    json.fail("has no data for its " + std::to_string(accessor.count) + " elements");
  }
  return accessor;
}

ElementRange dense_elements(const GltfDocument& document, const Accessor& accessor) {
  ElementRange dense = elements_at(document, accessor.json, accessor.count, accessor.component,
                                   accessor.element_size());
  dense.normalized = accessor.normalized;
  return dense;
}

// Calls store(first, last, elements) for blocks of the dense part in parallel, where `elements`
// begin with the first, and then for each element that the sparse part replaces.
template <class Store>
void for_each_block(const GltfDocument& document, const Accessor& accessor, Store&& store) {
  if (accessor.json["bufferView"] && accessor.count > 0) {
    const ElementRange dense = dense_elements(document, accessor);
    const auto block =
        static_cast<std::size_t>(std::max<std::uint64_t>(kBlockBytes / dense.stride, 1));
    parallel::parallel_blocks(0, accessor.count, block, [&](std::size_t first, std::size_t last) {
      thread_local std::string buffer;
      store(first, last, dense.read(first, last, buffer));
    });
  }
  const JsonView sparse = accessor.json["sparse"];
  if (!sparse) return;
  const std::uint64_t count = sparse["count"].whole();
  const Component& index_type = component_of(sparse["indices"]["componentType"]);
  if (index_type.is_signed) sparse["indices"].fail("must be unsigned");
  const ElementRange index_range =
      elements_at(document, sparse["indices"], count, index_type, index_type.size);
  ElementRange values =
      elements_at(document, sparse["values"], count, accessor.component, accessor.element_size());
  values.normalized = accessor.normalized;
  if (count == 0) return;
  std::string index_buffer, value_buffer;
  const Elements indices = index_range.read(0, count, index_buffer);
  Elements value = values.read(0, count, value_buffer);
  for (std::size_t i = 0; i < count; ++i, value.data += value.stride) {
    const std::uint32_t target = indices.whole(i, 0);
    if (target >= accessor.count) sparse["indices"].fail("an index is out of range");
    store(target, target + 1, value);
  }
}

// Copies elements that are as they are to be. False where they are not.
template <class T>
bool copy_as_they_are(const Elements& elements, bool same_type, std::span<T> to) {
  if (!same_type || elements.stride != sizeof(T)) return false;
  std::memcpy(to.data(), elements.data, to.size_bytes());
  return true;
}

template <int N>
void decode(const Elements& elements, std::span<glm::vec<N, float>> to) {
  if (copy_as_they_are(elements, elements.component.is_real, to)) return;
  for (std::size_t i = 0; i < to.size(); ++i) {
    for (int k = 0; k < N; ++k) to[i][k] = elements.real(i, k);
  }
}

void decode(const Elements& elements, std::span<std::uint32_t> to) {
  if (copy_as_they_are(elements, elements.component.size == 4, to)) return;
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = elements.whole(i, 0);
}

template <int N>
Accessor vector_accessor_at(const GltfDocument& document, std::size_t number) {
  Accessor accessor = accessor_at(document, number);
  if (accessor.components != N) {
    accessor.json["type"].fail("has " + std::to_string(accessor.components) + " components, not " +
                               std::to_string(N));
  }
  return accessor;
}

Accessor index_accessor_at(const GltfDocument& document, std::size_t number) {
  const Accessor accessor = accessor_at(document, number);
  if (accessor.components != 1 || accessor.component.is_signed) {
    accessor.json.fail("indices must be unsigned scalars");
  }
  return accessor;
}

// REQUIRES: as many as the accessor has.
void read_indices(const GltfDocument& document, const Accessor& accessor, std::uint32_t* indices) {
  for_each_block(document, accessor,
                 [&](std::size_t first, std::size_t last, const Elements& elements) {
                   decode(elements, std::span(indices + first, last - first));
                 });
}

template <int N>
std::size_t first_not_finite(std::span<const glm::vec<N, float>> values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    float sum = 0;  // not a number if one of them is not finite
    for (int k = 0; k < N; ++k) sum += values[i][k] * 0.0F;
    if (sum != 0) return i;
  }
  return values.size();
}

template <int N>
void require_finite(const GltfDocument& document, std::size_t number, std::uint64_t first,
                    std::span<const glm::vec<N, float>> values) {
  const std::size_t wrong = first_not_finite(values);
  if (wrong == values.size()) return;
  document.root()["accessors"][number].fail("element " + std::to_string(first + wrong) +
                                            " is not finite");
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
  const Accessor accessor = vector_accessor_at<N>(document, number);
  document.source.require_memory(accessor.count * sizeof(glm::vec<N, float>),
                                 accessor.json.place());
  std::vector<glm::vec<N, float>> values;
  parallel::grow(values, accessor.count);
  for_each_block(document, accessor,
                 [&](std::size_t first, std::size_t last, const Elements& elements) {
                   decode<N>(elements, std::span(values.data() + first, last - first));
                 });
  const std::size_t wrong = parallel::parallel_reduce(
      0, values.size(), kBlockBytes / sizeof(values[0]), values.size(),
      [&](std::size_t first, std::size_t last) {
        const std::span<const glm::vec<N, float>> block(values.data() + first, last - first);
        const std::size_t at = first_not_finite(block);
        return at < block.size() ? first + at : values.size();
      },
      [](std::size_t a, std::size_t b) { return std::min(a, b); });
  if (wrong < values.size()) {
    accessor.json.fail("element " + std::to_string(wrong) + " is not finite");
  }
  return values;
}

std::vector<float> read_floats(const GltfDocument& document, std::size_t number, int components) {
  const Accessor accessor = accessor_at(document, number);
  if (accessor.components != components) {
    accessor.json["type"].fail("has " + std::to_string(accessor.components) + " components, not " +
                               std::to_string(components));
  }
  const auto width = static_cast<std::size_t>(components);
  document.source.require_memory(accessor.count * width * sizeof(float), accessor.json.place());
  std::vector<float> values(accessor.count * width);
  for_each_block(document, accessor,
                 [&](std::size_t first, std::size_t last, const Elements& elements) {
                   float* to = values.data() + first * width;
                   for (std::size_t i = 0; i < last - first; ++i)
                     for (int k = 0; k < components; ++k) *to++ = elements.real(i, k);
                 });
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i]))
      accessor.json.fail("element " + std::to_string(i / width) + " is not finite");
  }
  return values;
}

template <int N>
std::vector<glm::vec<N, float>> read_vectors(const GltfDocument& document, std::size_t number,
                                             std::uint64_t first, std::uint64_t last) {
  const ElementRange dense = dense_elements(document, vector_accessor_at<N>(document, number));
  std::vector<glm::vec<N, float>> values(last - first);
  if (values.empty()) return values;
  std::string buffer;
  decode<N>(dense.read(first, last, buffer), std::span(values));
  require_finite<N>(document, number, first, values);
  return values;
}

bool is_dense(const GltfDocument& document, std::size_t number) {
  const JsonView accessor = document.root()["accessors"][number];
  return accessor["bufferView"] && !accessor["sparse"];
}

void read_index_triples(const GltfDocument& document, std::size_t number, std::uint64_t first,
                        std::span<glm::uvec3> to) {
  const ElementRange dense = dense_elements(document, index_accessor_at(document, number));
  if (to.empty()) return;
  std::string buffer;
  decode(dense.read(3 * first, 3 * (first + to.size()), buffer),
         std::span(&to[0].x, 3 * to.size()));
}

template std::vector<glm::vec2> read_vectors<2>(const GltfDocument&, std::size_t, std::uint64_t,
                                                std::uint64_t);
template std::vector<glm::vec3> read_vectors<3>(const GltfDocument&, std::size_t, std::uint64_t,
                                                std::uint64_t);
template std::vector<glm::vec4> read_vectors<4>(const GltfDocument&, std::size_t, std::uint64_t,
                                                std::uint64_t);
template std::vector<glm::vec2> read_vectors<2>(const GltfDocument&, std::size_t);
template std::vector<glm::vec3> read_vectors<3>(const GltfDocument&, std::size_t);
template std::vector<glm::vec4> read_vectors<4>(const GltfDocument&, std::size_t);

std::vector<std::uint32_t> read_indices(const GltfDocument& document, std::size_t number) {
  const Accessor accessor = index_accessor_at(document, number);
  document.source.require_memory(accessor.count * sizeof(std::uint32_t), accessor.json.place());
  std::vector<std::uint32_t> values;
  parallel::grow(values, accessor.count);
  read_indices(document, accessor, values.data());
  return values;
}

std::vector<glm::uvec3> read_index_triples(const GltfDocument& document, std::size_t number) {
  const Accessor accessor = index_accessor_at(document, number);
  document.source.require_memory(accessor.count * sizeof(std::uint32_t), accessor.json.place());
  static_assert(sizeof(glm::uvec3) == 3 * sizeof(std::uint32_t));
  std::vector<glm::uvec3> values;
  parallel::grow(values, (accessor.count + 2) / 3);
  if (!values.empty()) read_indices(document, accessor, &values[0].x);
  return values;
}

std::uint64_t element_count(const GltfDocument& document, std::size_t number) {
  return document.root()["accessors"][number]["count"].whole();
}

}  // namespace delray::scenes::internal
