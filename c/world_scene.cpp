// Arrays are copied: what an application changes later does not change a frame that is being
// rendered.
#include "c/world_scene.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "image/srgb.h"
#include "scenes/points.h"

namespace delray::c {
namespace {

[[noreturn]] void refuse(const DelrayObject_& object, const std::string& why) {
  const std::string name = object.text("name", "");
  throw std::invalid_argument(name_of(object.kind) +
                              (object.subtype.empty() ? "" : " " + object.subtype) +
                              (name.empty() ? "" : " '" + name + "'") + ": " + why);
}

glm::vec3 finite(const DelrayObject_& object, std::string_view name, const glm::vec3& otherwise) {
  const glm::vec3 v = object.value(name, otherwise);
  if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
    refuse(object, std::string(name) + " is not finite");
  return v;
}

float between(const DelrayObject_& object, std::string_view name, float otherwise, float low,
              float high) {
  const float x = object.value(name, otherwise);
  if (!(x >= low && x <= high))
    refuse(object, std::string(name) + " is not from " + std::to_string(low) + " to " +
                       std::to_string(high));
  return x;
}

float unit(const DelrayObject_& object, std::string_view name, float otherwise) {
  return between(object, name, otherwise, 0.0F, 1.0F);
}

constexpr float kMost = 1e9F;  // of light

// The items of an array parameter; none where it is not there.
struct Items {
  DelrayDataType type = DELRAY_UNKNOWN;
  std::size_t count = 0;
  const void* data = nullptr;
};
Items items_of(const DelrayObject_& object, std::string_view name,
               std::initializer_list<DelrayDataType> types) {
  const DelrayObject array = object.object(name);
  if (array == nullptr) return {};
  if (array->is_mapped) refuse(object, std::string(name) + " is mapped");
  if (std::ranges::find(types, array->item_type) == types.end())
    refuse(object, std::string(name) + " holds " + name_of(array->item_type));
  return {array->item_type, array->items[0] * array->items[1], array->memory};
}

// The objects of an array parameter.
std::span<const Ref> objects_of(const DelrayObject_& object, std::string_view name,
                                DelrayDataType type) {
  const DelrayObject array = object.object(name);
  if (array == nullptr) return {};
  if (array->is_mapped) refuse(object, std::string(name) + " is mapped");
  if (array->item_type != type)
    refuse(object,
           std::string(name) + " holds " + name_of(array->item_type) + ", not " + name_of(type));
  return array->item_objects;
}

template <class Vector>
std::vector<Vector> vectors_of(const DelrayObject_& object, std::string_view name,
                               DelrayDataType type, std::size_t count) {
  const Items items = items_of(object, name, {type});
  if (items.data == nullptr) return {};
  if (count != 0 && items.count != count)
    refuse(object, std::string(name) + " has " + std::to_string(items.count) + " items for " +
                       std::to_string(count) + " positions");
  const auto* const from = static_cast<const Vector*>(items.data);
  std::vector<Vector> vectors(from, from + items.count);
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    for (int k = 0; k < static_cast<int>(sizeof(Vector) / sizeof(float)); ++k) {
      if (!std::isfinite(vectors[i][k]))
        refuse(object, std::string(name) + ": item " + std::to_string(i) + " is not finite");
    }
  }
  return vectors;
}

glm::vec4 colour_of(const std::uint8_t* p, DelrayDataType type) {
  const bool has_alpha = type == DELRAY_UFIXED8_VEC4 || type == DELRAY_UFIXED8_RGBA_SRGB;
  const bool is_srgb = type == DELRAY_UFIXED8_RGB_SRGB || type == DELRAY_UFIXED8_RGBA_SRGB;
  glm::vec4 colour(1.0F);
  for (int k = 0; k < 3; ++k)
    colour[k] = is_srgb ? image::decode_srgb(p[k]) : image::decode_alpha(p[k]);
  if (has_alpha) colour.a = image::decode_alpha(p[3]);
  return colour;
}

std::vector<glm::vec4> colours_of(const DelrayObject_& geometry, std::size_t count) {
  const Items items =
      items_of(geometry, "vertex.color",
               {DELRAY_FLOAT32_VEC3, DELRAY_FLOAT32_VEC4, DELRAY_UFIXED8_VEC3, DELRAY_UFIXED8_VEC4,
                DELRAY_UFIXED8_RGB_SRGB, DELRAY_UFIXED8_RGBA_SRGB});
  if (items.data == nullptr) return {};
  if (items.count != count)
    refuse(geometry, "vertex.color has " + std::to_string(items.count) + " items for " +
                         std::to_string(count) + " positions");
  std::vector<glm::vec4> colours(count, glm::vec4(1.0F));
  const auto* const bytes = static_cast<const std::uint8_t*>(items.data);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* const item = bytes + i * size_of(items.type);
    if (items.type == DELRAY_FLOAT32_VEC3 || items.type == DELRAY_FLOAT32_VEC4) {
      std::memcpy(&colours[i], item, size_of(items.type));
    } else {
      colours[i] = colour_of(item, items.type);
    }
    for (int k = 0; k < 4; ++k) {
      if (!(colours[i][k] >= 0.0F && colours[i][k] <= kMost))
        refuse(geometry, "vertex.color: item " + std::to_string(i) + " is below 0 or not finite");
    }
  }
  return colours;
}

