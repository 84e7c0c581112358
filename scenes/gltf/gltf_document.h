// The parts of a glTF file before they mean anything: JSON, buffers, accessors.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/gltf/json_view.h"

namespace delray::scenes::internal {

// Bytes of a buffer, in memory or in a file.
struct GltfBytes {
  files::FileBytes bytes;
  std::uint64_t begin = 0, size = 0;

  // Some of them, in `buffer` where they come from a file. REQUIRES: first + count <= size.
  std::string_view read(std::uint64_t first, std::uint64_t count, std::string& buffer) const {
    return bytes.read(begin + first, count, buffer);
  }
};

struct GltfDocument {
  const Source& source;
  Json json;
  std::vector<GltfBytes> buffers;  // as many bytes as the document says

  JsonView root() const { return {source, &json, ""}; }
};

// Takes the container apart, parses the JSON, finds the buffers. Fails on a required extension that
// is not known.
GltfDocument read_document(const Source& source);

// The bytes of bufferViews[number].
GltfBytes buffer_view(const GltfDocument& document, std::size_t number);

// Decodes "data:...;base64," URIs and percent signs; false if `uri` is no data URI, resp.
// left as it is where it is malformed.
bool decode_data_uri(std::string_view uri, std::string& bytes);
std::string decode_percent(std::string_view uri);

// All elements of accessors[number] as floats: integers as numbers or, if normalised, as fractions.
// Fails unless the accessor has N components per element and all values are finite.
template <int N>
std::vector<glm::vec<N, float>> read_vectors(const GltfDocument& document, std::size_t number);

// The same with any number of components, element after element: scalars, matrices by column.
std::vector<float> read_floats(const GltfDocument& document, std::size_t number, int components);

// Whether accessors[number] has all of its elements in a buffer, so that some can be read.
bool is_dense(const GltfDocument& document, std::size_t number);
// Elements [first, last) of one that is_dense, as read_vectors. REQUIRES: there are so many.
template <int N>
std::vector<glm::vec<N, float>> read_vectors(const GltfDocument& document, std::size_t number,
                                             std::uint64_t first, std::uint64_t last);
// Triples of its elements from the first-th on. REQUIRES: there are so many; is_dense.
void read_index_triples(const GltfDocument& document, std::size_t number, std::uint64_t first,
                        std::span<glm::uvec3> to);

// Whether accessors[number] has no data: all of its elements are zero.
bool is_all_zero(const GltfDocument& document, std::size_t number);

// Elements of an accessor of unsigned integers; as triples, of which the last may be cut off.
std::vector<std::uint32_t> read_indices(const GltfDocument& document, std::size_t number);
std::vector<glm::uvec3> read_index_triples(const GltfDocument& document, std::size_t number);
// The number of elements of an accessor, and of components of each.
std::uint64_t element_count(const GltfDocument& document, std::size_t number);
int component_count(const GltfDocument& document, std::size_t number);

}  // namespace delray::scenes::internal
