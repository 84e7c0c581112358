// Nodes, skins and animations of glTF.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scenes/gltf/gltf_document.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {

// Whether anything in the document may move or bend.
bool has_motion(const GltfDocument& document);

// A node's transform and weights, without its place in the hierarchy. Fails on a matrix that has
// not 16 numbers.
AnimatedNode read_node(const JsonView& node);

// How many morph targets meshes[number] has: of all its primitives as many. Fails where they
// differ.
std::size_t target_count(const GltfDocument& document, std::size_t mesh);

// The weights of a node's mesh with so many targets: its own, else those of its mesh, else zeros.
// Fails where there are as many weights as targets in neither.
std::vector<float> read_weights(const GltfDocument& document, const JsonView& node,
                                std::size_t targets);

// All skins. `numbers` has for each node of the document its number in the scene's table, or kNone
// for one that the scene does not show, which no skin may name.
std::vector<Skin> read_skins(const GltfDocument& document, std::span<const std::uint32_t> numbers);

// All animations, without channels of nodes that the scene does not show or of what they move that
// is no property of nodes. Fails on key frames that are no numbers, not in ascending order, or not
// as many as their values, on nodes with a matrix, and on two channels for one property.
std::vector<Animation> read_animations(const GltfDocument& document,
                                       std::span<const std::uint32_t> numbers,
                                       std::span<const AnimatedNode> nodes);

// By node of the table: whether some animation moves it, or a node that it hangs on.
std::vector<std::uint8_t> moving_nodes(const Animations& animations);

}  // namespace delray::scenes::internal
