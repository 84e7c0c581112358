// One list of the fields of each struct serves writing and reading; what was read is then checked
// as a whole.
#include "packs/format/scene_bytes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "packs/word_planes.h"
#include "scenes/colour_map.h"
#include "scenes/pose.h"

namespace delray::packs::internal {
namespace {

constexpr std::size_t kTexelBlock = std::size_t{1} << 20;  // bytes compressed at a time
constexpr std::uint64_t kMostUnpacked = 255;  // times its size, that an LZ4 block unpacks to

template <class Bytes, class Material>
void material_fields(Bytes& b, Material& m) {
  b.text(m.name);
  b.value(m.base_colour);
  b.value(m.metallic);
  b.value(m.roughness);
  b.value(m.transmission);
  b.value(m.ior);
  b.flag(m.unlit);
  b.value(m.emission);
  b.value(m.normal_scale);
  b.choice(m.alpha, scenes::Material::Alpha::blend);
  b.value(m.alpha_cutoff);
  b.flag(m.double_sided);
  b.value(m.specular);
  b.value(m.specular_colour);
  b.value(m.clearcoat);
  b.value(m.clearcoat_roughness);
  b.value(m.sheen_colour);
  b.value(m.sheen_roughness);
  b.value(m.attenuation_colour);
  b.value(m.attenuation_distance);
  b.value(m.thickness);
  if constexpr (Bytes::kReads) {
    for (std::uint32_t* texture : m.textures()) b.value(*texture);
  } else {
    for (const std::uint32_t texture : m.textures()) b.value(texture);
  }
}

template <class Bytes, class... Values>
void values(Bytes& b, Values&... all) {
  (b.value(all), ...);
}

template <class Bytes, class Light>
void light_fields(Bytes& b, Light& l) {
  b.choice(l.kind, scenes::Light::Kind::area);
  values(b, l.colour, l.position, l.direction, l.edge_u, l.edge_v);
}

template <class Bytes, class Environment>
void environment_fields(Bytes& b, Environment& e) {
  values(b, e.texture, e.rotation, e.up, e.zenith, e.horizon, e.ground);
}

template <class Bytes, class Camera>
void camera_fields(Bytes& b, Camera& c) {
  values(b, c.eye, c.at, c.up, c.vertical_fov, c.near, c.aperture, c.focus, c.height, c.far);
  b.text(c.name);
}

template <class Bytes, class Texture>
void texture_fields(Bytes& b, Texture& t) {
  b.text(t.name);
  b.value(t.width);
  b.value(t.height);
  b.flag(t.srgb);
  b.choice(t.wrap_u, scenes::Texture::Wrap::clamp);
  b.choice(t.wrap_v, scenes::Texture::Wrap::clamp);
  b.value(t.set);
}

template <class Bytes, class Scene>
void plain_fields(Bytes& b, Scene& scene) {
  b.array(scene.instances);
  environment_fields(b, scene.environment);
  b.value(scene.origin);
  b.flag(scene.z_up);
  b.value(scene.framed);
}

void read_motions(ByteReader& from, std::size_t meshes, std::vector<scenes::MeshMotion>& motions) {
  from.array(motions);
  if (!motions.empty() && motions.size() != meshes) from.fail("meshes have no motions");
  if (std::ranges::any_of(motions, [](auto m) { return m > scenes::MeshMotion::deforming; }))
    from.fail("there is no motion of that number");
}

// What colours tell: whether they do, then 0 for classes, 1 for grey, else 2 and the number of the
// map.
constexpr std::uint8_t kClasses = 0, kGrey = 1, kFirstMap = 2;

std::uint8_t number_of(glm::vec3 (*colour)(float)) {
  if (colour == nullptr) return kClasses;
  const std::span<const scenes::ColourMap> maps = scenes::colour_maps();
  const auto found = std::ranges::find(maps, colour, &scenes::ColourMap::colour);
  if (found == maps.end()) return kGrey;
  return static_cast<std::uint8_t>(kFirstMap + (found - maps.begin()));
}

void write_scale(const std::optional<scenes::ColourScale>& scale, ByteWriter& to) {
  to.flag(scale.has_value());
  if (!scale) return;
  to.text(scale->title);
  const std::uint8_t number = number_of(scale->colour);
  values(to, scale->low, scale->high, number);
  to.value(static_cast<std::uint64_t>(scale->classes.size()));
  for (const auto& one : scale->classes) {
    to.text(one.name);
    to.value(one.colour);
  }
}

void read_scale(ByteReader& from, std::optional<scenes::ColourScale>& scale) {
  bool exists = false;
  from.flag(exists);
  if (!exists) return;
  scale.emplace();
  std::uint8_t number = 0;
  from.text(scale->title);
  values(from, scale->low, scale->high, number);
  if (!std::isfinite(scale->low) || !std::isfinite(scale->high))
    from.fail("the ends of a colour scale are not finite");
  const std::span<const scenes::ColourMap> maps = scenes::colour_maps();
  if (number >= kFirstMap + maps.size()) from.fail("a colour map does not exist");
  if (number == kGrey) scale->colour = scenes::brightness;
  if (number >= kFirstMap) scale->colour = maps[number - kFirstMap].colour;
  for (std::size_t n = from.count(8 + sizeof(glm::vec3)); n > 0; --n) {
    scale->classes.emplace_back();
    from.text(scale->classes.back().name);
    from.value(scale->classes.back().colour);
  }
}

void write_blocks(std::span<const char> bytes, ByteWriter& to) {
  for (std::size_t at = 0; at < bytes.size(); at += kTexelBlock) {
    const std::vector<char> block =
        compress(bytes.subspan(at, std::min(kTexelBlock, bytes.size() - at)));
    to.value(static_cast<std::uint32_t>(block.size()));
    to.raw(block.data(), block.size());
  }
}

void read_blocks(ByteReader& from, std::span<char> bytes) {
  for (std::size_t at = 0; at < bytes.size(); at += kTexelBlock) {
    std::uint32_t size = 0;
    from.value(size);
    if (!decompress(from.take(size), bytes.subspan(at, std::min(kTexelBlock, bytes.size() - at))))
      from.fail("texels do not unpack");
  }
}

// Behind a flag, whether they are radiance.
void write_texels(const scenes::Texture& texture, ByteWriter& to) {
  to.flag(!texture.radiance.empty());
  const auto bytes = texture.radiance.empty() ? std::as_bytes(std::span(texture.texels))
                                              : std::as_bytes(std::span(texture.radiance));
  const std::span<const char> content(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  to.value(static_cast<std::uint64_t>(content.size()));
  write_blocks(content, to);
}

void read_texels(ByteReader& from, std::size_t left, const files::MemoryBudget& memory,
                 const std::string& file, scenes::Texture& texture) {
  if (texture.width < 1 || texture.height < 1 || texture.set > 1)
    from.fail("a texture has no size or an unknown set");
  bool radiance = false;
  std::uint64_t bytes = 0;
  from.flag(radiance);
  from.value(bytes);
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(texture.width) * static_cast<std::uint64_t>(texture.height);
  const std::uint64_t each = radiance ? sizeof(glm::vec3) : sizeof(image::Rgba8);
  if (bytes / each != pixels || bytes % each != 0 || bytes / kMostUnpacked > left)
    from.fail("a texture has another size than its texels");
  memory.require(bytes, file, "texture '" + texture.name + "'");
  if (radiance) {
    texture.radiance.resize(pixels);
    read_blocks(from, {reinterpret_cast<char*>(texture.radiance.data()), bytes});
  } else {
    texture.texels.resize(pixels);
    read_blocks(from, {reinterpret_cast<char*>(texture.texels.data()), bytes});
  }
}

bool is_finite(const glm::mat4x3& m) {
  for (int k = 0; k < 4; ++k) {
    for (int i = 0; i < 3; ++i)
      if (!std::isfinite(m[k][i])) return false;
  }
  return true;
}

void check_scene(const ByteReader& from, std::size_t meshes, const scenes::Scene& scene) {
  const auto known = [&](std::uint32_t texture) {
    return texture == scenes::kNone || texture < scene.textures.size();
  };
  for (const scenes::Instance& instance : scene.instances) {
    if (instance.mesh >= meshes) from.fail("an instance is of no mesh");
    if (!is_finite(instance.transform)) from.fail("the place of an instance is not finite");
  }
  if (scene.materials.empty()) from.fail("there is no material");
  for (const scenes::Material& material : scene.materials) {
    for (const std::uint32_t texture : material.textures()) {
      if (!known(texture)) from.fail("the texture of a material is none");
      if (texture != scenes::kNone && !scene.textures[texture].radiance.empty())
        from.fail("the texture of a material is an environment");
    }
  }
  if (!known(scene.environment.texture)) from.fail("the texture of the environment is none");
}

template <class Bytes, class Row>
void mesh_fields(Bytes& b, Row& row) {
  b.text(row.name);
  b.choice(row.shape.kind, scenes::Shape::Kind::line);
  b.flag(row.shape.in_pixels);
  b.value(row.shape.radius);
  b.value(row.material);
  b.flag(row.attributes.normals);
  b.flag(row.attributes.uvs);
  b.flag(row.attributes.uvs2);
  b.flag(row.attributes.tangents);
  b.flag(row.attributes.colours);
  b.value(row.triangles);
  b.value(row.vertices);
  b.value(row.box);
  b.array(row.levels);
}

template <class Bytes, class Row>
void page_fields(Bytes& b, Row& row) {
  b.value(row.offset);
  b.value(row.checksum);
  b.value(row.bytes);
  b.value(row.first);
  b.value(row.triangles);
  b.value(row.vertices);
  b.value(row.references);
  b.value(row.clusters);
  b.value(row.level);
  b.value(row.box);
  b.value(row.cone);
  b.value(row.made_of);
  b.value(row.simplified_in);
}
constexpr std::size_t kPageFieldBytes = 8 + 8 + 4 + 4 + 6 + 2 + 24 + 20 + 8;

bool is_finite(const geometry::Box3& box) {
  for (int k = 0; k < 3; ++k) {
    // Written so that what is not a number is not.
    if (!(std::isfinite(box.low[k]) && std::isfinite(box.high[k]) && box.low[k] <= box.high[k]))
      return false;
  }
  return true;
}

void check_page(const ByteReader& from, std::uint64_t data_end, std::size_t groups,
                const PageRow& row) {
  if (row.bytes == 0 || row.offset > data_end || row.bytes > data_end - row.offset)
    from.fail("a page is outside of the file");
  const std::uint32_t triangles = row.triangles, clusters = row.clusters;
  if (clusters < 1 || clusters > kPageClusters || triangles < clusters ||
      triangles > clusters * kClusterTriangles || row.vertices < 1 ||
      row.vertices > row.references || row.references > clusters * kClusterVertices)
    from.fail("a page has counts that cannot be");
  if (!is_finite(row.box)) from.fail("a page has no box");
  for (const std::uint32_t group : {row.made_of, row.simplified_in})
    if (group != kNoGroup && group >= groups) from.fail("a page is of a group that is none");
  if ((row.level == 0) != (row.made_of == kNoGroup)) from.fail("a page is on the wrong level");
}

// The pages of a mesh have to be its levels, one after the other, and the finest its triangles.
std::uint32_t check_mesh(const ByteReader& from, const Table& table, std::uint32_t next,
                         const MeshRow& mesh) {
  if (mesh.levels.empty()) from.fail("a mesh has no pages");
  if (!(mesh.shape.radius >= 0) || !std::isfinite(mesh.shape.radius))
    from.fail("points or segments have no radius");
  for (std::size_t level = 0; level < mesh.levels.size(); ++level) {
    const PageRange& range = mesh.levels[level];
    if (range.first != next || range.count == 0 || range.count > table.pages.size() - next)
      from.fail("a mesh has pages that are not its own");
    next += range.count;
    std::uint64_t triangles = 0;
    for (std::uint32_t i = range.first; i < next; ++i) {
      const PageRow& page = table.pages[i];
      if (page.level != level) from.fail("a page is on the wrong level");
      if (page.first != triangles) from.fail("triangles are missing between pages");
      triangles += page.triangles;
    }
    if (triangles > 0xFFFFFFFFU || (level == 0 && triangles != mesh.triangles))
      from.fail("a mesh has other triangles than its pages");
  }
  return next;
}

}  // namespace

void write_scene(const scenes::Scene& scene, ByteWriter& to) {
  const auto list = [&](const auto& values, auto&& fields) {
    to.value(static_cast<std::uint64_t>(values.size()));
    for (const auto& value : values) fields(value);
  };
  plain_fields(to, scene);
  to.array(scenes::mesh_motions(scene));
  write_scale(scene.colour_scale, to);
  list(scene.materials, [&](const auto& m) { material_fields(to, m); });
  list(scene.lights, [&](const auto& l) { light_fields(to, l); });
  list(scene.cameras, [&](const auto& c) { camera_fields(to, c); });
  list(scene.textures, [&](const auto& t) {
    texture_fields(to, t);
    write_texels(t, to);
  });
}

void read_scene(ByteReader& from, std::size_t meshes, const files::MemoryBudget& memory,
                const std::string& file, scenes::Scene& scene) {
  const auto list = [&](auto& values, auto&& fields) {
    for (std::size_t n = from.count(16); n > 0; --n) {
      values.emplace_back();
      fields(values.back());
    }
  };
  plain_fields(from, scene);
  read_motions(from, meshes, scene.animations.motions);
  read_scale(from, scene.colour_scale);
  list(scene.materials, [&](auto& m) { material_fields(from, m); });
  list(scene.lights, [&](auto& l) { light_fields(from, l); });
  list(scene.cameras, [&](auto& c) { camera_fields(from, c); });
  list(scene.textures, [&](auto& t) {
    texture_fields(from, t);
    read_texels(from, from.left(), memory, file, t);
  });
  if (!from.at_end()) from.fail("bytes are left over");
  check_scene(from, meshes, scene);
}

void write_table(const Table& table, ByteWriter& to) {
  to.flag(table.lit_by_emission);
  to.value(static_cast<std::uint64_t>(table.meshes.size()));
  for (const MeshRow& mesh : table.meshes) mesh_fields(to, mesh);
  to.value(static_cast<std::uint64_t>(table.pages.size()));
  for (const PageRow& page : table.pages) page_fields(to, page);
  to.array(table.groups);
}

void read_table(ByteReader& from, std::uint64_t data_end, Table& table) {
  from.flag(table.lit_by_emission);
  for (std::size_t n = from.count(16); n > 0; --n) mesh_fields(from, table.meshes.emplace_back());
  const std::size_t pages = from.count(kPageFieldBytes);
  if (pages > 0xFFFFFFFEU) from.fail("there are too many pages");
  table.pages.resize(pages);
  for (PageRow& page : table.pages) page_fields(from, page);
  from.array(table.groups);
  if (!from.at_end()) from.fail("bytes are left over");
  for (const PageRow& page : table.pages) check_page(from, data_end, table.groups.size(), page);
  for (const Group& group : table.groups) {
    if (!is_finite(group.bounds) || !(group.error >= 0) || !std::isfinite(group.error))
      from.fail("a group has no bounds or error");
  }
  std::uint32_t next = 0;
  for (const MeshRow& mesh : table.meshes) next = check_mesh(from, table, next, mesh);
  if (next != pages) from.fail("a page is of no mesh");
}

}  // namespace delray::packs::internal
