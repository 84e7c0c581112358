// MTL (Wavefront): a word at the start of each line says what the rest of it is.
#include "scenes/files/read_mtl.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "image/srgb.h"
#include "scenes/files/text_lines.h"
#include "scenes/files/vertex_values.h"

namespace delray::scenes::internal {
namespace {

struct Map {
  std::string_view file;
  bool clamp = false;
};

// A material in the words of the file.
struct Phong {
  std::string_view name;
  std::optional<glm::vec3> diffuse, specular, emission;
  std::optional<float> exponent, opacity, ior, metallic, roughness;
  Map diffuse_map, emission_map, normal_map, opacity_map;
};

std::optional<float> read_number(Words& words) {
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    float value = 0;
    if (word == "-halo") continue;
    if (parse(word, value) && std::isfinite(value)) return value;
    break;
  }
  return {};
}

// One number is grey.
std::optional<glm::vec3> read_colour(Words& words) {
  const auto r = read_number(words), g = read_number(words), b = read_number(words);
  if (!r) return {};
  return glm::max(glm::vec3(*r, g.value_or(*r), b.value_or(g.value_or(*r))), glm::vec3(0));
}

// Options with their arguments, then the name of a file, with blanks or without.
Map read_map(Words& words) {
  struct Option {
    std::string_view name;
    int least, most;  // arguments; those beyond the least are numbers
  };
  constexpr std::array kOptions = {
      Option{"-blendu", 1, 1}, Option{"-blendv", 1, 1},  Option{"-boost", 1, 1},
      Option{"-mm", 2, 2},     Option{"-o", 1, 3},       Option{"-s", 1, 3},
      Option{"-t", 1, 3},      Option{"-texres", 1, 1},  Option{"-clamp", 1, 1},
      Option{"-bm", 1, 1},     Option{"-imfchan", 1, 1}, Option{"-type", 1, 1},
      Option{"-cc", 1, 1}};
  Map map;
  while (true) {
    Words look_ahead = words;
    const std::string_view word = look_ahead.next();
    const auto* option = std::find_if(kOptions.begin(), kOptions.end(),
                                      [&](const Option& o) { return o.name == word; });
    if (option == kOptions.end()) break;
    words = look_ahead;
    for (int i = 0; i < option->most; ++i) {
      const std::string_view argument = look_ahead.next();
      float number = 0;
      if (i >= option->least && !parse(argument, number)) break;
      if (word == "-clamp") map.clamp = argument == "on";
      words = look_ahead;
    }
  }
  map.file = words.rest();
  return map;
}

void read_line(std::string_view key, Words& words, Phong& to) {
  if (key == "Kd") to.diffuse = read_colour(words);
  if (key == "Ks") to.specular = read_colour(words);
  if (key == "Ke") to.emission = read_colour(words);
  if (key == "Ns") to.exponent = read_number(words);
  if (key == "Ni") to.ior = read_number(words);
  if (key == "Pm") to.metallic = read_number(words);
  if (key == "Pr") to.roughness = read_number(words);
  if (key == "d") to.opacity = read_number(words);
  if (key == "Tr") {
    if (const auto transparency = read_number(words)) to.opacity = 1 - *transparency;
  }
  if (key == "map_Kd") to.diffuse_map = read_map(words);
  if (key == "map_Ke" || key == "map_emissive") to.emission_map = read_map(words);
  if (key == "norm" || key == "map_Kn") to.normal_map = read_map(words);
  if (key == "map_d" || key == "map_opacity") to.opacity_map = read_map(words);
}

std::uint32_t texture(const Map& map, bool srgb, TextureFiles& textures) {
  if (map.file.empty()) return kNone;
  const Texture::Wrap wrap = map.clamp ? Texture::Wrap::clamp : Texture::Wrap::repeat;
  return textures.from_file(std::string(map.file), {srgb, wrap, wrap});
}

glm::vec3 linear(const glm::vec3& srgb) {
  return {image::decode_srgb_value(srgb.x), image::decode_srgb_value(srgb.y),
          image::decode_srgb_value(srgb.z)};
}

float roughness_of(const Phong& from) {
  if (from.roughness) return std::clamp(*from.roughness, 0.0F, 1.0F);
  if (from.specular.value_or(glm::vec3(0)) == glm::vec3(0)) return 0.8F;
  return std::sqrt(std::sqrt(2.0F / (std::max(from.exponent.value_or(0), 0.0F) + 2.0F)));
}

Material material_of(const Phong& from, TextureFiles& textures) {
  Material material = plain_material(false);
  material.name = from.name;
  material.base_colour_texture = texture(from.diffuse_map, true, textures);
  material.normal_texture = texture(from.normal_map, false, textures);
  material.emission_texture = texture(from.emission_map, true, textures);

  if (from.diffuse) {
    glm::vec3 base = linear(glm::min(*from.diffuse, glm::vec3(1)));
    // Many files leave Kd black where a texture says the colour.
    if (material.base_colour_texture != kNone && base == glm::vec3(0)) base = glm::vec3(1);
    material.base_colour = glm::vec4(base, 1.0F);
  }
  material.emission = from.emission.value_or(glm::vec3(0));
  if (material.emission_texture != kNone && material.emission == glm::vec3(0)) {
    material.emission = glm::vec3(1);
  }
  material.roughness = roughness_of(from);
  material.metallic = std::clamp(from.metallic.value_or(0), 0.0F, 1.0F);
  const float opacity = from.opacity.value_or(1);
  // Exporters that mean Tr when they write d make models vanish: 0 is taken as opaque.
  if (opacity > 0 && opacity < 1) {
    material.base_colour.a = opacity;
    material.alpha = Material::Alpha::blend;
  }
  if (!from.opacity_map.file.empty() && material.base_colour_texture != kNone) {
    // Cut-outs, as a rule in the colour texture's alpha too.
    material.alpha = Material::Alpha::mask;
  }
  const float ior = from.ior.value_or(1.5F);
  if (ior > 1.0F && ior < 4.0F) material.ior = ior;
  return material;
}

// Whether the picture is read or not.
bool names_a_picture(std::string_view key) {
  constexpr std::array<std::string_view, 5> kOthers = {"bump", "disp", "decal", "refl", "norm"};
  return key.starts_with("map_") || std::ranges::find(kOthers, key) != kOthers.end();
}

}  // namespace

std::vector<Material> read_mtl(std::string_view content, TextureFiles& textures) {
  std::vector<Material> materials;
  std::optional<Phong> current;
  const auto finish_current = [&] {
    if (current) materials.push_back(material_of(*current, textures));
  };
  std::string_view line;
  for (Lines lines(content); lines.next(line);) {
    Words words(line);
    const std::string_view key = words.next();
    if (key == "newmtl") {
      finish_current();
      current = Phong{};
      current->name = words.rest();
    } else if (current) {
      if (names_a_picture(key)) {
        Words rest = words;
        textures.note_named(std::string(read_map(rest).file));
      }
      read_line(key, words, *current);
    }
  }
  finish_current();
  return materials;
}

}  // namespace delray::scenes::internal
