// Scenes from arrays: every number is checked here, since what renders trusts its scene.
#include "python/render/scene.h"

#include <pybind11/stl.h>

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "apps/input/scene_input.h"
#include "image/srgb.h"
#include "python/arrays.h"
#include "python/render/log.h"
#include "python/render/module.h"
#include "python/work.h"
#include "scenes/points.h"

namespace py = pybind11;

namespace delray::python {
namespace {

[[noreturn]] void refuse(const char* what, const std::string& why) {
  throw std::invalid_argument(std::string(what) + ": " + why);
}

// An array of `rows` rows (0: any number) and as many columns as a Value has floats.
template <class Value>
std::vector<Value> rows_of(const py::object& object, const char* what, std::size_t rows) {
  if (object.is_none()) return {};
  constexpr std::size_t kColumns = sizeof(Value) / sizeof(float);
  const PointArray array = point_array(object, what, kColumns, kColumns);
  const delaunay::PointView<double> view = array.view();
  if (rows != 0 && view.count != rows)
    refuse(what, std::to_string(view.count) + " rows for " + std::to_string(rows) + " positions");
  std::vector<Value> values(view.count);
  for (std::size_t i = 0; i < view.count; ++i) {
    for (std::size_t k = 0; k < kColumns; ++k) {
      const double x = view(i, static_cast<int>(k));
      if (!std::isfinite(x)) refuse(what, "row " + std::to_string(i) + " is not finite");
      values[i][static_cast<int>(k)] = static_cast<float>(x);
    }
  }
  return values;
}

// Positions relative to the scene's origin.
std::vector<glm::vec3> positions_of(const scenes::Scene& scene, const py::object& object) {
  const PointArray array = point_array(object, "positions", 3, 3);
  const delaunay::PointView<double> view = array.view();
  std::vector<glm::vec3> positions(view.count);
  for (std::size_t i = 0; i < view.count; ++i) {
    const glm::dvec3 p = glm::dvec3(view(i, 0), view(i, 1), view(i, 2)) - scene.origin;
    positions[i] = glm::vec3(p);
    for (int k = 0; k < 3; ++k) {
      if (!std::isfinite(positions[i][k]))
        refuse("positions",
               "row " + std::to_string(i) + " is not finite, or too far from the origin");
    }
  }
  return positions;
}

// Bytes are sRGB, floats are linear.
std::vector<glm::vec4> colours_of(const py::object& object, std::size_t rows) {
  if (object.is_none()) return {};
  const py::array array = py::array::ensure(object);
  if (!array) {
    PyErr_Clear();
    refuse("colors", "no array of numbers");
  }
  const PointArray numbers = point_array(array, "colors", 3, 4);
  const delaunay::PointView<double> view = numbers.view();
  if (view.count != rows)
    refuse("colors",
           std::to_string(view.count) + " rows for " + std::to_string(rows) + " positions");
  const bool is_bytes = array.dtype().kind() == 'u' && array.itemsize() == 1;
  std::vector<glm::vec4> colours(rows, glm::vec4(1.0F));
  for (std::size_t i = 0; i < rows; ++i) {
    for (int k = 0; k < static_cast<int>(numbers.columns); ++k) {
      const double x = view(i, k);
      if (!is_bytes && !(x >= 0.0 && x <= 1e9))
        refuse("colors", "row " + std::to_string(i) + " is below 0 or not finite");
      colours[i][k] = !is_bytes ? static_cast<float>(x)
                      : k == 3  ? image::decode_alpha(static_cast<std::uint8_t>(x))
                                : image::decode_srgb(static_cast<std::uint8_t>(x));
    }
  }
  return colours;
}

glm::mat4x3 transform_of(const py::object& object) {
  if (object.is_none()) return glm::mat4x3(1.0F);
  const auto array = whole_array<double>(object);
  if (array.ndim() != 2 || array.shape(1) != 4 || (array.shape(0) != 3 && array.shape(0) != 4))
    refuse("transform",
           "the shape is " + std::string(py::str(array.attr("shape"))) + ", not (3 or 4, 4)");
  glm::mat4x3 m;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      m[column][row] = static_cast<float>(array.data()[4 * row + column]);
      if (!std::isfinite(m[column][row])) refuse("transform", "not finite");
    }
  }
  return m;
}

std::uint32_t material_of(const scenes::Scene& scene, std::uint32_t material) {
  if (material >= scene.materials.size())
    refuse("material", std::to_string(material) + " does not exist");
  return material;
}

std::vector<glm::uvec3> triangles_of(const py::object& object, std::size_t rows) {
  const auto array = whole_array<std::int64_t>(object);
  if (array.ndim() != 2 || array.shape(1) != 3)
    refuse("triangles",
           "the shape is " + std::string(py::str(array.attr("shape"))) + ", not (n, 3)");
  std::vector<glm::uvec3> triangles(static_cast<std::size_t>(array.shape(0)));
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const std::int64_t row = array.data()[3 * i + static_cast<std::size_t>(k)];
      if (row < 0 || static_cast<std::size_t>(row) >= rows)
        refuse("triangles", std::to_string(row) + " is no row of positions");
      triangles[i][k] = static_cast<std::uint32_t>(row);
    }
  }
  return triangles;
}

