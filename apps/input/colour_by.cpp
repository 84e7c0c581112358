// The table of colourings and the function behind each. Numbers run through a colour map between
// the ends of their usual range, so that outliers do not take all of the colours; materials lose
// what would tint the result.
#include "apps/input/colour_by.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "apps/input/inliers.h"
#include "apps/input/point_colours.h"
#include "apps/options/list.h"
#include "parallel/parallel_for.h"
#include "scenes/colour_map.h"

namespace delray::apps {
namespace {

constexpr std::size_t kGrain = 4096;  // some microseconds of colour look-ups

// The values between which the colours run: all but a few outliers.
std::pair<float, float> range_of(const std::vector<float>& values) {
  return usual_range(values.size(), [&](std::size_t i) { return values[i]; });
}

// Colours of numbers that mean nothing but themselves.
glm::vec4 distinct_colour(std::uint64_t number) {
  const std::uint64_t bits = (number + 1) * 0x9E3779B97F4A7C15U;
  const auto channel = [bits](int shift) {
    return 0.25F + 0.65F * static_cast<float>((bits >> shift) & 0xFF) / 255.0F;
  };
  return {channel(56), channel(40), channel(24), 1.0F};
}

void keep_materials(scenes::Scene&, const delaunay::PointCloud*) {}

void by_height(scenes::Scene& scene, const delaunay::PointCloud*) {
  whiten(scene);
  std::vector<std::vector<float>> heights(scene.meshes.size());
  std::vector<float> all;
  for (const scenes::Instance& instance : scene.instances) {
    const scenes::Mesh& mesh = scene.meshes[instance.mesh];
    std::vector<float>& own = heights[instance.mesh];
    if (!own.empty()) continue;  // a mesh placed several times is coloured by its first place
    own.resize(mesh.positions.size());
    const int up = scene.z_up ? 2 : 1;
    parallel::parallel_for(0, own.size(), kGrain, [&](std::size_t i) {
      own[i] = (instance.transform * glm::vec4(mesh.positions[i], 1.0F))[up];
    });
    all.insert(all.end(), own.begin(), own.end());
  }
  const std::pair<float, float> range = range_of(all);
  scene.colour_scale = height_scale(range, scene.origin[scene.z_up ? 2 : 1]);
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    if (!heights[m].empty()) scene.meshes[m].colours = height_colours(heights[m], range);
  }
}

void by_simplex(scenes::Scene& scene, const delaunay::PointCloud*) {
  whiten(scene);
  std::uint64_t number = 0;
  for (scenes::Mesh& mesh : scene.meshes) {
    colour_simplices(number, mesh);
    number += mesh.triangles.size();
  }
}

// The colours of the points that meshes[0] has as vertices.
void by_attribute(std::string_view name, scenes::Scene& scene, const delaunay::PointCloud* points) {
  const PointAttribute& attribute = *find_point_attribute(name);
  if (points == nullptr || !attribute.exists(*points)) {
    throw UsageError(fmt::format("--color-by: there are no points with {}", attribute.what));
  }
  whiten(scene);
  const AttributeValues all = attribute_values(attribute, *points);
  std::vector<glm::vec4>& colours = scene.meshes[0].colours;
  colours.resize(points->size());
  parallel::parallel_for(0, colours.size(), kGrain,
                         [&](std::size_t i) { colours[i] = attribute.colour(*points, i, all); });
  scene.colour_scale = attribute.scale(all);
}

void by_rgb(scenes::Scene& scene, const delaunay::PointCloud* points) {
  by_attribute("rgb", scene, points);
}
void by_intensity(scenes::Scene& scene, const delaunay::PointCloud* points) {
  by_attribute("intensity", scene, points);
}
void by_classification(scenes::Scene& scene, const delaunay::PointCloud* points) {
  by_attribute("classification", scene, points);
}
void by_returns(scenes::Scene& scene, const delaunay::PointCloud* points) {
  by_attribute("returns", scene, points);
}

constexpr std::array kTable = {
    ColourBy{"material", "the materials of the scene", keep_materials},
    ColourBy{"z", "height", by_height},
    ColourBy{"simplex", "a colour for each triangle", by_simplex},
    ColourBy{"rgb", "the colours of the points", by_rgb},
    ColourBy{"intensity", "the intensity of the points", by_intensity},
    ColourBy{"classification", "the class of the points", by_classification},
    ColourBy{"returns", "which return of how many the points are", by_returns},
};

}  // namespace

std::span<const ColourBy> colour_bys() { return kTable; }

std::vector<glm::vec4> height_colours(std::span<const float> heights,
                                      std::pair<float, float> range) {
  const float width = std::max(range.second - range.first, 1e-30F);
  const scenes::ColourMap& map = scenes::colour_maps().front();
  std::vector<glm::vec4> colours(heights.size());
  parallel::parallel_for(0, heights.size(), kGrain, [&](std::size_t i) {
    const float t = std::clamp((heights[i] - range.first) / width, 0.0F, 1.0F);
    colours[i] = glm::vec4(map.colour(t), 1.0F);
  });
  return colours;
}

scenes::ColourScale height_scale(std::pair<float, float> range, double origin,
                                 double exaggeration) {
  const auto bottom = static_cast<float>(origin);
  const auto stretched = static_cast<float>(exaggeration);
  return {"height",
          bottom + range.first / stretched,
          bottom + range.second / stretched,
          scenes::colour_maps().front().colour,
          {}};
}

void colour_simplices(std::uint64_t first, scenes::Mesh& mesh) {
  scenes::Mesh apart;
  apart.name = mesh.name;
  apart.material = mesh.material;
  for (const glm::uvec3& corners : mesh.triangles) {
    const auto vertex = static_cast<std::uint32_t>(apart.positions.size());
    for (int k = 0; k < 3; ++k) {
      apart.positions.push_back(mesh.positions[corners[k]]);
      apart.colours.push_back(distinct_colour(first + apart.triangles.size()));
      if (!mesh.normals.empty()) apart.normals.push_back(mesh.normals[corners[k]]);
    }
    apart.triangles.emplace_back(vertex, vertex + 1, vertex + 2);
  }
  mesh = std::move(apart);
}

void whiten(scenes::Scene& scene) {
  for (scenes::Material& material : scene.materials) {
    material.base_colour = glm::vec4(1.0F);
    material.base_colour_texture = scenes::kNone;
    material.metallic = 0.0F;
    material.metallic_roughness_texture = scenes::kNone;
    material.transmission = 0.0F;
  }
}

std::string_view default_colour_by(const delaunay::PointCloud& points) {
  if (!points.colours.empty()) return "rgb";
  const auto is_level = [&](const glm::dvec3& p) { return p.z == points.positions[0].z; };
  return std::ranges::all_of(points.positions, is_level) ? "simplex" : "z";
}

void colour_by(scenes::Scene& scene, std::string_view name, const delaunay::PointCloud* points) {
  scene.colour_scale.reset();
  find_entry(kTable, name, "--color-by").apply(scene, points);
}

}  // namespace delray::apps
