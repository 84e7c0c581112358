// Writes a material's base colours, and in extensions whatever differs from glTF's own model:
// transmission and volume, specular colours, coat, sheen, bright emission.
#include "scenes/gltf/write_material.h"

#include <algorithm>
#include <utility>

namespace delray::scenes::internal {
namespace {

class MaterialWriter {
 public:
  MaterialWriter(const Scene& scene, Json& document) : scene_(scene), document_(document) {}

  Json write(const Material& material) {
    Json base = {{"baseColorFactor", json_of(material.base_colour)},
                 {"metallicFactor", material.metallic},
                 {"roughnessFactor", material.roughness}};
    refer(base, "baseColorTexture", material.base_colour_texture);
    refer(base, "metallicRoughnessTexture", material.metallic_roughness_texture);
    Json json = {{"pbrMetallicRoughness", std::move(base)}, {"doubleSided", material.double_sided}};
    if (!material.name.empty()) json["name"] = material.name;
    refer(json, "normalTexture", material.normal_texture);
    if (material.normal_texture != kNone) json["normalTexture"]["scale"] = material.normal_scale;
    refer(json, "emissiveTexture", material.emission_texture);
    add_emission(material, json);
    if (material.alpha == Material::Alpha::blend) json["alphaMode"] = "BLEND";
    if (material.alpha == Material::Alpha::mask) {
      json["alphaMode"] = "MASK";
      json["alphaCutoff"] = material.alpha_cutoff;
    }
    add_transmission(material, json);
    add_reflection(material, json);
    if (material.unlit) extend(json, "KHR_materials_unlit", Json::object());
    return json;
  }

 private:
  void refer(Json& json, const char* key, std::uint32_t texture) const {
    if (texture == kNone) return;
    json[key] = {{"index", texture}};
    if (texture < scene_.textures.size() && scene_.textures[texture].set != 0)
      json[key]["texCoord"] = 1;
  }

  void extend(Json& json, const char* name, Json&& extension) {
    use_extension(name, document_);
    json["extensions"][name] = std::move(extension);
  }

  void add_transmission(const Material& material, Json& json) {
    if (!(material.transmission > 0)) return;
    Json transmission = {{"transmissionFactor", material.transmission}};
    refer(transmission, "transmissionTexture", material.transmission_texture);
    extend(json, "KHR_materials_transmission", std::move(transmission));
    if (!(material.thickness > 0)) return;
    Json volume = {{"thicknessFactor", material.thickness}};
    if (std::isfinite(material.attenuation_distance)) {
      volume["attenuationDistance"] = material.attenuation_distance;
      volume["attenuationColor"] = json_of(material.attenuation_colour);
    }
    extend(json, "KHR_materials_volume", std::move(volume));
  }

  // Reflection besides the colours of the base.
  void add_reflection(const Material& material, Json& json) {
    const Material plain;
    if (material.ior != plain.ior) extend(json, "KHR_materials_ior", {{"ior", material.ior}});
    if (material.specular != plain.specular || material.specular_colour != plain.specular_colour ||
        material.specular_texture != kNone || material.specular_colour_texture != kNone) {
      Json specular = {{"specularFactor", material.specular},
                       {"specularColorFactor", json_of(material.specular_colour)}};
      refer(specular, "specularTexture", material.specular_texture);
      refer(specular, "specularColorTexture", material.specular_colour_texture);
      extend(json, "KHR_materials_specular", std::move(specular));
    }
    if (material.clearcoat > 0) {
      Json coat = {{"clearcoatFactor", material.clearcoat},
                   {"clearcoatRoughnessFactor", material.clearcoat_roughness}};
      refer(coat, "clearcoatTexture", material.clearcoat_texture);
      refer(coat, "clearcoatRoughnessTexture", material.clearcoat_roughness_texture);
      extend(json, "KHR_materials_clearcoat", std::move(coat));
    }
    if (material.sheen_colour != plain.sheen_colour) {
      Json sheen = {{"sheenColorFactor", json_of(material.sheen_colour)},
                    {"sheenRoughnessFactor", material.sheen_roughness}};
      refer(sheen, "sheenColorTexture", material.sheen_colour_texture);
      refer(sheen, "sheenRoughnessTexture", material.sheen_roughness_texture);
      extend(json, "KHR_materials_sheen", std::move(sheen));
    }
  }

  // The factor may be at most 1; what is brighter needs a strength beside it.
  void add_emission(const Material& material, Json& json) {
    const glm::vec3& emission = material.emission;
    const float brightest = std::max({emission.x, emission.y, emission.z});
    if (!(brightest > 0)) return;
    const float strength = brightest > 1 ? power_of_two_above(brightest) : 1.0F;
    json["emissiveFactor"] = json_of(emission / strength);
    if (strength == 1.0F) return;
    extend(json, "KHR_materials_emissive_strength", {{"emissiveStrength", strength}});
  }

  const Scene& scene_;
  Json& document_;
};

}  // namespace

void use_extension(const char* name, Json& document) {
  Json& used = document["extensionsUsed"];
  if (std::find(used.begin(), used.end(), name) == used.end()) used.push_back(name);
}

Json write_material(const Material& material, const Scene& scene, Json& document) {
  return MaterialWriter(scene, document).write(material);
}

}  // namespace delray::scenes::internal
