// Loads a glTF scene: walks the nodes depth first with an explicit stack, reads each mesh once, and
// places cameras and lights after the origin is chosen.
//
// A node with two parents is bad input, which also ends cycles. Transforms are multiplied in double
// precision. What moves is put at rest. Degenerate: rotations of length 0 are left out; without
// scenes all nodes without a parent are shown.
#include "scenes/gltf/load_gltf.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <numbers>
#include <optional>
#include <unordered_map>

#include "parallel/parallel_for.h"
#include "scenes/animation/deform.h"
#include "scenes/animation/followers.h"
#include "scenes/files/triangle_file.h"
#include "scenes/gltf/gltf_animation.h"
#include "scenes/gltf/gltf_document.h"
#include "scenes/gltf/gltf_extras.h"
#include "scenes/gltf/gltf_material.h"
#include "scenes/gltf/gltf_mesh.h"
#include "scenes/gltf/gltf_motion.h"
#include "scenes/gltf/gltf_origin.h"

namespace delray::scenes::internal {
namespace {

// Walks the nodes and places what they hold.
class Placer {
 public:
  // Meshes are as `read` gives them.
  using ReadMesh = std::vector<GltfPrimitive>(std::size_t mesh, std::span<GltfMaterial> materials,
                                              bool has_skin);
  Placer(const GltfDocument& document, Scene& scene, std::function<ReadMesh> read)
      : document_(document),
        root_(document.root()),
        scene_(scene),
        read_(std::move(read)),
        motion_(document) {
    TextureFiles textures(document.source, scene.textures);
    materials_ = read_materials(document, textures);
    for (const GltfMaterial& m : materials_) scene.materials.push_back(m.material);
    meshes_.resize(root_["meshes"].size());
    mesh_is_read_.resize(meshes_.size(), false);
  }