std::uint32_t add_instance(SceneHandle& self, std::uint32_t mesh, const py::object& transform) {
  if (mesh >= self.scene.meshes.size()) refuse("mesh", std::to_string(mesh) + " does not exist");
  self.scene.instances.push_back({mesh, transform_of(transform)});
  return static_cast<std::uint32_t>(self.scene.instances.size() - 1);
}

std::uint32_t keep_mesh(SceneHandle& self, scenes::Mesh&& mesh, const py::object& transform,
                        bool place) {
  const glm::mat4x3 at = transform_of(transform);
  const auto number = static_cast<std::uint32_t>(self.scene.meshes.size());
  self.scene.meshes.push_back(std::move(mesh));
  if (place) self.scene.instances.push_back({number, at});
  return number;
}

std::uint32_t add_mesh(SceneHandle& self, const py::object& positions, const py::object& triangles,
                       const py::object& normals, const py::object& uvs, const py::object& colors,
                       std::uint32_t material, const py::object& transform, bool place) {
  scenes::Mesh mesh;
  mesh.positions = positions_of(self.scene, positions);
  const std::size_t rows = mesh.positions.size();
  mesh.triangles = triangles_of(triangles, rows);
  mesh.normals = rows_of<glm::vec3>(normals, "normals", rows);
  for (glm::vec3& normal : mesh.normals) {
    const float length = glm::length(normal);
    if (!(length > 0.0F)) refuse("normals", "one has no length");
    normal /= length;
  }
  mesh.uvs = rows_of<glm::vec2>(uvs, "uvs", rows);
  mesh.colours = colours_of(colors, rows);
  mesh.material = material_of(self.scene, material);
  return keep_mesh(self, std::move(mesh), transform, place);
}

std::uint32_t add_points(SceneHandle& self, const py::object& positions, const py::object& colors,
                         const std::string& shape, std::optional<float> radius,
                         std::optional<float> size, std::uint32_t material,
                         const py::object& transform, bool place) {
  scenes::Shape kind;
  if (shape == "point") {
    kind.kind = scenes::Shape::Kind::point;
  } else if (shape == "disc") {
    kind.kind = scenes::Shape::Kind::disc;
  } else if (shape == "sphere") {
    kind.kind = scenes::Shape::Kind::sphere;
  } else {
    refuse("shape", "'" + shape + "' is none of point, disc, sphere");
  }
  if (radius && size) refuse("radius", "not with size");
  kind.in_pixels = !radius;
  kind.radius = radius ? *radius : size.value_or(1.0F) / 2.0F;
  if (!(kind.radius >= 0.0F) || !std::isfinite(kind.radius)) refuse("radius", "not from 0 up");
  scenes::Mesh mesh;
  mesh.positions = positions_of(self.scene, positions);
  mesh.colours = colours_of(colors, mesh.positions.size());
  mesh.material = material_of(self.scene, material);
  make_points(mesh, kind);
  return keep_mesh(self, std::move(mesh), transform, place);
}

glm::vec3 vector_of(const std::vector<float>& values, const char* what) {
  if (values.size() != 3) refuse(what, "not three numbers");
  for (const float x : values) {
    if (!std::isfinite(x)) refuse(what, "not finite");
  }
  return {values[0], values[1], values[2]};
}

std::uint32_t add_texture(SceneHandle& self, const py::object& texels, bool srgb) {
  const auto array = whole_array<std::uint8_t>(texels);
  if (array.ndim() != 3 || (array.shape(2) != 3 && array.shape(2) != 4) || array.size() == 0)
    refuse("texture", "the shape is " + std::string(py::str(array.attr("shape"))) +
                          ", not (height, width, 3 or 4)");
  scenes::Texture texture;
  texture.height = static_cast<int>(array.shape(0));
  texture.width = static_cast<int>(array.shape(1));
  texture.srgb = srgb;
  const auto channels = static_cast<std::size_t>(array.shape(2));
  const auto pixels = static_cast<std::size_t>(array.shape(0) * array.shape(1));
  texture.texels.resize(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint8_t* const p = array.data() + i * channels;
    texture.texels[i] = {p[0], p[1], p[2], channels == 4 ? p[3] : std::uint8_t{255}};
  }
  self.scene.textures.push_back(std::move(texture));
  return static_cast<std::uint32_t>(self.scene.textures.size() - 1);
}

float unit(float x, const char* what) {
  if (!(x >= 0.0F && x <= 1.0F)) refuse(what, "not from 0 to 1");
  return x;
}

