// A scene to render: meshes, placed by instances, with materials, textures, lights and cameras.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "geometry/box.h"
#include "image/image.h"
#include "scenes/animation.h"
#include "scenes/camera.h"
#include "scenes/none.h"

namespace delray::scenes {

// How the primitives of a mesh look: triangles, or splats of one radius around points or segments.
struct Shape {
  enum class Kind : std::uint8_t {
    triangle,
    point,   // a round spot of one depth on the screen; needs a rasterizer
    disc,    // at right angles to the normal, or without one to the line of sight
    sphere,  //
    line     // a segment with round ends
  } kind = Kind::triangle;
  // In pixels of the picture rather than in units of the mesh, which an instance scales by the
  // longest axis of its transform.
  bool in_pixels = true;
  float radius = 0.5F;  // finite, >= 0

  bool operator==(const Shape&) const = default;
};

// Indexed triangles with one material, or points or segments, which are triangles without area: of
// a point all three corners are one vertex, of a segment the second and the third. So everything
// that shares out, counts and sends triangles knows them too. Attributes are empty or have one
// value per vertex. Points and segments are opaque; their uvs and tangents are not looked at.
struct Mesh {
  std::string name;
  Shape shape;
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;   // unit length
  std::vector<glm::vec2> uvs;       // v grows downwards, as rows of the texture do
  std::vector<glm::vec2> uvs2;      // the same for textures of set 1; none where there are no uvs
  std::vector<glm::vec4> tangents;  // xyz unit length, w = handedness: bitangent = w * cross(n, t)
  std::vector<glm::vec4> colours;   // linear, straight alpha; multiplies the base colour
  std::vector<glm::uvec3>
      triangles;  // indices into the attributes; counter-clockwise seen from outside
  std::uint32_t material = 0;

  bool has_triangles() const { return shape.kind == Shape::Kind::triangle; }
  // The coordinates for textures of a set.
  const std::vector<glm::vec2>& uvs_of(int set) const { return set == 0 ? uvs : uvs2; }
};

// A mesh placed in the world. The same mesh may be placed many times.
struct Instance {
  std::uint32_t mesh = 0;
  glm::mat4x3 transform{1.0F};  // columns: x, y, z axis and origin of the mesh in the world
};

// glTF's metallic-roughness model with its extensions. Textures multiply their factor; kNone: none.
struct Material {
  std::string name;
  glm::vec4 base_colour{0.8F, 0.8F, 0.8F, 1.0F};  // linear
  float metallic = 0.0F, roughness = 0.6F;
  float transmission = 0.0F, ior = 1.5F;  // transmission 1: glass
  bool unlit = false;                     // shows its base colour whatever the light
  glm::vec3 emission{0.0F};               // radiance
  float normal_scale = 1.0F;
  enum class Alpha : std::uint8_t { opaque, mask, blend } alpha = Alpha::opaque;
  float alpha_cutoff = 0.5F;
  bool double_sided = true;

  // Multiplies what a dielectric reflects; the colour does so at normal incidence only.
  float specular = 1.0F;
  glm::vec3 specular_colour{1.0F};
  float clearcoat = 0.0F, clearcoat_roughness = 0.0F;  // varnish on top of everything else
  glm::vec3 sheen_colour{0.0F};                        // of fibres that stand up, under the coat
  float sheen_roughness = 0.0F;
  // Inside a body that transmits, light of this colour is left after so long a way.
  glm::vec3 attenuation_colour{1.0F};
  float attenuation_distance = std::numeric_limits<float>::infinity();
  // The thickness of the body, for renderers that do not follow light through it; 0: a pane without
  // an inside, which light passes straight.
  float thickness = 1.0F;

  std::uint32_t base_colour_texture = kNone;
  std::uint32_t metallic_roughness_texture = kNone;  // G roughness, B metallic
  std::uint32_t normal_texture = kNone;
  std::uint32_t emission_texture = kNone;
  std::uint32_t transmission_texture = kNone;  // R
  std::uint32_t specular_texture = kNone;      // A
  std::uint32_t specular_colour_texture = kNone;
  std::uint32_t clearcoat_texture = kNone;            // R
  std::uint32_t clearcoat_roughness_texture = kNone;  // G
  std::uint32_t sheen_colour_texture = kNone;
  std::uint32_t sheen_roughness_texture = kNone;  // A