scenes::Mesh mesh_of(const DelrayObject_& geometry) {
  scenes::Mesh mesh;
  mesh.name = geometry.text("name", "");
  mesh.positions = vectors_of<glm::vec3>(geometry, "vertex.position", DELRAY_FLOAT32_VEC3, 0);
  if (geometry.object("vertex.position") == nullptr) refuse(geometry, "vertex.position is missing");
  const std::size_t count = mesh.positions.size();
  mesh.colours = colours_of(geometry, count);
  if (geometry.subtype == "sphere") {
    const float radius = between(geometry, "radius", 0.01F, 0.0F, 1e18F);
    make_points(mesh, {scenes::Shape::Kind::sphere, false, radius});
    return mesh;
  }
  mesh.normals = vectors_of<glm::vec3>(geometry, "vertex.normal", DELRAY_FLOAT32_VEC3, count);
  for (glm::vec3& normal : mesh.normals) {
    const float length = glm::length(normal);
    if (!(length > 0.0F)) refuse(geometry, "vertex.normal: one has no length");
    normal /= length;
  }
  mesh.uvs = vectors_of<glm::vec2>(geometry, "vertex.attribute0", DELRAY_FLOAT32_VEC2, count);
  const Items indices = items_of(geometry, "primitive.index", {DELRAY_UINT32_VEC3});
  if (indices.data == nullptr) {
    if (count % 3 != 0)
      refuse(geometry, "positions without primitive.index are not three for each triangle");
    for (std::uint32_t i = 0; i < count; i += 3) mesh.triangles.emplace_back(i, i + 1, i + 2);
    return mesh;
  }
  const auto* const triangles = static_cast<const glm::uvec3*>(indices.data);
  mesh.triangles.assign(triangles, triangles + indices.count);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const glm::uvec3& t = mesh.triangles[i];
    if (std::max({t.x, t.y, t.z}) >= count)
      refuse(geometry, "primitive.index: triangle " + std::to_string(i) +
                           " refers to a vertex that is not there");
  }
  return mesh;
}

scenes::Texture::Wrap wrap_of(const DelrayObject_& sampler, std::string_view name) {
  const std::string mode = sampler.text(name, "clampToEdge");
  if (mode == "repeat") return scenes::Texture::Wrap::repeat;
  if (mode == "mirrorRepeat") return scenes::Texture::Wrap::mirror;
  if (mode == "clampToEdge") return scenes::Texture::Wrap::clamp;
  refuse(sampler,
         std::string(name) + " '" + mode + "' is none of clampToEdge, repeat, mirrorRepeat");
}