std::uint32_t add_material(SceneHandle& self, const std::vector<float>& base_color, float metallic,
                           float roughness, float transmission, float ior,
                           const std::vector<float>& emission, bool unlit, bool double_sided,
                           const py::object& texture) {
  scenes::Material material;
  if (base_color.size() != 3 && base_color.size() != 4)
    refuse("base_color", "not three or four numbers");
  for (std::size_t k = 0; k < base_color.size(); ++k)
    material.base_colour[static_cast<int>(k)] = unit(base_color[k], "base_color");
  if (material.base_colour.a < 1.0F) material.alpha = scenes::Material::Alpha::blend;
  material.metallic = unit(metallic, "metallic");
  material.roughness = unit(roughness, "roughness");
  material.transmission = unit(transmission, "transmission");
  if (!(ior >= 1.0F && ior <= 100.0F)) refuse("ior", "not from 1 to 100");
  material.ior = ior;
  material.emission = vector_of(emission, "emission");
  material.unlit = unlit;
  material.double_sided = double_sided;
  if (!texture.is_none()) material.base_colour_texture = add_texture(self, texture, true);
  self.scene.materials.push_back(material);
  return static_cast<std::uint32_t>(self.scene.materials.size() - 1);
}

void add_light(SceneHandle& self, const std::string& kind, const std::vector<float>& color,
               const std::vector<float>& position, const std::vector<float>& direction,
               const std::vector<float>& edge_u, const std::vector<float>& edge_v) {
  scenes::Light light;
  light.colour = vector_of(color, "color");
  const auto place = [&] {
    const glm::vec3 given = vector_of(position, "position");
    light.position = glm::vec3(glm::dvec3(given) - self.scene.origin);
  };
  if (kind == "point") {
    light.kind = scenes::Light::Kind::point;
    place();
  } else if (kind == "directional") {
    light.direction = vector_of(direction, "direction");
    if (!(glm::length(light.direction) > 0.0F)) refuse("direction", "has no length");
    light.direction = glm::normalize(light.direction);
  } else if (kind == "area") {
    light.kind = scenes::Light::Kind::area;
    place();
    light.edge_u = vector_of(edge_u, "edge_u");
    light.edge_v = vector_of(edge_v, "edge_v");
  } else {
    refuse("kind", "'" + kind + "' is none of point, directional, area");
  }
  self.scene.lights.push_back(light);
}

void set_sky(SceneHandle& self, const std::vector<float>& zenith, const std::vector<float>& horizon,
             const std::vector<float>& ground) {
  scenes::Environment sky;
  sky.up = self.scene.z_up ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
  sky.zenith = vector_of(zenith, "zenith");
  sky.horizon = vector_of(horizon, "horizon");
  sky.ground = vector_of(ground, "ground");
  self.scene.environment = sky;
}

py::tuple box_of(const SceneHandle& self) {
  const geometry::Box3 box = scenes::bounds(self.scene);
  const auto corner = [&](const glm::vec3& p) {
    return py::make_tuple(p.x + self.scene.origin.x, p.y + self.scene.origin.y,
                          p.z + self.scene.origin.z);
  };
  return py::make_tuple(corner(box.low), corner(box.high));
}

}  // namespace

void add_scene(py::module_& module) {
  using namespace py::literals;
  py::class_<SceneHandle>(module, "Scene")
      .def(py::init([](const std::array<double, 3>& origin, bool z_up) {
             auto handle = std::make_unique<SceneHandle>();
             handle->scene.origin = {origin[0], origin[1], origin[2]};
             handle->scene.z_up = z_up;
             handle->scene.materials.emplace_back();
             return handle;
           }),
           "origin"_a, "z_up"_a)
      .def("add_mesh", &add_mesh, "positions"_a, "triangles"_a, "normals"_a, "uvs"_a, "colors"_a,
           "material"_a, "transform"_a, "place"_a)
      .def("add_points", &add_points, "positions"_a, "colors"_a, "shape"_a, "radius"_a, "size"_a,
           "material"_a, "transform"_a, "place"_a)
      .def("add_instance", &add_instance, "mesh"_a, "transform"_a)
      .def("add_material", &add_material, "base_color"_a, "metallic"_a, "roughness"_a,
           "transmission"_a, "ior"_a, "emission"_a, "unlit"_a, "double_sided"_a, "texture"_a)
      .def("add_light", &add_light, "kind"_a, "color"_a, "position"_a, "direction"_a, "edge_u"_a,
           "edge_v"_a)
      .def("set_sky", &set_sky, "zenith"_a, "horizon"_a, "ground"_a)
      .def_property_readonly("bounds", &box_of)
      .def_property_readonly("triangles",
                             [](const SceneHandle& self) { return triangle_count(self.scene); })
      .def_property_readonly("points",
                             [](const SceneHandle& self) { return splat_count(self.scene); })
      .def_property_readonly("meshes",
                             [](const SceneHandle& self) { return self.scene.meshes.size(); })
      .def_property_readonly("instances",
                             [](const SceneHandle& self) { return self.scene.instances.size(); })
      .def_property_readonly("cameras", [](const SceneHandle& self) {
        std::vector<std::string> names;
        for (const scenes::Camera& camera : self.scene.cameras) names.push_back(camera.name);
        return names;
      });
}

}  // namespace delray::python
