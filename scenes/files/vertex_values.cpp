// Checks coordinates, decodes sRGB colours of vertices by the table where a value is a code of 8
// bits, and makes scenes of a single mesh.
#include "scenes/files/vertex_values.h"

#include <algorithm>
#include <utility>

#include "image/srgb.h"
#include "scenes/files/source.h"
#include "scenes/geometry/origin.h"

namespace delray::scenes::internal {
namespace {

constexpr float kPlainGrey = 0.6F;  // sRGB; what importers take where a file says nothing

float linear_channel(double value) {
  const double code = value * 255, nearest = std::round(code);
  if (!(code > 0)) return 0;
  if (code >= 255) return 1;
  if (std::abs(code - nearest) < 1e-3)
    return image::decode_srgb(static_cast<std::uint8_t>(nearest));
  return image::decode_srgb_value(static_cast<float>(value));
}

}  // namespace

const char* wrong_with(const glm::dvec3& p) {
  const double largest = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  if (largest <= kLargestCoordinate && !std::isnan(p.x + p.y + p.z)) return nullptr;
  const bool finite = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  return finite ? "a coordinate is larger than 1e18" : "a coordinate is not finite";
}

template <int N>
glm::vec<N, double> read_coordinates(const Source& source, const Lines& lines, Words& words) {
  glm::vec<N, double> values;
  for (int i = 0; i < N; ++i) {
    const std::string_view word = words.next();
    if (word.empty()) source.fail(lines.place(), "a vertex needs more numbers");
    if (!parse(word, values[i])) {
      source.fail(lines.place(), "'" + std::string(word.substr(0, 40)) + "' is not a number");
    }
    if (const char* wrong = wrong_with({values[i], 0, 0})) source.fail(lines.place(), wrong);
  }
  return values;
}

template glm::dvec1 read_coordinates<1>(const Source&, const Lines&, Words&);
template glm::dvec3 read_coordinates<3>(const Source&, const Lines&, Words&);

void warn_if_coarse(const Source& source, double reach, double diagonal) {
  if (!(reach > kCoarse * diagonal)) return;
  source.warn(
      "the scene is far from the origin for its size, and the file keeps its coordinates in single "
      "precision: they are coarse");
}

glm::vec4 linear_colour(const glm::dvec4& srgb) {
  const double alpha = std::isfinite(srgb.a) ? std::clamp(srgb.a, 0.0, 1.0) : 1.0;
  return {linear_channel(srgb.r), linear_channel(srgb.g), linear_channel(srgb.b), alpha};
}

Material plain_material(bool has_colours) {
  Material material;
  const float grey = has_colours ? 1.0F : image::decode_srgb_value(kPlainGrey);
  material.base_colour = {grey, grey, grey, 1.0F};
  material.roughness = 0.8F;
  return material;
}

Scene scene_of(Mesh mesh, const glm::dvec3& origin) {
  Scene scene;
  scene.origin = origin;
  scene.materials.push_back(plain_material(!mesh.colours.empty()));
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back({0, glm::mat4x3(1.0F)});
  return scene;
}

}  // namespace delray::scenes::internal