  static constexpr int kTextures = 11;
  // All of them, in the order above.
  std::array<std::uint32_t*, kTextures> textures();
  std::array<std::uint32_t, kTextures> textures() const;
  bool textured() const;  // has any
};

// Texels, or linear light of an environment, and how places beyond the border are looked up.
struct Texture {
  std::string name;
  int width = 0, height = 0;
  std::vector<image::Rgba8> texels;  // straight alpha, top row first
  bool srgb = true;                  // colours; false: data such as normals, used as they are
  enum class Wrap : std::uint8_t { repeat, mirror, clamp } wrap_u = Wrap::repeat,
                                                           wrap_v = Wrap::repeat;
  std::uint8_t set = 0;  // looked up at Mesh::uvs; 1: at uvs2
  // In place of texels: linear light without an upper limit, opaque. Of environments only.
  std::vector<glm::vec3> radiance{};
};

// A point, directional or area light.
struct Light {
  enum class Kind : std::uint8_t {
    point,        // radiant intensity `colour` at `position`
    directional,  // irradiance `colour` on a surface facing it; light travels along `direction`
    area,         // radiance `colour` from the parallelogram position + s*edge_u + t*edge_v,
                  // 0 <= s, t <= 1, on the side of cross(edge_u, edge_v)
  } kind = Kind::directional;
  glm::vec3 colour{1.0F};
  glm::vec3 position{0.0F}, direction{0, 0, -1}, edge_u{0.0F}, edge_v{0.0F};
};

// Light from everywhere: a latitude-longitude texture (`up` is its top) or, without one, a gradient
// from `horizon` to `zenith` above and to `ground` below. The texture is turned around `up` by
// `rotation` degrees, counter-clockwise for who looks down.
struct Environment {
  std::uint32_t texture = kNone;
  float rotation = 0.0F;
  glm::vec3 up{0, 1, 0};
  glm::vec3 zenith{0.0F}, horizon{0.0F}, ground{0.0F};  // radiance
};

// What the colours of vertices tell, for a legend: a number that runs through a map, or classes.
struct ColourScale {
  std::string title;
  float low = 0, high = 1;               // of the map's ends
  glm::vec3 (*colour)(float) = nullptr;  // linear, from 0 to 1; null: there are classes
  struct Class {
    std::string name;
    glm::vec3 colour;  // linear
  };
  std::vector<Class> classes;
};

// Everything that is rendered.
struct Scene {
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  std::vector<Material> materials;  // at least one
  std::vector<Texture> textures;
  std::vector<Light> lights;
  Environment environment;
  std::vector<Camera> cameras;  // those of the file; may be empty
  glm::dvec3 origin{0.0};       // added to a position gives the coordinates of the file (UTM ...)
  bool z_up = false;
  // Other files that the scene's file names (textures, buffers, materials), whether they are there
  // and read or not; relative to the working folder. Sorted, each once.
  std::vector<std::string> files;
  std::optional<ColourScale> colour_scale;  // where vertices were coloured by one
  geometry::Box3 framed;                    // what cameras around the scene show; empty: all of it
  Animations animations;                    // how it moves; scenes/pose.h
};

// Triangles, points and segments, and vertices of all instances. O(instances).
std::uint64_t triangle_count(const Scene& scene);
std::uint64_t splat_count(const Scene& scene);
std::uint64_t vertex_count(const Scene& scene);

// The box of all instances, transformed vertex by vertex; empty for an empty scene. Parallel.
geometry::Box3 bounds(const Scene& scene);

// Primitive numbers: triangle (or point or segment) t of instance i is number first_primitive[i] +
// t. One more element than instances: the last is the count.
std::vector<std::uint64_t> first_primitives(const Scene& scene);

// Whether anything lights the scene: a light, an environment, or surfaces that emit it
// (is_lit_by_emission). O(triangles that glow).
bool has_light(const Scene& scene);

// Whether emission lights the scene: white surfaces around it would on average be no darker than
// code 8 of 255 by it. Textures that are nowhere brighter than 1 are screens and signs, which
// light nothing. O(triangles that glow); parallel.
bool is_lit_by_emission(const Scene& scene);

// Adds a key light over the shoulder of who looks through `camera`, and a sky in place of the
// environment. A diffuse surface of albedo 0.8 that faces the key light then has a radiance of
// about 0.75 times `strength`.
void add_default_light(Scene& scene, const Camera& camera, float strength = 1.0F);

// Adds what a picture needs and the file does not have: a material, normals (area-weighted, not
// over creases sharper than `crease_degrees`) and tangents where a normal texture needs them.
// Vertices on creases are split, triangles keep their numbers. Idempotent.
void complete_surfaces(Scene& scene, float crease_degrees = 60.0F);

// That, and the default light where nothing lights the scene. Idempotent.
void complete(Scene& scene, const Camera& camera, float crease_degrees = 60.0F);

}  // namespace delray::scenes