// Makes a scene, an object of each only once.
class Maker {
 public:
  scenes::Scene make(const DelrayObject_& world) {
    scene_.materials.emplace_back();  // of surfaces without
    scene_.materials.front().roughness = 1.0F;
    place(world, glm::mat4x3(1.0F));
    for (const Ref& instance : objects_of(world, "instance", DELRAY_INSTANCE)) {
      const DelrayObject group = instance.get()->object("group");
      if (group == nullptr) refuse(*instance.get(), "group is missing");
      const glm::mat4 m = instance.get()->value("transform", glm::mat4(1.0F));
      for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
          if (!std::isfinite(m[column][row])) refuse(*instance.get(), "transform is not finite");
        }
      }
      place(*group, glm::mat4x3(m));
    }
    return std::move(scene_);
  }

 private:
  // Surfaces and lights of a group, or of the world itself.
  void place(const DelrayObject_& group, const glm::mat4x3& transform) {
    for (const Ref& surface : objects_of(group, "surface", DELRAY_SURFACE))
      scene_.instances.push_back({mesh_number(*surface.get()), transform});
    for (const Ref& light : objects_of(group, "light", DELRAY_LIGHT))
      add_light(*light.get(), transform);
  }

  std::uint32_t mesh_number(const DelrayObject_& surface) {
    const auto [at, is_new] =
        meshes_.try_emplace(&surface, static_cast<std::uint32_t>(scene_.meshes.size()));
    if (!is_new) return at->second;
    const DelrayObject geometry = surface.object("geometry");
    if (geometry == nullptr) refuse(surface, "geometry is missing");
    scenes::Mesh mesh = mesh_of(*geometry);
    const DelrayObject material = surface.object("material");
    // Colours of vertices count where the material's colour is the attribute of that name.
    const Value* const colour =
        material == nullptr ? nullptr
                            : material->find(material->subtype == "matte" ? "color" : "baseColor");
    if (colour == nullptr || colour->type != DELRAY_STRING) mesh.colours.clear();
    mesh.material = material == nullptr ? 0 : material_number(*material);
    scene_.meshes.push_back(std::move(mesh));
    return at->second;
  }

  std::uint32_t material_number(const DelrayObject_& from) {
    const auto [at, is_new] =
        materials_.try_emplace(&from, static_cast<std::uint32_t>(scene_.materials.size()));
    if (!is_new) return at->second;
    scenes::Material m;
    const bool is_matte = from.subtype == "matte";
    m.name = from.text("name", "");
    set_colour(from, is_matte ? "color" : "baseColor", m);
    m.base_colour.a *= unit(from, "opacity", 1.0F);
    if (is_matte) {
      m.roughness = 1.0F;
      m.specular = 0.0F;
    } else {
      m.metallic = unit(from, "metallic", 1.0F);
      m.roughness = unit(from, "roughness", 1.0F);
      m.specular = unit(from, "specular", 0.0F);
      m.specular_colour = finite(from, "specularColor", glm::vec3(1.0F));
      m.clearcoat = unit(from, "clearcoat", 0.0F);
      m.clearcoat_roughness = unit(from, "clearcoatRoughness", 0.0F);
      m.sheen_colour = finite(from, "sheenColor", glm::vec3(0.0F));
      m.sheen_roughness = unit(from, "sheenRoughness", 0.0F);
      m.transmission = unit(from, "transmission", 0.0F);
      m.ior = between(from, "ior", 1.5F, 1.0F, 100.0F);
      m.thickness = between(from, "thickness", 0.0F, 0.0F, 1e18F);
      m.attenuation_distance = from.value("attenuationDistance", m.attenuation_distance);
      if (!(m.attenuation_distance > 0.0F)) refuse(from, "attenuationDistance is not above 0");
      m.attenuation_colour = finite(from, "attenuationColor", glm::vec3(1.0F));
      m.emission = finite(from, "emissive", glm::vec3(0.0F));
    }
    set_alpha(from, m);
    scene_.materials.push_back(m);
    return at->second;
  }

  void set_colour(const DelrayObject_& from, std::string_view name, scenes::Material& m) {
    m.base_colour = glm::vec4(from.subtype == "matte" ? 0.8F : 1.0F);
    m.base_colour.a = 1.0F;
    const Value* const value = from.find(name);
    if (value == nullptr) return;
    if (value->type == DELRAY_SAMPLER) {
      m.base_colour = glm::vec4(1.0F);
      m.base_colour_texture = texture_number(*value->object.get());
    } else if (value->type == DELRAY_STRING) {
      if (from.text(name, "") != "color")
        refuse(from, std::string(name) + ": no attribute but color gives colours");
      m.base_colour = glm::vec4(1.0F);  // times those of vertices
    } else {
      std::memcpy(&m.base_colour, value->bytes.data(), value->bytes.size());
      for (int k = 0; k < 4; ++k) {
        if (!(m.base_colour[k] >= 0.0F && m.base_colour[k] <= 1.0F))
          refuse(from, std::string(name) + " is not from 0 to 1");
      }
    }
  }

  static void set_alpha(const DelrayObject_& from, scenes::Material& m) {
    const std::string mode = from.text("alphaMode", "opaque");
    m.alpha_cutoff = unit(from, "alphaCutoff", 0.5F);
    if (mode == "blend") {
      m.alpha = scenes::Material::Alpha::blend;
    } else if (mode == "mask") {
      m.alpha = scenes::Material::Alpha::mask;
    } else if (mode != "opaque") {
      refuse(from, "alphaMode '" + mode + "' is none of opaque, blend, mask");
    }
  }

  std::uint32_t texture_number(const DelrayObject_& sampler) {
    const auto [at, is_new] =
        textures_.try_emplace(&sampler, static_cast<std::uint32_t>(scene_.textures.size()));
    if (!is_new) return at->second;
    if (sampler.text("inAttribute", "attribute0") != "attribute0")
      refuse(sampler, "inAttribute is not attribute0");
    const DelrayObject array = sampler.object("image");
    if (array == nullptr) refuse(sampler, "image is missing");
    const Items items = items_of(sampler, "image",
                                 {DELRAY_UFIXED8_VEC3, DELRAY_UFIXED8_VEC4, DELRAY_UFIXED8_RGB_SRGB,
                                  DELRAY_UFIXED8_RGBA_SRGB});
    constexpr std::uint64_t kMostSide = 1 << 16;
    if (items.count == 0 || array->items[0] > kMostSide || array->items[1] > kMostSide)
      refuse(sampler, "image is empty, or too large");
    scenes::Texture texture;
    texture.width = static_cast<int>(array->items[0]);
    texture.height = static_cast<int>(array->items[1]);
    texture.srgb = items.type == DELRAY_UFIXED8_RGB_SRGB || items.type == DELRAY_UFIXED8_RGBA_SRGB;
    texture.wrap_u = wrap_of(sampler, "wrapMode1");
    texture.wrap_v = wrap_of(sampler, "wrapMode2");
    texture.texels.resize(items.count);
    const std::size_t size = size_of(items.type);
    for (std::size_t i = 0; i < items.count; ++i) {
      const auto* const p = static_cast<const std::uint8_t*>(items.data) + i * size;
      texture.texels[i] = {p[0], p[1], p[2], size == 4 ? p[3] : std::uint8_t{255}};
    }
    scene_.textures.push_back(std::move(texture));
    return at->second;
  }

  void add_light(const DelrayObject_& from, const glm::mat4x3& m) {
    const auto axes = glm::mat3(m);
    const auto power = [&](std::string_view name) {
      return between(from, name, 1.0F, 0.0F, kMost);
    };
    scenes::Light light;
    light.colour = finite(from, "color", glm::vec3(1.0F));
    if (from.subtype == "directional") {
      light.colour *= power("irradiance");
      light.direction = axes * finite(from, "direction", {0, 0, -1});
      if (!(glm::length(light.direction) > 0.0F)) refuse(from, "direction has no length");
      light.direction = glm::normalize(light.direction);
    } else {
      light.position = m * glm::vec4(finite(from, "position", glm::vec3(0.0F)), 1.0F);
      if (from.subtype == "point") {
        light.kind = scenes::Light::Kind::point;
        light.colour *= power("intensity");
      } else {
        light.kind = scenes::Light::Kind::area;
        light.colour *= power("radiance");
        light.edge_u = axes * finite(from, "edge1", {1, 0, 0});
        light.edge_v = axes * finite(from, "edge2", {0, 1, 0});
      }
    }
    scene_.lights.push_back(light);
  }

  scenes::Scene scene_;
  std::unordered_map<const DelrayObject_*, std::uint32_t> meshes_, materials_, textures_;
};

}  // namespace

scenes::Scene scene_of(const DelrayObject_& world) { return Maker().make(world); }

}  // namespace delray::c
