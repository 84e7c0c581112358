// Writes and reads the environment and area lights as JSON; positions are those of the file, so the
// scene's origin is added and subtracted.
#include "scenes/gltf/gltf_extras.h"

namespace delray::scenes::internal {
namespace {

Json json_of(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

glm::vec3 direction(const JsonView& json, const glm::vec3& otherwise) {
  const glm::dvec3 v = json.vector<3>(otherwise);
  return glm::length(v) > 0 ? glm::vec3(v) : otherwise;
}

glm::vec3 radiance(const JsonView& json) { return json.non_negative_vector<3>({0, 0, 0}); }

}  // namespace

Json extras_of(const Scene& scene) {
  Json extras;
  const Environment& sky = scene.environment;
  if (sky.zenith != glm::vec3(0) || sky.horizon != glm::vec3(0) || sky.ground != glm::vec3(0)) {
    extras["environment"] = {{"up", json_of(sky.up)},
                             {"zenith", json_of(sky.zenith)},
                             {"horizon", json_of(sky.horizon)},
                             {"ground", json_of(sky.ground)}};
  }
  for (const Light& light : scene.lights) {
    if (light.kind != Light::Kind::area) continue;
    extras["area_lights"].push_back(
        {{"radiance", json_of(light.colour)},
         {"position", json_of(glm::dvec3(light.position) + scene.origin)},
         {"edge_u", json_of(light.edge_u)},
         {"edge_v", json_of(light.edge_v)}});
  }
  if (extras.is_null()) return extras;
  return {{"delray", extras}};
}

void read_extras(const JsonView& extras, Scene& scene) {
  if (!extras.is_object()) return;
  const JsonView own = extras["delray"];
  if (!own.is_object()) return;
  const JsonView sky = own["environment"];
  if (sky) {
    scene.environment.up = direction(sky["up"], {0, 1, 0});
    scene.environment.zenith = radiance(sky["zenith"]);
    scene.environment.horizon = radiance(sky["horizon"]);
    scene.environment.ground = radiance(sky["ground"]);
  }
  const JsonView lights = own["area_lights"];
  for (std::size_t i = 0; i < lights.size(); ++i) {
    Light light;
    light.kind = Light::Kind::area;
    light.colour = radiance(lights[i]["radiance"]);
    light.position = lights[i]["position"].vector<3>({0, 0, 0}) - scene.origin;
    light.edge_u = lights[i]["edge_u"].vector<3>({0, 0, 0});
    light.edge_v = lights[i]["edge_v"].vector<3>({0, 0, 0});
    scene.lights.push_back(light);
  }
}

}  // namespace delray::scenes::internal
