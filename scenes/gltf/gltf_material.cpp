// Reads materials with their extensions and numbers the kinds of texture coordinates that each one
// uses. Factors are clamped to what the renderers take; what is not supported becomes a warning.
#include "scenes/gltf/gltf_material.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace delray::scenes::internal {
namespace {

Texture::Wrap wrap_of(const JsonView& mode) {
  switch (mode.whole(10497)) {
    case 33071:
      return Texture::Wrap::clamp;
    case 33648:
      return Texture::Wrap::mirror;
    default:
      return Texture::Wrap::repeat;
  }
}

std::uint32_t read_image(const GltfDocument& document, std::uint32_t number, const TextureUse& use,
                         TextureFiles& textures) {
  const JsonView root = document.root();
  const JsonView image = root["images"][number];
  if (image["bufferView"]) {
    const std::uint32_t view = image["bufferView"].reference(root["bufferViews"].size());
    const GltfBytes range = buffer_view(document, view);
    std::string buffer;
    const std::string_view bytes = range.read(0, range.size, buffer);
    return textures.from_memory(image.place(), std::as_bytes(std::span(bytes)), use);
  }
  const std::string uri = image["uri"].text();
  std::string bytes;
  if (decode_data_uri(uri, bytes)) {
    return textures.from_memory(image.place(), std::as_bytes(std::span(bytes)), use);
  }
  return textures.from_file(decode_percent(uri), use);
}

UvUse uv_use(const JsonView& info) {
  UvUse use;
  use.set = info["texCoord"].whole(0);
  const JsonView transform = info["extensions"]["KHR_texture_transform"];
  if (!transform) return use;
  use.set = transform["texCoord"].whole(use.set);
  const glm::dvec2 offset = transform["offset"].vector<2>({0, 0});
  const glm::dvec2 scale = transform["scale"].vector<2>({1, 1});
  const double angle = transform["rotation"].number(0);
  const double c = std::cos(angle), s = std::sin(angle);
  use.transform = {c * scale.x, -s * scale.x, s * scale.y, c * scale.y, offset.x, offset.y};
  return use;
}

// The coordinates that textures of one material use, numbered as they come.
struct MaterialUvs {
  std::vector<UvUse> uses;  // of sets 0 and 1
  bool any_others = false;

  std::uint8_t set_of(const UvUse& use) {
    const auto known = std::find(uses.begin(), uses.end(), use);
    if (known != uses.end()) return static_cast<std::uint8_t>(known - uses.begin());
    if (uses.size() == 2) {
      any_others = true;
      return 0;
    }
    uses.push_back(use);
    return static_cast<std::uint8_t>(uses.size() - 1);
  }
};

// State that the materials of a file have in common while they are read.
struct Reader {
  const GltfDocument& document;
  TextureFiles& textures;

  // `info` refers to a texture from a material; absent: kNone.
  std::uint32_t texture(const JsonView& info, bool srgb, MaterialUvs& uvs) const {
    if (!info) return kNone;
    const JsonView root = document.root();
    const JsonView all = root["textures"];
    const std::uint32_t number = info["index"].reference(all.size());
    if (number == kNone) info["index"].fail("is missing");
    const std::uint8_t set = uvs.set_of(uv_use(info));
    const JsonView texture = all[number];
    const JsonView samplers = root["samplers"];
    TextureUse use{srgb, Texture::Wrap::repeat, Texture::Wrap::repeat, set};
    const std::uint32_t sampler = texture["sampler"].reference(samplers.size());
    if (sampler != kNone) {
      use.wrap_u = wrap_of(samplers[sampler]["wrapS"]);
      use.wrap_v = wrap_of(samplers[sampler]["wrapT"]);
    }
    const std::size_t images = root["images"].size();
    std::uint32_t image = texture["source"].reference(images);
    if (image == kNone) {
      image = texture["extensions"]["EXT_texture_webp"]["source"].reference(images);
    }
    if (image != kNone) return read_image(document, image, use, textures);
    document.source.warn(texture.place() + " has no picture that can be read");
    return kNone;
  }