  // Finds instances and their transforms; what bends has its shape at rest.
  void find_all() {
    struct Entry {
      std::uint32_t node;
      glm::dmat4 parent;
      std::uint32_t parent_number;
    };
    const JsonView nodes = root_["nodes"];
    std::vector<bool> placed(nodes.size(), false);
    std::vector<Entry> stack;
    for (const std::uint32_t node : top_nodes()) stack.push_back({node, glm::dmat4(1.0), kNone});
    while (!stack.empty()) {
      const Entry entry = stack.back();
      stack.pop_back();
      const JsonView node = nodes[entry.node];
      if (placed[entry.node]) node.fail("has two parents");
      placed[entry.node] = true;
      const AnimatedNode own = read_node(node);
      const glm::dmat4 local = transform_of(own);
      const glm::dmat4 world = entry.parent_number == kNone && entry.parent == glm::dmat4(1.0)
                                   ? local
                                   : entry.parent * local;
      const std::uint32_t number = motion_.add(entry.node, entry.parent_number, own);
      place(node, number, world);
      const JsonView children = node["children"];
      for (std::size_t i = children.size(); i-- > 0;) {
        stack.push_back({children[i].reference(nodes.size()), world, number});
        if (stack.back().node == kNone) children[i].fail("is missing");
      }
    }
    motion_.bend(scene_);
  }
  std::span<const glm::dmat4> worlds() const { return worlds_; }
  std::span<const GltfMaterial> materials() const { return materials_; }
  // After that, and the choice of an origin; the vertices of meshes are relative to `centres`.
  void place_others_and_finish(std::span<const glm::dvec3> centres) {
    for (Other& other : others_) {
      other.world[3] -= glm::dvec4(scene_.origin, 0.0);
      place_others(other);
    }
    motion_.finish(centres, scene_);
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

  // A node with cameras or lights.
  struct Other {
    JsonView node;
    std::uint32_t number;
    glm::dmat4 world;
  };

  void place(const JsonView& node, std::uint32_t number, const glm::dmat4& world) {
    const std::uint32_t mesh = node["mesh"].reference(meshes_.size());
    const std::uint32_t skin = node["skin"].reference(root_["skins"].size());
    if (mesh != kNone) {
      const std::size_t targets = target_count(document_, mesh);
      if (targets > 0 || skin != kNone) {
        place_deformed(node, number, skin, world);
      } else {
        for (const std::uint32_t part : mesh_parts(mesh)) place_mesh(part, number, false, world);
      }
    }
    if (node["camera"] || node["extensions"]) others_.push_back({node, number, world});
  }

  void place_mesh(std::uint32_t mesh, std::uint32_t number, bool skinned, const glm::dmat4& world) {
    scene_.instances.push_back({mesh});
    worlds_.push_back(skinned ? glm::dmat4(1.0) : world);
    motion_.add_instance(number, skinned);
  }

  // Each node has meshes of its own then, since their vertices depend on its weights and joints.
  void place_deformed(const JsonView& node, std::uint32_t number, std::uint32_t skin,
                      const glm::dmat4& world) {
    const std::uint32_t mesh = node["mesh"].reference(meshes_.size());
    motion_.weights_of(number) = read_weights(document_, node, target_count(document_, mesh));
    for (GltfPrimitive& part : read_(mesh, materials_, skin != kNone)) {
      if (part.mesh.triangles.empty()) continue;
      complete_material(part.mesh);
      DeformedMesh deformed =
          make_deformed(part.mesh, std::move(part.deformation), completion_of(part.mesh));
      deformed.mesh = static_cast<std::uint32_t>(scene_.meshes.size());
      deformed.node = number;
      deformed.skin = skin;
      scene_.meshes.push_back(std::move(part.mesh));
      place_mesh(deformed.mesh, number, skin != kNone, world);
      motion_.add_deformed(std::move(deformed));
    }
  }

  Completion completion_of(const Mesh& mesh) const {
    Completion completion;
    const std::uint32_t texture = scene_.materials[mesh.material].normal_texture;
    if (texture < scene_.textures.size()) completion.tangents_of_set = scene_.textures[texture].set;
    return completion;
  }

  void place_others(const Other& other) {
    const JsonView cameras = root_["cameras"], &node = other.node;
    const std::uint32_t camera = node["camera"].reference(cameras.size());
    if (camera != kNone) {
      place_camera(cameras[camera], node["name"].text(), other.world);
      motion_.add_camera(other.number, static_cast<std::uint32_t>(scene_.cameras.size() - 1));
    }
    const JsonView lights = root_["extensions"]["KHR_lights_punctual"]["lights"];
    const std::uint32_t light =
        node["extensions"]["KHR_lights_punctual"]["light"].reference(lights.size());
    if (light != kNone) {
      place_light(lights[light], other.world);
      motion_.add_light(other.number, static_cast<std::uint32_t>(scene_.lights.size() - 1));
    }
  }

  void complete_material(Mesh& part) {
    if (part.material == kNone) part.material = default_material();
    // Light means nothing to them.
    if (!part.has_triangles() && part.normals.empty()) part.material = unlit(part.material);
  }

  const std::vector<std::uint32_t>& mesh_parts(std::uint32_t mesh) {
    if (mesh_is_read_[mesh]) return meshes_[mesh];
    mesh_is_read_[mesh] = true;
    for (GltfPrimitive& part : read_(mesh, materials_, false)) {
      if (part.mesh.triangles.empty()) continue;
      complete_material(part.mesh);
      meshes_[mesh].push_back(static_cast<std::uint32_t>(scene_.meshes.size()));
      scene_.meshes.push_back(std::move(part.mesh));
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
    follow(world, camera);
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
    follow(world, light);
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
  std::function<ReadMesh> read_;
  std::vector<GltfMaterial> materials_;
  std::vector<std::vector<std::uint32_t>> meshes_;  // the scene's meshes of each mesh of the file
  std::vector<bool> mesh_is_read_;
  std::uint32_t default_material_ = kNone;
  std::unordered_map<std::uint32_t, std::uint32_t> unlit_;  // by the material with light
  std::vector<glm::dmat4> worlds_;                          // of the scene's instances
  std::vector<Other> others_;
  GltfMotion motion_;
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

void read_extras_of(const GltfDocument& document, Scene& scene) {
  const JsonView root = document.root(), scenes = root["scenes"];
  const std::uint32_t chosen = root["scene"].reference(scenes.size());
  if (scenes.size() > 0) read_extras(scenes[chosen == kNone ? 0 : chosen]["extras"], scene);
}

// One mesh of one primitive that is placed once, in a document where nothing moves.
class GltfTriangleFile final : public TriangleFile {
 public:
  explicit GltfTriangleFile(const Source& source) : document_(read_document(source)) {}

  // Whether it is that.
  bool open() {
    if (has_motion(document_)) return false;
    Placer placer(document_, rest_, [&](std::size_t mesh, std::span<GltfMaterial>, bool) {
      meshes_.push_back(mesh);
      Mesh stands_for_it;
      const JsonView json = document_.root()["meshes"][mesh], primitives = json["primitives"];
      stands_for_it.name = json["name"].text();
      stands_for_it.triangles.resize(1);
      stands_for_it.material =
          primitives.size() == 1
              ? primitives[std::size_t{0}]["material"].reference(rest_.materials.size())
              : kNone;
      return std::vector{GltfPrimitive{std::move(stands_for_it), {}}};
    });
    placer.find_all();
    if (rest_.instances.size() != 1) return false;
    rest_.meshes[0].triangles.clear();
    const JsonView primitives = document_.root()["meshes"][meshes_[0]]["primitives"];
    if (primitives.size() != 1) return false;
    const std::uint32_t material =
        primitives[std::size_t{0}]["material"].reference(placer.materials().size());
    if (material != kNone) material_ = placer.materials()[material];
    if (!has_runs(document_, primitives[std::size_t{0}], material_)) return false;
    primitive_.emplace(primitives[std::size_t{0}]);
    const std::size_t accessors = document_.root()["accessors"].size();
    indices_ = primitives[std::size_t{0}]["indices"].reference(accessors);
    triangles_ = element_count(document_, indices_) / 3;
    vertices_ = element_count(
        document_, primitives[std::size_t{0}]["attributes"]["POSITION"].reference(accessors));
    world_ = placer.worlds()[0];
    const glm::dvec3 centre(0);
    rest_.instances[0].transform = placed_at(world_, centre, rest_.origin);
    placer.place_others_and_finish({&centre, 1});
    read_extras_of(document_, rest_);
    return std::ranges::none_of(rest_.cameras, &Camera::orthographic);
  }

  bool read_triangles(std::uint64_t first, std::span<glm::uvec3> to) const override {
    constexpr std::size_t kBlock = 1 << 14;  // triangles: some hundred kilobytes
    const auto count = static_cast<std::uint32_t>(vertices_);
    std::atomic<bool> good{true};
    parallel::parallel_blocks(0, to.size(), kBlock, [&](std::size_t begin, std::size_t end) {
      const std::span<glm::uvec3> block = to.subspan(begin, end - begin);
      read_index_triples(document_, indices_, first + begin, block);
      const bool fits = std::ranges::all_of(
          block, [&](const glm::uvec3& t) { return t.x < count && t.y < count && t.z < count; });
      if (!fits) good = false;
    });
    return good;
  }

  Mesh read_vertices(std::uint64_t first, std::uint64_t last) const override {
    return internal::read_vertices(document_, *primitive_, material_, first, last);
  }

  std::optional<glm::dvec3> origin(const geometry::Box3d&,
                                   const geometry::Box3d& used) const override {
    if (internal::is_far(rest_, {&world_, 1}, {&used, 1})) return std::nullopt;
    return glm::dvec3(0);
  }
  void warn(const geometry::Box3d&) const override {}

 private:
  GltfDocument document_;
  std::vector<std::size_t> meshes_;
  GltfMaterial material_;
  std::optional<JsonView> primitive_;
  std::uint32_t indices_ = 0;
  glm::dmat4 world_{1.0};
};

}  // namespace

Scene load_gltf(const Source& source) {
  const GltfDocument document = read_document(source);
  Scene scene;
  const auto read = [&](std::size_t mesh, std::span<GltfMaterial> materials, bool has_skin) {
    return read_mesh(document, mesh, materials, has_skin);
  };
  Placer placer(document, scene, read);
  placer.find_all();
  const std::vector<glm::dvec3> centres = place_instances(source, placer.worlds(), scene);
  placer.place_others_and_finish(centres);
  set_depths_of_orthographic_cameras(scene);
  read_extras_of(document, scene);
  return scene;
}

std::unique_ptr<TriangleFile> open_gltf_triangles(const Source& source) {
  auto file = std::make_unique<GltfTriangleFile>(source);
  if (!file->open()) return nullptr;
  return file;
}

}  // namespace delray::scenes::internal
