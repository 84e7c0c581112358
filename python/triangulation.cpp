// Triangulation: a finished triangulation with its points and what is asked of it, behind
// delray.Delaunay.
#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>

#include "delaunay/interpolate.h"
#include "delaunay/quality.h"
#include "delaunay/query.h"
#include "delaunay/triangulate.h"
#include "delaunay/voronoi.h"
#include "delaunay/write_mesh.h"
#include "parallel/parallel_for.h"
#include "python/arrays.h"
#include "python/module.h"
#include "python/work.h"

namespace py = pybind11;

namespace delray::python {
namespace {

using Rows = py::array_t<std::int32_t>;

// What takes a fraction of a look for signals need not be interrupted.
constexpr std::size_t kFewPoints = 20000, kFewPlaces = 2000;
constexpr std::size_t kPlacesTogether = 256;  // microseconds each

py::ssize_t signed_size(std::size_t n) { return static_cast<py::ssize_t>(n); }

py::dict statistics_of(const delaunay::Statistics& s) {
  py::dict seconds, sync, all;
  seconds["order"] = s.order;
  seconds["locate"] = s.locate;
  seconds["subdivide"] = s.subdivide;
  seconds["legalize"] = s.legalize;
  seconds["extract"] = s.extract;
  sync["lock_calls"] = s.synchronization.lock_calls;
  sync["already_locked"] = s.synchronization.already_locked;
  sync["free"] = s.synchronization.free;
  sync["waits"] = s.synchronization.waits;
  sync["deadlocks"] = s.synchronization.deadlocks;
  sync["rollbacks"] = s.synchronization.rollbacks;
  sync["repaired"] = s.synchronization.repaired;
  sync["fragments"] = s.synchronization.fragments;
  all["seconds"] = seconds;
  all["sync"] = sync;
  return all;
}

// Places that are asked about: (..., dim), and the shape of what is answered, (...).
struct Places {
  py::array_t<double, py::array::c_style | py::array::forcecast> array;
  std::size_t count = 0;
  std::vector<py::ssize_t> shape;

  Places(const py::object& object, int dim) : array(whole_array<double>(object)) {
    const py::ssize_t axes = array.ndim();
    if (axes < 1 || array.shape(axes - 1) != dim) {
      throw std::invalid_argument("xi: the shape is " + std::string(py::str(array.attr("shape"))) +
                                  ", not (..., " + std::to_string(dim) + ")");
    }
    shape.assign(array.shape(), array.shape() + axes - 1);
    count = static_cast<std::size_t>(array.size() / dim);
  }
  Work work(int threads) const {
    const bool few = count < kFewPlaces;
    return {few ? 1 : threads, !few};
  }
};

class Mesh {
 public:
  Mesh(const py::object& points, std::optional<int> dim, const delaunay::Options& how,
       std::optional<int> threads)
      : points_(point_array(points, "points", 2, 3)), threads_(thread_count(threads)) {
    delaunay::Options options = how;
    options.dim = dim.value_or(static_cast<int>(points_.columns));
    if (options.dim == 3 && points_.columns == 2)
      throw std::invalid_argument(
          "points: a triangulation in space needs points with three columns");
    options.threads = threads_;
    const delaunay::PointView<double> view = points_.view();
    delaunay::Result result =
        run({threads_, view.count > kFewPoints}, [&](parallel::Progress& progress) {
          options.progress = &progress;
          return triangulate(view, options);
        });
    triangulation_ = std::move(result.triangulation);
    if (how.statistics) statistics_ = statistics_of(result.statistics);
  }

  int dim() const { return triangulation_.dim; }
  const PointArray& points() const { return points_; }
  const delaunay::Triangulation& triangulation() const { return triangulation_; }
  const py::object& statistics() const { return statistics_; }
  int threads() const { return threads_; }

