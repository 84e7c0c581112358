// Counts meshes once and instances as often as they are placed, and adds up the bytes of attributes
// and texels.
#include "scenes/describe.h"

namespace delray::scenes {
namespace {

template <class T>
std::uint64_t bytes_of(const std::vector<T>& values) {
  return values.size() * sizeof(T);
}

void add_mesh(const Mesh& mesh, Description& d) {
  d.stored_triangles += mesh.triangles.size();
  d.stored_vertices += mesh.positions.size();
  d.has_normals |= !mesh.normals.empty();
  d.has_uvs |= !mesh.uvs.empty();
  d.has_second_uvs |= !mesh.uvs2.empty();
  d.has_colours |= !mesh.colours.empty();
  d.bytes += bytes_of(mesh.positions) + bytes_of(mesh.normals) + bytes_of(mesh.uvs) +
             bytes_of(mesh.uvs2) + bytes_of(mesh.tangents) + bytes_of(mesh.colours) +
             bytes_of(mesh.triangles);
}

void add_light(const Light& light, Description& d) {
  d.point_lights += light.kind == Light::Kind::point ? 1 : 0;
  d.directional_lights += light.kind == Light::Kind::directional ? 1 : 0;
  d.area_lights += light.kind == Light::Kind::area ? 1 : 0;
}

}  // namespace

Description describe(const Scene& scene) {
  Description d;
  d.meshes = scene.meshes.size();
  d.instances = scene.instances.size();
  d.triangles = triangle_count(scene);
  d.vertices = vertex_count(scene);
  d.z_up = scene.z_up;
  d.bounds = bounds(scene);
  for (const Mesh& mesh : scene.meshes) add_mesh(mesh, d);
  for (const Light& light : scene.lights) add_light(light, d);
  for (const Camera& camera : scene.cameras) d.cameras.push_back(camera.name);
  for (const Material& material : scene.materials) d.materials.push_back(material.name);
  for (const Texture& texture : scene.textures) {
    d.textures.push_back({texture.name, texture.width, texture.height, texture.srgb});
    d.bytes += bytes_of(texture.texels) + bytes_of(texture.radiance);
  }
  return d;
}

}  // namespace delray::scenes
