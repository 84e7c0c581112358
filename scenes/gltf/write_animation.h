// Nodes, skins and animations as JSON of glTF, for writing.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "scenes/gltf/gltf_extras.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {

// The binary part of a document: both append an accessor and return its number.
struct AccessorWriter {
  std::function<Json(std::span<const float> values, const char* type)> floats;
  std::function<Json(std::span<const std::uint16_t> fours)> joints;
};

// The accessor types of as many components.
const char* accessor_type(std::uint32_t components);

// Adds the nodes of the table to the document, which has none yet, with what follows them of
// meshes: instances that move and meshes that bend; then skins and animations. Marks in `placed`
// the instances that it placed. Returns the nodes without a parent.
std::vector<std::size_t> write_nodes(const Scene& scene, const AccessorWriter& accessors,
                                     Json& document, std::vector<std::uint8_t>& placed);

// Adds morph targets, joints and weights to a primitive of the mesh, and takes attributes that
// depend on the pose from where no weight or joint has bent them.
void write_deformation(const DeformedMesh& deformed, const AccessorWriter& accessors,
                       Json& primitive);

}  // namespace delray::scenes::internal
