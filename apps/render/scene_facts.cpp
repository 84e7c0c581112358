// Hashes the beginning and the end of each array with XXH3, so that the cost hardly grows with the
// scene.
#include "apps/render/scene_facts.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <memory>
#include <span>
#include <string>

namespace delray::apps {
namespace {

class Hasher {
 public:
  Hasher() : state_(XXH3_createState(), XXH3_freeState) { XXH3_64bits_reset(state_.get()); }

  // The size, the beginning and the end of an array.
  template <class T>
  void add(const std::vector<T>& values) {
    const std::span<const std::byte> bytes = std::as_bytes(std::span<const T>(values));
    constexpr std::size_t kMost = 65536;
    add_value(bytes.size());
    add_bytes(bytes.first(std::min(kMost, bytes.size())));
    add_bytes(bytes.last(std::min(kMost, bytes.size())));
  }
  // REQUIRES: no bytes of T are padding.
  template <class T>
  void add_value(const T& value) {
    add_bytes(std::as_bytes(std::span<const T>(&value, 1)));
  }
  std::string text() const { return fmt::format("{:016x}", XXH3_64bits_digest(state_.get())); }

 private:
  void add_bytes(std::span<const std::byte> bytes) {
    if (!bytes.empty()) XXH3_64bits_update(state_.get(), bytes.data(), bytes.size());
  }
  std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state_;
};

template <class Things, class Add>
comm::Fact fact(const char* what, const Things& things, const Add& add) {
  Hasher hasher;
  for (const auto& thing : things) add(hasher, thing);
  return {fmt::format("the scene's {}", what),
          fmt::format("{}, hash {}", things.size(), hasher.text())};
}

}  // namespace

std::string texture_hash(const scenes::Scene& scene) {
  Hasher hasher;
  for (const scenes::Texture& texture : scene.textures) {
    hasher.add_value(texture.width);
    hasher.add_value(texture.height);
    hasher.add_value(texture.set);
    hasher.add(texture.texels);
    hasher.add(texture.radiance);
  }
  return hasher.text();
}

std::vector<comm::Fact> scene_facts(const Prepared& prepared) {
  const scenes::Scene& scene = prepared.scene;
  Hasher camera, sky;
  for (const glm::vec3& v : {prepared.camera.eye, prepared.camera.at, prepared.camera.up})
    camera.add_value(v);
  for (const float value : {prepared.camera.vertical_fov, prepared.camera.near,
                            prepared.camera.aperture, prepared.camera.focus})
    camera.add_value(value);
  for (const glm::vec3& v : {scene.environment.zenith, scene.environment.horizon,
                             scene.environment.ground, scene.environment.up})
    sky.add_value(v);
  sky.add_value(scene.environment.texture);
  sky.add_value(scene.environment.rotation);
  return {
      {"the scene's triangles", fmt::format("{}", prepared.triangles)},
      {"the scene's vertices", fmt::format("{}", prepared.vertices)},
      fact("meshes", scene.meshes,
           [](Hasher& hasher, const scenes::Mesh& mesh) {
             hasher.add(mesh.positions);
             hasher.add(mesh.normals);
             hasher.add(mesh.uvs);
             hasher.add(mesh.uvs2);
             hasher.add(mesh.colours);
             hasher.add(mesh.triangles);
             hasher.add_value(mesh.material);
             hasher.add_value(mesh.shape.kind);
             hasher.add_value(mesh.shape.in_pixels);
             hasher.add_value(mesh.shape.radius);
           }),
      fact("instances", scene.instances,
           [](Hasher& hasher, const scenes::Instance& instance) {
             hasher.add_value(instance.mesh);
             hasher.add_value(instance.transform);
           }),
      fact("materials", scene.materials,
           [](Hasher& hasher, const scenes::Material& material) {
             hasher.add_value(material.base_colour);
             hasher.add_value(material.emission);
             for (const float value : {material.metallic, material.roughness, material.transmission,
                                       material.ior, material.normal_scale, material.alpha_cutoff})
               hasher.add_value(value);
             for (const std::uint32_t texture :
                  {material.base_colour_texture, material.metallic_roughness_texture,
                   material.normal_texture, material.emission_texture})
               hasher.add_value(texture);
           }),
      {"the scene's textures",
       fmt::format("{}, hash {}", scene.textures.size(), prepared.texture_hash)},
      fact("lights", scene.lights,
           [](Hasher& hasher, const scenes::Light& light) {
             hasher.add_value(light.kind);
             for (const glm::vec3& v :
                  {light.colour, light.position, light.direction, light.edge_u, light.edge_v})
               hasher.add_value(v);
           }),
      {"the sky", "hash " + sky.text()},
      {"the camera", "hash " + camera.text()},
      {"the animation's frames", fmt::format("{}", prepared.cameras.size())},
  };
}

}  // namespace delray::apps
