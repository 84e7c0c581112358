// Points and triangulations that are given as arrays or files: verify, simplify_terrain, generate,
// read and write.
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "delaunay/generate.h"
#include "delaunay/methods.h"
#include "delaunay/read_mesh.h"
#include "delaunay/read_points.h"
#include "delaunay/simplify_terrain.h"
#include "delaunay/verify.h"
#include "delaunay/write_mesh.h"
#include "python/arrays.h"
#include "python/module.h"
#include "python/work.h"

namespace py = pybind11;

namespace delray::python {
namespace {

// Row numbers as they are stored, (n, corners). Throws std::invalid_argument for negative ones.
std::vector<std::uint32_t> simplex_rows(const py::object& simplices, int corners) {
  const auto array = whole_array<std::int64_t>(simplices);
  if (array.ndim() != 2 || array.shape(1) != corners) {
    throw std::invalid_argument("simplices: the shape is " +
                                std::string(py::str(array.attr("shape"))) + ", not (n, " +
                                std::to_string(corners) + ")");
  }
  const std::span<const std::int64_t> from(array.data(), static_cast<std::size_t>(array.size()));
  std::vector<std::uint32_t> rows(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (from[i] < 0 || from[i] >= std::int64_t{0xFFFFFFFF})
      throw std::invalid_argument("simplices: " + std::to_string(from[i]) + " is no row of points");
    rows[i] = static_cast<std::uint32_t>(from[i]);
  }
  return rows;
}

py::dict verify(const py::object& points, const py::object& simplices, std::optional<int> dim,
                std::optional<int> threads) {
  const PointArray array = point_array(points, "points", 2, 3);
  const int d = dim.value_or(static_cast<int>(array.columns));
  const std::vector<std::uint32_t> rows = simplex_rows(simplices, d + 1);
  const delaunay::Verdict verdict = run({thread_count(threads)}, [&](parallel::Progress&) {
    return delaunay::verify_simplices(d, array.view(), rows);
  });
  py::dict result;
  result["valid"] = verdict.valid;
  result["delaunay"] = verdict.delaunay;
  result["canonical"] = verdict.canonical;
  result["simplex"] = verdict.simplex;
  result["reason"] = verdict.reason;
  result["distinct"] = verdict.distinct;
  return result;
}

py::tuple simplify_terrain(const py::object& points, double max_error) {
  const PointArray array = point_array(points, "points", 3, 3);
  delaunay::SimplifiedTerrain made = run({1, true}, [&](parallel::Progress& progress) {
    return delaunay::simplify_terrain(array.view(), max_error, &progress);
  });
  const auto kept = static_cast<py::ssize_t>(made.kept.size());
  const auto count = static_cast<py::ssize_t>(made.triangulation.size());
  return py::make_tuple(taken_as_signed(std::move(made.kept), {kept}),
                        taken_as_signed(std::move(made.triangulation.vertices), {count, 3}),
                        made.largest_error);
}

// An array that takes over a cloud's attribute, in columns of the first axis.
template <class Scalar, class Value>
py::object attribute(std::vector<Value>&& values) {
  if (values.empty()) return py::none();
  const auto count = static_cast<py::ssize_t>(values.size());
  constexpr auto kColumns = static_cast<py::ssize_t>(sizeof(Value) / sizeof(Scalar));
  auto kept = std::make_unique<std::vector<Value>>(std::move(values));
  const auto* const data = reinterpret_cast<const Scalar*>(kept->data());
  const py::capsule owner(kept.get(), [](void* p) { delete static_cast<std::vector<Value>*>(p); });
  kept.release();  // NOLINT(bugprone-unused-return-value): the capsule's now
  std::vector<py::ssize_t> shape = {count};
  if (kColumns > 1) shape.push_back(kColumns);
  return py::array_t<Scalar>(shape, data, owner);
}

// Without z only the first two columns, of the same memory.
py::dict cloud_dict(delaunay::PointCloud&& cloud) {
  py::dict result;
  const bool has_z = cloud.has_z;
  const auto positions = cloud.positions.empty() ? py::object(new_array<double>({0, 3}))
                                                 : attribute<double>(std::move(cloud.positions));
  result["points"] =
      has_z ? positions : py::object(positions[py::make_tuple(py::ellipsis(), py::slice(0, 2, 1))]);
  result["colors"] = attribute<std::uint8_t>(std::move(cloud.colours));
  result["intensity"] = attribute<float>(std::move(cloud.intensity));
  result["classification"] = attribute<std::uint8_t>(std::move(cloud.classification));
  result["returns"] = attribute<std::uint8_t>(std::move(cloud.returns));
  result["warnings"] = cloud.warnings;
  return result;
}

py::dict read_points(const std::string& path) {
  return cloud_dict(run({thread_count({}), true},
                        [&](parallel::Progress&) { return delaunay::read_points(path); }));
}

py::dict read_mesh(const std::string& path) {
  delaunay::PointMesh mesh =
      run({thread_count({}), true}, [&](parallel::Progress&) { return delaunay::read_mesh(path); });
  const int corners = mesh.triangulation.dim + 1;
  const auto count = static_cast<py::ssize_t>(mesh.triangulation.size());
  py::dict result = cloud_dict(std::move(mesh.points));
  result["simplices"] = taken_as_signed(std::move(mesh.triangulation.vertices), {count, corners});
  return result;
}

void write_mesh(const std::string& path, const py::object& points, const py::object& simplices) {
  const PointArray array = point_array(points, "points", 2, 3);
  const auto numbers = whole_array<std::int64_t>(simplices);
  const int corners = numbers.ndim() == 2 && numbers.shape(1) == 4 ? 4 : 3;
  delaunay::Triangulation mesh;
  mesh.dim = corners - 1;
  mesh.vertices = simplex_rows(simplices, corners);
  const delaunay::PointView<double> view = array.view();
  delaunay::PointCloud cloud;
  cloud.has_z = array.columns == 3;
  cloud.positions.resize(view.count);
  for (std::size_t i = 0; i < view.count; ++i)
    cloud.positions[i] = {view(i, 0), view(i, 1), cloud.has_z ? view(i, 2) : 0.0};
  run({thread_count({}), true},
      [&](parallel::Progress&) { delaunay::write_mesh(path, cloud, mesh); });
}

py::array generate_points(const std::string& kind, std::size_t n, int dim, std::uint64_t seed) {
  py::dict made = cloud_dict(run({thread_count({}), true}, [&](parallel::Progress&) {
    return delaunay::generate_points(kind, n, dim, seed);
  }));
  return made["points"];
}

// Names and descriptions of a table.
template <class Table>
py::dict table(const Table& rows) {
  py::dict result;
  for (const auto& row : rows)
    result[py::str(std::string(row.name))] = std::string(row.description);
  return result;
}

}  // namespace

void add_points(py::module_& module) {
  using namespace py::literals;
  module.def("verify", &verify, "points"_a, "simplices"_a, "dim"_a, "threads"_a);
  module.def("simplify_terrain", &simplify_terrain, "points"_a, "max_error"_a);
  module.def("read_points", &read_points, "path"_a);
  module.def("read_mesh", &read_mesh, "path"_a);
  module.def("write_mesh", &write_mesh, "path"_a, "points"_a, "simplices"_a);
  module.def("generate_points", &generate_points, "kind"_a, "n"_a, "dim"_a, "seed"_a);
  module.def("methods", [] { return table(delaunay::methods()); });
}

}  // namespace delray::python
