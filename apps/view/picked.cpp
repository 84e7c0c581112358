// Facts of a primitive, from the scene as it is in memory.
#include "apps/view/picked.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "apps/input/point_colours.h"
#include "image/srgb.h"
#include "parallel/parallel_for.h"
#include "scenes/pick.h"

namespace delray::apps::view {
namespace {

std::string text_of(const glm::dvec3& v) {
  return fmt::format("{:.9g}, {:.9g}, {:.9g}", v.x, v.y, v.z);
}

// As people write it: "#rrggbb", with the alpha where there is one.
std::string colour_text(const glm::vec4& c) {
  const image::Rgba8 code = image::to_8bit(image::RgbaF{c.x, c.y, c.z, 1.0F});
  const std::string text = fmt::format("#{:02x}{:02x}{:02x}", code.r, code.g, code.b);
  return c.w < 1.0F ? fmt::format("{}, alpha {:.3g}", text, c.w) : text;
}

template <class T>
T at_corners(const std::vector<T>& values, const glm::uvec3& corners, const glm::vec3& weights) {
  return values[corners.x] * weights.x + values[corners.y] * weights.y +
         values[corners.z] * weights.z;
}

const char* kind_of(const scenes::Mesh& mesh) {
  if (mesh.has_triangles()) return "triangle";
  return mesh.shape.kind == scenes::Shape::Kind::line ? "segment" : "point";
}

void add_attributes(const scenes::Mesh& mesh, const glm::uvec3& corners, const glm::vec3& weights,
                    Json& facts) {
  if (!mesh.normals.empty()) {
    const glm::vec3 normal = at_corners(mesh.normals, corners, weights);
    const float length = glm::length(normal);
    if (length > 0) {
      const glm::vec3 n = normal / length;
      facts.push_back({"normal", fmt::format("{:.4f}, {:.4f}, {:.4f}", n.x, n.y, n.z)});
    }
  }
  if (!mesh.colours.empty())
    facts.push_back({"colour", colour_text(at_corners(mesh.colours, corners, weights))});
  if (!mesh.uvs.empty()) {
    const glm::vec2 uv = at_corners(mesh.uvs, corners, weights);
    facts.push_back({"texture", fmt::format("{:.5g}, {:.5g}", uv.x, uv.y)});
  }
}

// The row of points that a place is nearest to; of several the lowest. Exact but for the rounding
// of the place: a person clicks seldom, so all are looked at.
std::size_t nearest_row(const delaunay::PointCloud& points, const glm::dvec3& place) {
  constexpr std::size_t kRows = 1 << 16;  // of a task: some 50 us
  struct Found {
    double distance2 = std::numeric_limits<double>::infinity();
    std::size_t row = 0;
  };
  std::vector<Found> found((points.size() + kRows - 1) / kRows);
  parallel::parallel_for(0, found.size(), 1, [&](std::size_t block) {
    Found best;
    const std::size_t end = std::min(points.size(), (block + 1) * kRows);
    for (std::size_t i = block * kRows; i < end; ++i) {
      const glm::dvec3 apart = points.positions[i] - place;
      const double distance2 = glm::dot(apart, apart);
      if (distance2 < best.distance2) best = {distance2, i};
    }
    found[block] = best;
  });
  return std::ranges::min_element(found, {}, &Found::distance2)->row;
}

// What the file says of the point that the pick's nearest corner is.
void add_point(const delaunay::PointCloud& points, const glm::dvec3& corner, Json& facts) {
  const std::size_t row = nearest_row(points, corner);
  facts.push_back({"nearest point", "row " + std::to_string(row)});
  for (const PointAttribute& attribute : point_attributes()) {
    if (attribute.exists(points))
      facts.push_back({std::string(attribute.name), attribute.text(points, row)});
  }
}

void add_numbers(const scenes::Scene& scene, const scenes::Pick& pick, Json& facts) {
  const std::uint32_t mesh_number = scene.instances[pick.instance].mesh;
  const scenes::Mesh& mesh = scene.meshes[mesh_number];
  const glm::uvec3& corners = mesh.triangles[pick.triangle];
  facts.push_back({kind_of(mesh), std::to_string(pick.triangle)});
  facts.push_back({"instance", std::to_string(pick.instance)});
  facts.push_back({"mesh", mesh.name.empty() ? std::to_string(mesh_number)
                                             : fmt::format("{} ({})", mesh_number, mesh.name)});
  if (mesh.has_triangles()) {
    facts.push_back({"vertices", fmt::format("{}, {}, {}", corners.x, corners.y, corners.z)});
  } else {
    facts.push_back({"vertex", std::to_string(corners.y)});
  }
}

std::uint32_t nearest_corner(const glm::uvec3& corners, const glm::vec3& weights) {
  int best = 0;
  for (int i = 1; i < 3; ++i)
    if (weights[i] > weights[best]) best = i;
  return corners[best];
}

}  // namespace

Json picked(const Task& task, const Prepared& prepared) {
  Json answer = {{"type", "pick"}, {"hit", false}, {"x", task.pick.x}, {"y", task.pick.y}};
  const scenes::Scene& scene = prepared.scene;
  const scenes::View view =
      scenes::make_view(task.order.camera, task.order.width, task.order.height);
  const auto pick = scenes::pick(scene, view, task.pick.x * static_cast<float>(task.order.width),
                                 task.pick.y * static_cast<float>(task.order.height));
  if (!pick) return answer;
  const scenes::Mesh& mesh = scene.meshes[scene.instances[pick->instance].mesh];
  const glm::uvec3& corners = mesh.triangles[pick->triangle];
  Json facts = Json::array();
  // As heights were before they were stretched.
  const glm::dvec3 stretch(1, 1, task.order.look->still.scene.exaggeration);
  const glm::dvec3 measured = pick->position / stretch;
  facts.push_back({"coordinates", text_of(measured + scene.origin)});
  if (!prepared.is_preview) add_numbers(scene, *pick, facts);
  if (mesh.material < scene.materials.size()) {
    const std::string& name = scene.materials[mesh.material].name;
    facts.push_back({"material", name.empty() ? std::to_string(mesh.material)
                                              : fmt::format("{} ({})", mesh.material, name)});
  }
  add_attributes(mesh, corners, pick->weights, facts);
  if (prepared.file_points && prepared.file_points->size() > 0) {
    const glm::dvec3 corner(mesh.positions[nearest_corner(corners, pick->weights)]);
    add_point(*prepared.file_points, corner / stretch + scene.origin, facts);
  }
  answer["hit"] = true;
  answer["measured"] = {measured.x, measured.y, measured.z};
  answer["position"] = {pick->position.x, pick->position.y, pick->position.z};
  answer["origin"] = {scene.origin.x, scene.origin.y, scene.origin.z};
  answer["depth"] = pick->depth;
  answer["facts"] = facts;
  return answer;
}

}  // namespace delray::apps::view
