// Reads what moves: nodes with their transforms, joints of skins with the inverses of their bind
// matrices, key frames of channels. Everything is checked against everything else that it names.
#include "scenes/gltf/gltf_animation.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

namespace delray::scenes::internal {
namespace {

using Path = AnimationChannel::Path;
using Interpolation = AnimationChannel::Interpolation;

Interpolation interpolation_of(const JsonView& sampler) {
  const std::string name = sampler["interpolation"].text("LINEAR");
  if (name == "STEP") return Interpolation::step;
  if (name == "LINEAR") return Interpolation::linear;
  if (name == "CUBICSPLINE") return Interpolation::cubic_spline;
  sampler["interpolation"].fail("should be STEP, LINEAR or CUBICSPLINE");
}

std::uint32_t required_reference(const JsonView& json, std::size_t count) {
  const std::uint32_t number = json.reference(count);
  if (number == kNone) json.fail("is missing");
  return number;
}

std::vector<float> read_times(const GltfDocument& document, const JsonView& sampler) {
  const JsonView input = sampler["input"];
  const std::size_t accessors = document.root()["accessors"].size();
  std::vector<float> times = read_floats(document, required_reference(input, accessors), 1);
  if (times.empty()) input.fail("has no key frames");
  if (times.front() < 0) input.fail("key frame 0 is before 0 seconds");
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (!(times[i] > times[i - 1]))
      input.fail("key frame " + std::to_string(i) + " is not after the one before");
  }
  return times;
}

AnimationChannel read_sampler(const GltfDocument& document, const JsonView& sampler, Path path,
                              std::uint32_t width) {
  AnimationChannel channel;
  channel.path = path;
  channel.width = width;
  channel.interpolation = interpolation_of(sampler);
  channel.times = read_times(document, sampler);
  const JsonView output = sampler["output"];
  const int components = path == Path::weights ? 1 : static_cast<int>(width);
  const std::size_t accessors = document.root()["accessors"].size();
  channel.values = read_floats(document, required_reference(output, accessors), components);
  const std::size_t of_key =
      std::size_t{width} * (channel.interpolation == Interpolation::cubic_spline ? 3 : 1);
  if (channel.values.size() != channel.times.size() * of_key) {
    output.fail("has " + std::to_string(channel.values.size()) + " numbers for " +
                std::to_string(channel.times.size()) + " key frames of " + std::to_string(of_key));
  }
  return channel;
}

}  // namespace

bool has_motion(const GltfDocument& document) {
  const JsonView root = document.root();
  if (root["animations"].size() > 0 || root["skins"].size() > 0) return true;
  const JsonView meshes = root["meshes"];
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const JsonView primitives = meshes[m]["primitives"];
    for (std::size_t p = 0; p < primitives.size(); ++p)
      if (primitives[p]["targets"].size() > 0) return true;
  }
  return false;
}

AnimatedNode read_node(const JsonView& node) {
  AnimatedNode result;
  result.name = node["name"].text();
  const JsonView matrix = node["matrix"];
  if (matrix) {
    if (matrix.size() != 16) matrix.fail("needs 16 numbers");
    result.matrix.emplace(1.0);
    for (int i = 0; i < 16; ++i)
      (*result.matrix)[i / 4][i % 4] = matrix[static_cast<std::size_t>(i)].number(0);
    return result;
  }
  result.translation = node["translation"].vector<3>({0, 0, 0});
  result.rotation = node["rotation"].vector<4>({0, 0, 0, 1});
  result.scale = node["scale"].vector<3>({1, 1, 1});
  return result;
}

std::size_t target_count(const GltfDocument& document, std::size_t mesh) {
  const JsonView primitives = document.root()["meshes"][mesh]["primitives"];
  std::size_t count = 0;
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    const JsonView targets = primitives[p]["targets"];
    if (p > 0 && targets.size() != count) {
      targets.fail("has " + std::to_string(targets.size()) +
                   " morph targets, the first primitive " + std::to_string(count));
    }
    count = targets.size();
  }
  return count;
}

