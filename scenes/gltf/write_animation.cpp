// Writes the table of what moves: a node of the document for each of the table, in its order, so
// that children have higher numbers; further things on one node hang on children of it.
#include "scenes/gltf/write_animation.h"

#include <cmath>
#include <string>
#include <utility>

namespace delray::scenes::internal {
namespace {

Json json_of_node(const AnimatedNode& node) {
  Json json = Json::object();
  if (!node.name.empty()) json["name"] = node.name;
  if (node.matrix) {
    for (int i = 0; i < 16; ++i) json["matrix"].push_back((*node.matrix)[i / 4][i % 4]);
    return json;
  }
  const glm::dvec3 &t = node.translation, &s = node.scale;
  const glm::dvec4& r = node.rotation;
  if (t != glm::dvec3(0)) json["translation"] = {t.x, t.y, t.z};
  if (r != glm::dvec4(0, 0, 0, 1)) json["rotation"] = {r.x, r.y, r.z, r.w};
  if (s != glm::dvec3(1)) json["scale"] = {s.x, s.y, s.z};
  return json;
}

const char* path_name(AnimationChannel::Path path) {
  switch (path) {
    case AnimationChannel::Path::rotation:
      return "rotation";
    case AnimationChannel::Path::scale:
      return "scale";
    case AnimationChannel::Path::weights:
      return "weights";
    case AnimationChannel::Path::translation:
      break;
  }
  return "translation";
}

const char* interpolation_name(AnimationChannel::Interpolation interpolation) {
  switch (interpolation) {
    case AnimationChannel::Interpolation::step:
      return "STEP";
    case AnimationChannel::Interpolation::cubic_spline:
      return "CUBICSPLINE";
    case AnimationChannel::Interpolation::linear:
      break;
  }
  return "LINEAR";
}

void write_animation(const Animation& animation, const AccessorWriter& accessors, Json& document) {
  Json channels = Json::array(), samplers = Json::array();
  for (const AnimationChannel& channel : animation.channels) {
    const bool scalars = channel.path == AnimationChannel::Path::weights;
    const Json input = accessors.floats(channel.times, "SCALAR");
    Json& accessor = document["accessors"].back();
    accessor["min"] = {channel.times.front()};
    accessor["max"] = {channel.times.back()};
    channels.push_back({{"sampler", samplers.size()},
                        {"target", {{"node", channel.node}, {"path", path_name(channel.path)}}}});
    samplers.push_back(
        {{"input", input},
         {"output", accessors.floats(channel.values, accessor_type(scalars ? 1 : channel.width))},
         {"interpolation", interpolation_name(channel.interpolation)}});
  }
  Json json = {{"channels", std::move(channels)}, {"samplers", std::move(samplers)}};
  if (!animation.name.empty()) json["name"] = animation.name;
  document["animations"].push_back(std::move(json));
}

void write_skin(const Skin& skin, const AccessorWriter& accessors, Json& document) {
  std::vector<float> matrices;
  for (const glm::dmat4& m : skin.to_joint)
    for (int i = 0; i < 16; ++i) matrices.push_back(static_cast<float>(m[i / 4][i % 4]));
  document["skins"].push_back(
      {{"joints", skin.joints}, {"inverseBindMatrices", accessors.floats(matrices, "MAT4")}});
}

std::span<const float> floats_of(std::span<const glm::vec3> values) {
  return {&values.data()->x, values.size() * 3};
}

// Nodes of the document that hang on those of the table.
class NodeWriter {
 public:
  NodeWriter(Json& document, std::size_t nodes) : document_(document), has_mesh_(nodes, 0) {}

  void place(std::uint32_t node, Json&& mesh) {
    Json& nodes = document_["nodes"];
    if (has_mesh_[node] == 0) {
      has_mesh_[node] = 1;
      nodes[node].update(mesh);
      return;
    }
    const std::size_t child = nodes.size();
    nodes.push_back(std::move(mesh));
    nodes[node]["children"].push_back(child);
  }

 private:
  Json& document_;
  std::vector<std::uint8_t> has_mesh_;
};

}  // namespace

const char* accessor_type(std::uint32_t components) {
  static const char* const kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
  return kTypes[components];
}

std::vector<std::size_t> write_nodes(const Scene& scene, const AccessorWriter& accessors,
                                     Json& document, std::vector<std::uint8_t>& placed) {
  const Animations& table = scene.animations;
  std::vector<std::size_t> top;
  for (std::size_t i = 0; i < table.nodes.size(); ++i) {
    document["nodes"].push_back(json_of_node(table.nodes[i]));
    const std::uint32_t parent = table.nodes[i].parent;
    if (parent == kNone) {
      top.push_back(i);
    } else {
      document["nodes"][parent]["children"].push_back(i);
    }
  }
  NodeWriter writer(document, table.nodes.size());
  std::vector<const DeformedMesh*> bends(scene.meshes.size(), nullptr);
  for (const DeformedMesh& deformed : table.meshes) bends[deformed.mesh] = &deformed;
  std::vector<std::uint32_t> follows(scene.instances.size(), kNone);
  for (const Follower& follower : table.instances) follows[follower.number] = follower.node;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const std::uint32_t mesh = scene.instances[i].mesh;
    const DeformedMesh* const deformed = bends[mesh];
    if (deformed == nullptr && follows[i] == kNone) continue;
    placed[i] = 1;
    Json json = {{"mesh", mesh}};
    if (deformed != nullptr) {
      if (deformed->skin != kNone) json["skin"] = deformed->skin;
      const std::vector<float>& weights = table.nodes[deformed->node].weights;
      if (!weights.empty()) json["weights"] = weights;
    }
    writer.place(deformed != nullptr ? deformed->node : follows[i], std::move(json));
  }
  for (const Skin& skin : table.skins) write_skin(skin, accessors, document);
  for (const Animation& animation : table.animations)
    write_animation(animation, accessors, document);
  return top;
}

void write_deformation(const DeformedMesh& deformed, const AccessorWriter& accessors,
                       Json& primitive) {
  for (const MorphTarget& target : deformed.deformation.targets) {
    Json json = Json::object();
    const auto add = [&](const char* name, const std::vector<glm::vec3>& values) {
      if (!values.empty()) json[name] = accessors.floats(floats_of(values), "VEC3");
    };
    add("POSITION", target.positions);
    add("NORMAL", target.normals);
    add("TANGENT", target.tangents);
    primitive["targets"].push_back(std::move(json));
  }
  const Deformation& by = deformed.deformation;
  constexpr std::uint32_t kOfSet = 4;
  for (std::uint32_t set = 0; set * kOfSet < by.influences; ++set) {
    std::vector<std::uint16_t> joints;
    std::vector<float> weights;
    for (std::size_t i = 0; i < deformed.positions.size(); ++i) {
      for (std::uint32_t k = set * kOfSet; k < (set + 1) * kOfSet; ++k) {
        const bool is_there = k < by.influences;
        joints.push_back(is_there ? by.joints[i * by.influences + k] : std::uint16_t{0});
        weights.push_back(is_there ? by.weights[i * by.influences + k] : 0.0F);
      }
    }
    primitive["attributes"]["JOINTS_" + std::to_string(set)] = accessors.joints(joints);
    primitive["attributes"]["WEIGHTS_" + std::to_string(set)] = accessors.floats(weights, "VEC4");
  }
}

}  // namespace delray::scenes::internal
