// Loads a glTF scene: walks the nodes depth first with an explicit stack, reads each mesh once, and
// places cameras and lights after the origin is chosen.
//
// A node with two parents is bad input, which also ends cycles. Transforms are multiplied in double
// precision. Degenerate: rotations of length 0 are left out; without scenes all nodes without a
// parent are shown.
#include "scenes/gltf/load_gltf.h"

#include <algorithm>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <unordered_map>

#include "scenes/gltf/gltf_document.h"
#include "scenes/gltf/gltf_extras.h"
#include "scenes/gltf/gltf_material.h"
#include "scenes/gltf/gltf_mesh.h"
#include "scenes/gltf/gltf_origin.h"

namespace delray::scenes::internal {
namespace {

glm::dmat4 local_transform(const JsonView& node) {
  const JsonView matrix = node["matrix"];
  glm::dmat4 transform(1.0);
  if (matrix) {
    if (matrix.size() != 16) matrix.fail("needs 16 numbers");
    for (int i = 0; i < 16; ++i) {
      transform[i / 4][i % 4] = matrix[static_cast<std::size_t>(i)].number(0);
    }
    return transform;
  }
  const glm::dvec3 translation = node["translation"].vector<3>({0, 0, 0});
  const glm::dvec4 rotation = node["rotation"].vector<4>({0, 0, 0, 1});
  const glm::dvec3 scale = node["scale"].vector<3>({1, 1, 1});
  const double length = glm::length(rotation);
  if (length > 0) {
    transform = glm::mat4_cast(glm::dquat(rotation.w, rotation.x, rotation.y, rotation.z) / length);
  }
  for (int k = 0; k < 3; ++k) transform[k] *= scale[k];
  transform[3] = glm::dvec4(translation, 1.0);
  return transform;
}

glm::dvec3 unit_or(const glm::dvec3& v, const glm::dvec3& otherwise) {
  const double length = glm::length(v);
  return length > 0 ? v / length : otherwise;
}

// Walks the nodes and places what they hold.
class Placer {
 public:
  Placer(const GltfDocument& document, Scene& scene)
      : document_(document), root_(document.root()), scene_(scene) {
    TextureFiles textures(document.source, scene.textures);
    materials_ = read_materials(document, textures);
    for (const GltfMaterial& m : materials_) scene.materials.push_back(m.material);
    meshes_.resize(root_["meshes"].size());
    mesh_is_read_.resize(meshes_.size(), false);
  }

  void place_all() {
    struct Entry {
      std::uint32_t node;
      glm::dmat4 parent;
    };
    const JsonView nodes = root_["nodes"];
    std::vector<bool> placed(nodes.size(), false);
    std::vector<Entry> stack;
    for (const std::uint32_t node : top_nodes()) stack.push_back({node, glm::dmat4(1.0)});
    while (!stack.empty()) {
      const Entry entry = stack.back();
      stack.pop_back();
      const JsonView node = nodes[entry.node];
      if (placed[entry.node]) node.fail("has two parents");
      placed[entry.node] = true;
      const glm::dmat4 world = entry.parent * local_transform(node);
      place(node, world);
      const JsonView children = node["children"];
      for (std::size_t i = children.size(); i-- > 0;) {
        stack.push_back({children[i].reference(nodes.size()), world});
        if (stack.back().node == kNone) children[i].fail("is missing");
      }
    }
    place_instances(document_.source, worlds_, scene_);
    for (auto& [node, world] : others_) {
      world[3] -= glm::dvec4(scene_.origin, 0.0);
      place_others(node, world);
    }
  }

 private:
  // The roots of the scene to show, last first; without scenes, all nodes that are no one's child.
  std::vector<std::uint32_t> top_nodes() const {
    const JsonView scenes = root_["scenes"], nodes = root_["nodes"];
    std::vector<std::uint32_t> top;
    if (scenes.size() == 0) {
      std::vector<bool> is_child(nodes.size(), false);
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const JsonView children = nodes[i]["children"];
        for (std::size_t k = 0; k < children.size(); ++k) {
          const std::uint32_t child = children[k].reference(nodes.size());
          if (child == kNone) children[k].fail("is missing");
          is_child[child] = true;
        }
      }
      for (std::size_t i = nodes.size(); i-- > 0;) {
        if (!is_child[i]) top.push_back(static_cast<std::uint32_t>(i));
      }
      return top;
    }
    const std::uint32_t chosen = root_["scene"].reference(scenes.size());
    const JsonView list = scenes[chosen == kNone ? 0 : chosen]["nodes"];
    for (std::size_t i = list.size(); i-- > 0;) {
      const std::uint32_t node = list[i].reference(nodes.size());
      if (node == kNone) list[i].fail("is missing");
      top.push_back(node);
    }
    return top;
  }

  void place(const JsonView& node, const glm::dmat4& world) {
    const std::uint32_t mesh = node["mesh"].reference(meshes_.size());
    if (mesh != kNone) {
      for (const std::uint32_t part : mesh_parts(mesh)) {
        scene_.instances.push_back({part});
        worlds_.push_back(world);
      }
    }
    if (node["camera"] || node["extensions"]) others_.push_back({node, world});
  }

  void place_others(const JsonView& node, const glm::dmat4& world) {
    const JsonView cameras = root_["cameras"];
    const std::uint32_t camera = node["camera"].reference(cameras.size());
    if (camera != kNone) place_camera(cameras[camera], node["name"].text(), world);
    const JsonView lights = root_["extensions"]["KHR_lights_punctual"]["lights"];
    const std::uint32_t light =
        node["extensions"]["KHR_lights_punctual"]["light"].reference(lights.size());
    if (light != kNone) place_light(lights[light], world);
  }