std::vector<float> read_weights(const GltfDocument& document, const JsonView& node,
                                std::size_t targets) {
  const JsonView root = document.root();
  const std::uint32_t mesh = node["mesh"].reference(root["meshes"].size());
  const JsonView of_mesh = root["meshes"][mesh]["weights"];
  const JsonView json = node["weights"] ? node["weights"] : of_mesh;
  if (!json) return std::vector<float>(targets, 0.0F);
  if (json.size() != targets) {
    json.fail("has " + std::to_string(json.size()) + " weights for " + std::to_string(targets) +
              " morph targets");
  }
  std::vector<float> weights;
  for (std::size_t i = 0; i < targets; ++i)
    weights.push_back(static_cast<float>(json[i].number(0)));
  return weights;
}

std::vector<Skin> read_skins(const GltfDocument& document, std::span<const std::uint32_t> numbers) {
  const JsonView root = document.root(), skins = root["skins"];
  std::vector<Skin> result(skins.size());
  for (std::size_t s = 0; s < skins.size(); ++s) {
    Skin& skin = result[s];
    const JsonView joints = skins[s]["joints"];
    if (joints.size() == 0) joints.fail("should name at least one node");
    for (std::size_t j = 0; j < joints.size(); ++j) {
      skin.joints.push_back(numbers[required_reference(joints[j], numbers.size())]);
      if (skin.joints.back() == kNone) joints[j].fail("is a node that the scene does not show");
    }
    skin.to_joint.assign(joints.size(), glm::dmat4(1.0));
    const JsonView matrices = skins[s]["inverseBindMatrices"];
    const std::uint32_t accessor = matrices.reference(root["accessors"].size());
    if (accessor == kNone) continue;
    constexpr std::size_t kNumbers = 16;
    const std::vector<float> values = read_floats(document, accessor, kNumbers);
    if (values.size() < joints.size() * kNumbers) {
      matrices.fail("has " + std::to_string(values.size() / kNumbers) + " matrices for " +
                    std::to_string(joints.size()) + " joints");
    }
    for (std::size_t j = 0; j < joints.size(); ++j) {
      for (int k = 0; k < static_cast<int>(kNumbers); ++k)
        skin.to_joint[j][k / 4][k % 4] = double{values[j * kNumbers + static_cast<std::size_t>(k)]};
    }
  }
  return result;
}

std::vector<Animation> read_animations(const GltfDocument& document,
                                       std::span<const std::uint32_t> numbers,
                                       std::span<const AnimatedNode> nodes) {
  const JsonView animations = document.root()["animations"];
  std::vector<Animation> result(animations.size());
  for (std::size_t a = 0; a < animations.size(); ++a) {
    result[a].name = animations[a]["name"].text();
    const JsonView channels = animations[a]["channels"], samplers = animations[a]["samplers"];
    std::set<std::pair<std::uint32_t, Path>> known;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const JsonView target = channels[c]["target"];
      const std::uint32_t of_document = target["node"].reference(numbers.size());
      const std::string name = target["path"].text();
      const std::uint32_t sampler = required_reference(channels[c]["sampler"], samplers.size());
      if (of_document == kNone || numbers[of_document] == kNone) continue;
      const std::uint32_t node = numbers[of_document];
      Path path = Path::translation;
      auto width = std::uint32_t{3};
      if (name == "rotation") {
        path = Path::rotation;
        width = 4;
      } else if (name == "scale") {
        path = Path::scale;
      } else if (name == "weights") {
        path = Path::weights;
        width = static_cast<std::uint32_t>(nodes[node].weights.size());
        if (width == 0) target.fail("has weights of a node without morph targets");
      } else if (name != "translation") {
        if (!target["extensions"])
          target["path"].fail("should be translation, rotation, scale or weights");
        document.source.warn(target.place() + ": '" + name + "' is left out");
        continue;
      }
      if (path != Path::weights && nodes[node].matrix)
        target.fail("moves a node with a matrix, which has no translation, rotation and scale");
      if (!known.insert({node, path}).second)
        target.fail("is moved by another channel of this animation, too");
      result[a].channels.push_back(read_sampler(document, samplers[sampler], path, width));
      result[a].channels.back().node = node;
    }
  }
  return result;
}

std::vector<std::uint8_t> moving_nodes(const Animations& animations) {
  std::vector<std::uint8_t> moves(animations.nodes.size(), 0);
  for (const Animation& animation : animations.animations)
    for (const AnimationChannel& channel : animation.channels)
      if (channel.path != Path::weights) moves[channel.node] = 1;
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const std::uint32_t parent = animations.nodes[i].parent;
    if (parent != kNone && moves[parent] != 0) moves[i] = 1;
  }
  return moves;
}

}  // namespace delray::scenes::internal