  void left_out(const JsonView& what) const {
    document.source.warn(what.place() + " is not supported and left out");
  }
};

glm::vec3 nonnegative(const glm::dvec3& colour) { return glm::max(colour, glm::dvec3(0)); }

void read_base(const Reader& reader, const JsonView& json, MaterialUvs& uvs, Material& material) {
  const JsonView base = json["pbrMetallicRoughness"];
  // The older way to say a colour; its gloss becomes roughness, its reflections are left out.
  const JsonView gloss = json["extensions"]["KHR_materials_pbrSpecularGlossiness"];
  const glm::dvec4 white(1);
  if (gloss) {
    material.base_colour = glm::max(gloss["diffuseFactor"].vector<4>(white), glm::dvec4(0));
    material.metallic = 0;
    material.roughness = static_cast<float>(1 - gloss["glossinessFactor"].number(1, 0, 1));
    material.base_colour_texture = reader.texture(gloss["diffuseTexture"], true, uvs);
    return;
  }
  material.base_colour = glm::max(base["baseColorFactor"].vector<4>(white), glm::dvec4(0));
  material.metallic = static_cast<float>(base["metallicFactor"].number(1, 0, 1));
  material.roughness = static_cast<float>(base["roughnessFactor"].number(1, 0, 1));
  material.base_colour_texture = reader.texture(base["baseColorTexture"], true, uvs);
  material.metallic_roughness_texture =
      reader.texture(base["metallicRoughnessTexture"], false, uvs);
}

Material::Alpha alpha_mode(const JsonView& mode) {
  const std::string name = mode.text("OPAQUE");
  if (name == "MASK") return Material::Alpha::mask;
  if (name == "BLEND") return Material::Alpha::blend;
  if (name != "OPAQUE") mode.fail("should be OPAQUE, MASK or BLEND");
  return Material::Alpha::opaque;
}

float factor(const JsonView& json, const char* key, double otherwise = 0) {
  return static_cast<float>(json[key].number(otherwise, 0, 1));
}

void read_transmission(const Reader& reader, const JsonView& extensions, MaterialUvs& uvs,
                       Material& material) {
  const JsonView transmission = extensions["KHR_materials_transmission"];
  material.transmission = factor(transmission, "transmissionFactor");
  material.transmission_texture = reader.texture(transmission["transmissionTexture"], false, uvs);
  const JsonView volume = extensions["KHR_materials_volume"];
  material.thickness = static_cast<float>(volume["thicknessFactor"].number(0, 0, 1e18));
  if (volume["thicknessTexture"]) reader.left_out(volume["thicknessTexture"]);
  const double distance = volume["attenuationDistance"].number(0, 0, 1e18);
  if (distance > 0) material.attenuation_distance = static_cast<float>(distance);
  material.attenuation_colour =
      glm::clamp(volume["attenuationColor"].vector<3>({1, 1, 1}), glm::dvec3(0), glm::dvec3(1));
}

void read_reflection(const Reader& reader, const JsonView& extensions, MaterialUvs& uvs,
                     Material& material) {
  const JsonView ior = extensions["KHR_materials_ior"]["ior"];
  // 0 stands for a dielectric that reflects everything.
  const double index = ior.number(1.5, 0, 100);
  material.ior = static_cast<float>(index == 0 ? 1000 : std::max(index, 1.0));
  const JsonView specular = extensions["KHR_materials_specular"];
  material.specular = factor(specular, "specularFactor", 1);
  material.specular_colour = nonnegative(specular["specularColorFactor"].vector<3>({1, 1, 1}));
  material.specular_texture = reader.texture(specular["specularTexture"], false, uvs);
  material.specular_colour_texture = reader.texture(specular["specularColorTexture"], true, uvs);
  const JsonView coat = extensions["KHR_materials_clearcoat"];
  material.clearcoat = factor(coat, "clearcoatFactor");
  material.clearcoat_roughness = factor(coat, "clearcoatRoughnessFactor");
  material.clearcoat_texture = reader.texture(coat["clearcoatTexture"], false, uvs);
  material.clearcoat_roughness_texture =
      reader.texture(coat["clearcoatRoughnessTexture"], false, uvs);
  if (coat["clearcoatNormalTexture"]) reader.left_out(coat["clearcoatNormalTexture"]);
  const JsonView sheen = extensions["KHR_materials_sheen"];
  material.sheen_colour =
      glm::clamp(sheen["sheenColorFactor"].vector<3>({0, 0, 0}), glm::dvec3(0), glm::dvec3(1));
  material.sheen_roughness = factor(sheen, "sheenRoughnessFactor");
  material.sheen_colour_texture = reader.texture(sheen["sheenColorTexture"], true, uvs);
  material.sheen_roughness_texture = reader.texture(sheen["sheenRoughnessTexture"], false, uvs);
}

void warn_of_others(const Reader& reader, const JsonView& extensions) {
  for (const std::string& name : extensions.keys()) {
    if (!is_material_extension(name)) reader.left_out(extensions[name.c_str()]);
  }
}

GltfMaterial read_material(const Reader& reader, const JsonView& json) {
  GltfMaterial result;
  Material& material = result.material;
  MaterialUvs uvs;
  material.name = json["name"].text();
  read_base(reader, json, uvs, material);
  material.normal_texture = reader.texture(json["normalTexture"], false, uvs);
  material.normal_scale = static_cast<float>(json["normalTexture"]["scale"].number(1));
  const JsonView extensions = json["extensions"];
  const double strength =
      extensions["KHR_materials_emissive_strength"]["emissiveStrength"].non_negative(1);
  material.emission = json["emissiveFactor"].non_negative_vector<3>({0, 0, 0}) * strength;
  material.emission_texture = reader.texture(json["emissiveTexture"], true, uvs);
  material.alpha = alpha_mode(json["alphaMode"]);
  material.alpha_cutoff = static_cast<float>(json["alphaCutoff"].number(0.5, 0, 2));
  material.double_sided = json["doubleSided"].flag(false);
  material.unlit = static_cast<bool>(extensions["KHR_materials_unlit"]);
  read_transmission(reader, extensions, uvs, material);
  read_reflection(reader, extensions, uvs, material);
  warn_of_others(reader, extensions);
  result.uvs = std::move(uvs.uses);
  if (uvs.any_others) {
    reader.document.source.warn(json.place() +
                                ": its textures use more than two kinds of coordinates; the rest "
                                "use the first texture's");
  }
  return result;
}

}  // namespace

bool is_material_extension(std::string_view name) {
  constexpr std::array<std::string_view, 9> kKnown = {
      "KHR_materials_clearcoat",    "KHR_materials_emissive_strength",
      "KHR_materials_ior",          "KHR_materials_pbrSpecularGlossiness",
      "KHR_materials_sheen",        "KHR_materials_specular",
      "KHR_materials_transmission", "KHR_materials_unlit",
      "KHR_materials_volume"};
  return std::find(kKnown.begin(), kKnown.end(), name) != kKnown.end();
}

std::vector<GltfMaterial> read_materials(const GltfDocument& document, TextureFiles& textures) {
  const Reader reader{document, textures};
  const JsonView materials = document.root()["materials"];
  std::vector<GltfMaterial> result;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    result.push_back(read_material(reader, materials[i]));
  }
  return result;
}

}  // namespace delray::scenes::internal