  // Made on first use. With the interpreter's lock.
  const delaunay::Query& query() {
    if (!query_) {
      auto made = run({threads_}, [&](parallel::Progress&) {
        return std::make_unique<delaunay::Query>(points_.view(), triangulation_);
      });
      if (!query_) query_ = std::move(made);  // another thread of Python may have been here
    }
    return *query_;
  }

  Rows locate(const py::object& xi) {
    const Places places(xi, dim());
    Rows found = new_array<std::int32_t>(places.shape);
    const delaunay::Query& q = query();
    std::int32_t* const to = found.mutable_data();
    for_each_place(places, [&](std::size_t first, std::size_t last) {
      std::uint32_t before = delaunay::Query::kNone;
      for (std::size_t i = first; i < last; ++i) {
        const glm::dvec3 place = at(places, i);
        const std::uint32_t simplex =
            is_near(q, before, place) ? q.locate(place, before) : q.locate(place);
        to[i] = static_cast<std::int32_t>(simplex);
        before = simplex;
      }
    });
    return found;
  }

  Rows nearest(const py::object& xi) {
    const Places places(xi, dim());
    Rows found = new_array<std::int32_t>(places.shape);
    const delaunay::Query& q = query();
    std::int32_t* const to = found.mutable_data();
    for_each_place(places, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i)
        to[i] = static_cast<std::int32_t>(q.nearest(at(places, i)));
    });
    return found;
  }