  const std::vector<std::uint32_t>& mesh_parts(std::uint32_t mesh) {
    if (mesh_is_read_[mesh]) return meshes_[mesh];
    mesh_is_read_[mesh] = true;
    for (Mesh& part : read_mesh(document_, mesh, materials_)) {
      if (part.triangles.empty()) continue;
      if (part.material == kNone) part.material = default_material();
      // Light means nothing to them.
      if (!part.has_triangles() && part.normals.empty()) part.material = unlit(part.material);
      meshes_[mesh].push_back(static_cast<std::uint32_t>(scene_.meshes.size()));
      scene_.meshes.push_back(std::move(part));
    }
    return meshes_[mesh];
  }

  // The same material without light.
  std::uint32_t unlit(std::uint32_t material) {
    if (scene_.materials[material].unlit) return material;
    const auto [found, is_new] =
        unlit_.try_emplace(material, static_cast<std::uint32_t>(scene_.materials.size()));
    if (is_new) {
      scene_.materials.push_back(Material(scene_.materials[material]));
      scene_.materials.back().unlit = true;
    }
    return found->second;
  }

  std::uint32_t default_material() {
    if (default_material_ == kNone) {
      default_material_ = static_cast<std::uint32_t>(scene_.materials.size());
      scene_.materials.emplace_back();
    }
    return default_material_;
  }

  void place_camera(const JsonView& json, const std::string& node_name, const glm::dmat4& world) {
    Camera camera;
    camera.name = node_name.empty() ? json["name"].text() : node_name;
    camera.eye = glm::dvec3(world[3]);
    // Far enough from the eye for the direction to keep its precision.
    const double distance = std::max(1.0, glm::length(glm::dvec3(world[3])));
    camera.at = glm::dvec3(world[3]) - unit_or(glm::dvec3(world[2]), {0, 0, 1}) * distance;
    camera.up = unit_or(glm::dvec3(world[1]), {0, 1, 0});
    const JsonView orthographic = json["orthographic"], perspective = json["perspective"];
    if (orthographic) {
      // The frame's height is that of the file, its width what the picture's shape asks for.
      const double half = std::abs(orthographic["ymag"].number(1));
      if (!(half > 1e-18)) orthographic["ymag"].fail("should not be 0");
      camera.height = static_cast<float>(2 * half);
    } else {
      const double degrees = perspective["yfov"].number(0.7) * (180 / std::numbers::pi);
      if (!(degrees > 0 && degrees < 180)) perspective["yfov"].fail("is not between 0 and pi");
      camera.vertical_fov = static_cast<float>(degrees);
    }
    const JsonView near = (orthographic ? orthographic : perspective)["znear"];
    camera.near = static_cast<float>(near.number(0, 0, 1e18));
    scene_.cameras.push_back(camera);
  }

  void place_light(const JsonView& json, const glm::dmat4& world) {
    const std::string type = json["type"].text();
    Light light;
    light.colour =
        json["color"].non_negative_vector<3>({1, 1, 1}) * json["intensity"].non_negative(1);
    light.position = glm::dvec3(world[3]);
    light.direction = -unit_or(glm::dvec3(world[2]), {0, 0, 1});
    light.kind = type == "directional" ? Light::Kind::directional : Light::Kind::point;
    if (type == "spot") document_.source.warn(json.place() + ": a spot light shines all around");
    if (type != "directional" && type != "point" && type != "spot") {
      json["type"].fail("should be directional, point or spot");
    }
    scene_.lights.push_back(light);
  }

  const GltfDocument& document_;
  JsonView root_;
  Scene& scene_;
  std::vector<GltfMaterial> materials_;
  std::vector<std::vector<std::uint32_t>> meshes_;  // the scene's meshes of each mesh of the file
  std::vector<bool> mesh_is_read_;
  std::uint32_t default_material_ = kNone;
  std::unordered_map<std::uint32_t, std::uint32_t> unlit_;  // by the material with light
  std::vector<glm::dmat4> worlds_;                          // of the scene's instances
  std::vector<std::pair<JsonView, glm::dmat4>> others_;     // nodes with cameras and lights
};

// Their depths are told apart best between the nearest and the farthest that there is.
void set_depths_of_orthographic_cameras(Scene& scene) {
  const auto is_orthographic = [](const Camera& camera) { return camera.orthographic(); };
  if (std::none_of(scene.cameras.begin(), scene.cameras.end(), is_orthographic)) return;
  const geometry::Box3 box = bounds(scene);
  if (box.empty()) return;
  for (Camera& camera : scene.cameras) {
    if (!camera.orthographic()) continue;
    const View view = make_view(camera, 1, 1);
    const glm::dvec3 forward(view.forward);
    const double middle = glm::dot(forward, glm::dvec3(box.centre()) - glm::dvec3(view.eye));
    const double reach = glm::dot(glm::abs(forward), glm::dvec3(box.size())) * 0.501;
    camera.near = std::max(camera.near, static_cast<float>(middle - reach));
    camera.far = std::max(camera.near, static_cast<float>(middle + reach));
  }
}

}  // namespace

Scene load_gltf(const Source& source) {
  const GltfDocument document = read_document(source);
  Scene scene;
  Placer(document, scene).place_all();
  set_depths_of_orthographic_cameras(scene);
  const JsonView root = document.root(), scenes = root["scenes"];
  const std::uint32_t chosen = root["scene"].reference(scenes.size());
  if (scenes.size() > 0) read_extras(scenes[chosen == kNone ? 0 : chosen]["extras"], scene);
  if (root["skins"].size() > 0) source.warn("skins are left out: meshes have their rest shape");
  if (root["animations"].size() > 0) source.warn("animations are left out");
  return scene;
}

}  // namespace delray::scenes::internal