  // `values`: one per row of points.
  py::array_t<double> interpolate(const py::object& values, const py::object& xi, bool is_natural,
                                  double outside) {
    const auto of_rows = whole_array<double>(values);
    if (of_rows.ndim() != 1 || of_rows.shape(0) != points_.array.shape(0)) {
      throw std::invalid_argument("values: the shape is " +
                                  std::string(py::str(of_rows.attr("shape"))) + ", not (" +
                                  std::to_string(points_.array.shape(0)) + ",)");
    }
    const Places places(xi, dim());
    py::array_t<double> result = new_array<double>(places.shape);
    const delaunay::Query& q = query();
    const std::span<const double> numbers(of_rows.data(), static_cast<std::size_t>(of_rows.size()));
    double* const to = result.mutable_data();
    for_each_place(places, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        const auto value = is_natural ? interpolate_natural_neighbour(q, numbers, at(places, i))
                                      : interpolate_linear(q, numbers, at(places, i));
        to[i] = value.value_or(outside);
      }
    });
    return result;
  }

  // Rows beside each other: those of row i are second[first[i]] .. second[first[i + 1] - 1].
  py::tuple vertex_neighbours() {
    const delaunay::Query& q = query();
    const std::size_t rows = q.points().size();
    constexpr std::size_t kRowsTogether = 4096;
    const std::size_t blocks = (rows + kRowsTogether - 1) / kRowsTogether;
    std::vector<std::vector<std::uint32_t>> found(blocks);
    std::vector<std::uint32_t> begin(rows + 1, 0), all;
    run({threads_, rows > kFewPoints}, [&](parallel::Progress& progress) {
      parallel::parallel_for(0, blocks, 1, [&](std::size_t block) {
        const std::size_t last = std::min(rows, (block + 1) * kRowsTogether);
        for (std::size_t row = block * kRowsTogether; row < last; ++row) {
          const std::vector<std::uint32_t> around =
              vertices_around(triangulation_, q.adjacency(), static_cast<std::uint32_t>(row));
          begin[row + 1] = static_cast<std::uint32_t>(around.size());
          found[block].insert(found[block].end(), around.begin(), around.end());
        }
        progress.advance();
      });
      for (std::size_t row = 0; row < rows; ++row) begin[row + 1] += begin[row];
      all.resize(begin.back());
      parallel::parallel_for(0, blocks, 1, [&](std::size_t block) {
        std::copy(found[block].begin(), found[block].end(),
                  all.begin() + begin[block * kRowsTogether]);
      });
    });
    const py::ssize_t count = signed_size(all.size());
    return py::make_tuple(taken_as_signed(std::move(begin), {signed_size(rows) + 1}),
                          taken_as_signed(std::move(all), {count}));
  }

  py::dict voronoi() {
    const delaunay::Query& q = query();
    delaunay::Voronoi v = run({threads_}, [&](parallel::Progress&) {
      return delaunay::voronoi(points_.view(), triangulation_, q.adjacency());
    });
    const py::ssize_t edges = signed_size(v.edges.size()) / 2;
    py::dict result;
    result["vertices"] = plain(v.vertices);
    result["edges"] = taken_as_signed(std::move(v.edges), {edges, 2});
    const py::ssize_t rays = signed_size(v.ray_starts.size());
    result["ray_starts"] = taken_as_signed(std::move(v.ray_starts), {rays});
    result["ray_directions"] = plain(v.ray_directions);
    const py::ssize_t begins = signed_size(v.cell_begin.size());
    const py::ssize_t cells = signed_size(v.cells.size());
    result["cell_begin"] = taken_as_signed(std::move(v.cell_begin), {begins});
    result["cells"] = taken_as_signed(std::move(v.cells), {cells});
    return result;
  }

  py::dict quality() {
    const delaunay::Quality q = run({threads_}, [&](parallel::Progress&) {
      return delaunay::quality(points_.view(), triangulation_);
    });
    py::dict result;
    result["simplices"] = q.simplices;
    result["min_angle"] = q.min_angle;
    result["max_angle"] = q.max_angle;
    result["mean_min_angle"] = q.mean_min_angle;
    result["min_radius_ratio"] = q.min_radius_ratio;
    result["mean_radius_ratio"] = q.mean_radius_ratio;
    result["angles"] = std::vector<std::size_t>(q.angles.begin(), q.angles.end());
    result["radius_ratios"] =
        std::vector<std::size_t>(q.radius_ratios.begin(), q.radius_ratios.end());
    return result;
  }

 private:
  static glm::dvec3 at(const Places& places, std::size_t i) {
    const auto dim = static_cast<std::size_t>(places.array.shape(places.array.ndim() - 1));
    const double* const p = places.array.data() + i * dim;
    return {p[0], p[1], dim == 3 ? p[2] : 0.0};
  }

  // Whether a walk from the simplex is likely to be short: the place is within a few of its sizes.
  bool is_near(const delaunay::Query& q, std::uint32_t simplex, const glm::dvec3& place) const {
    if (simplex == delaunay::Query::kNone) return false;
    const std::size_t corners = static_cast<std::size_t>(dim()) + 1;
    const glm::dvec3 a = q.position(triangulation_.vertices[simplex * corners]);
    const glm::dvec3 b = q.position(triangulation_.vertices[simplex * corners + 1]);
    constexpr double kFewSimplices = 16;
    return glm::distance(a, place) < kFewSimplices * glm::distance(a, b);
  }

  template <class F>
  void for_each_place(const Places& places, F&& f) {
    run(places.work(threads_), [&](parallel::Progress& progress) {
      parallel::parallel_blocks(0, places.count, kPlacesTogether,
                                [&](std::size_t first, std::size_t last) {
                                  f(first, last);
                                  progress.advance(last - first);
                                });
    });
  }

  // (n, dim)
  py::array_t<double> plain(const std::vector<glm::dvec3>& places) const {
    py::array_t<double> array = new_array<double>({signed_size(places.size()), dim()});
    double* to = array.mutable_data();
    for (const glm::dvec3& p : places) {
      for (int k = 0; k < dim(); ++k) *to++ = p[k];
    }
    return array;
  }

  PointArray points_;
  int threads_;
  delaunay::Triangulation triangulation_;
  std::unique_ptr<delaunay::Query> query_;
  py::object statistics_ = py::none();
};

// Arrays over what the mesh has, which keep it alive.
Rows simplices(const py::object& self) {
  const auto& mesh = self.cast<const Mesh&>();
  const delaunay::Triangulation& t = mesh.triangulation();
  return borrowed(as_signed(t.vertices), {signed_size(t.size()), t.dim + 1}, self);
}

Rows neighbors(const py::object& self) {
  auto& mesh = self.cast<Mesh&>();
  return borrowed(as_signed(mesh.query().adjacency().neighbours),
                  {signed_size(mesh.triangulation().size()), mesh.dim() + 1}, self);
}

Rows simplex_at(const py::object& self) {
  auto& mesh = self.cast<Mesh&>();
  const std::vector<std::uint32_t>& at = mesh.query().adjacency().simplex_at;
  return borrowed(as_signed(at), {signed_size(at.size())}, self);
}

std::unique_ptr<Mesh> make_mesh(const py::object& points, std::optional<int> dim,
                                const std::string& method, const std::string& location,
                                const std::string& split, const std::string& order,
                                const std::string& deadlocks, const std::string& locks,
                                const std::string& unlock, int searching, std::size_t queue,
                                std::uint64_t seed, std::optional<int> threads, bool statistics) {
  delaunay::Options how;
  how.method = method;
  how.location = location;
  how.split = split;
  how.order = order;
  how.deadlocks = deadlocks;
  how.locks = locks;
  how.unlock = unlock;
  how.searching = searching;
  how.queue = queue;
  how.seed = seed;
  how.statistics = statistics;
  return std::make_unique<Mesh>(points, dim, how, threads);
}

}  // namespace

void add_triangulation(py::module_& module) {
  using namespace py::literals;
  const char* const any = "auto";
  py::class_<Mesh>(module, "Triangulation")
      .def(py::init(&make_mesh), "points"_a, py::kw_only(), "dim"_a = py::none(), "method"_a = any,
           "location"_a = any, "split"_a = any, "order"_a = any, "deadlocks"_a = any,
           "locks"_a = any, "unlock"_a = any, "searching"_a = 0, "queue"_a = 0, "seed"_a = 1,
           "threads"_a = py::none(), "statistics"_a = false)
      .def_property_readonly("dim", &Mesh::dim)
      .def_property_readonly("threads", &Mesh::threads)
      .def_property_readonly("points", [](const Mesh& mesh) { return mesh.points().array; })
      .def_property_readonly("statistics", [](const Mesh& mesh) { return mesh.statistics(); })
      .def_property_readonly("distinct",
                             [](const Mesh& mesh) { return mesh.triangulation().distinct; })
      .def_property_readonly("hash",
                             [](const Mesh& mesh) {
                               const py::gil_scoped_release unlocked;
                               return to_string(hash(mesh.triangulation()));
                             })
      .def_property_readonly("simplices", &simplices)
      .def_property_readonly("neighbors", &neighbors)
      .def_property_readonly("simplex_at", &simplex_at)
      .def("hull_facets",
           [](const Mesh& mesh) {
             std::vector<std::uint32_t> facets = hull_facets(mesh.triangulation());
             const py::ssize_t count = signed_size(facets.size()) / mesh.dim();
             return taken_as_signed(std::move(facets), {count, mesh.dim()});
           })
      .def("hull_vertices",
           [](const Mesh& mesh) {
             std::vector<std::uint32_t> rows = hull_vertices(mesh.triangulation());
             const py::ssize_t count = signed_size(rows.size());
             return taken_as_signed(std::move(rows), {count});
           })
      .def("locate", &Mesh::locate, "xi"_a)
      .def("nearest", &Mesh::nearest, "xi"_a)
      .def("interpolate", &Mesh::interpolate, "values"_a, "xi"_a, "natural"_a, "outside"_a)
      .def("vertex_neighbours", &Mesh::vertex_neighbours)
      .def("voronoi", &Mesh::voronoi)
      .def("quality", &Mesh::quality);
}

}  // namespace delray::python
