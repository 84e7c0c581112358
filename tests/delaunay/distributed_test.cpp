#include "delaunay/distributed.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include "comm/simulated.h"
#include "comm/threads.h"
#include "delaunay/generate.h"
#include "delaunay/triangulate.h"
#include "files/find_named.h"
#include "parallel/progress.h"
#include "tests/delaunay/hard_points.h"
#include "tests/delaunay/hard_points_3d.h"
#include "tests/delaunay/summed_parts.h"

namespace delray::delaunay {
namespace {

using Run = std::function<void(int ranks, const std::function<void(comm::Communicator&)>&)>;

struct AllParts : tests::SummedParts {
  DistributedStatistics statistics;
};

void on_threads(int ranks, const std::function<void(comm::Communicator&)>& body) {
  comm::run_threads(ranks, 1, body);
}
// Messages arrive in any order that MPI allows, another one for each seed.
Run in_any_order(std::uint64_t seed) {
  return [seed](int ranks, const std::function<void(comm::Communicator&)>& body) {
    comm::run_simulated(ranks, comm::any_order(), seed, body);
  };
}

void add(const DistributedTriangulation& made, AllParts& all) {
  all.add(made.part);
  all.statistics.messages += made.statistics.messages;
  all.statistics.bytes += made.statistics.bytes;
  all.statistics.waits += made.statistics.waits;
  all.statistics.shared_simplices += made.statistics.shared_simplices;
}

AllParts triangulate_on(int ranks, const std::vector<glm::dvec3>& positions,
                        const DistributedOptions& options, const Run& run, bool runs = true) {
  AllParts all;
  std::mutex mutex;
  const std::vector<RowPoint> points = tests::with_rows(positions);
  run(ranks, [&](comm::Communicator& communicator) {
    const DistributedTriangulation made = triangulate_distributed(
        communicator, tests::points_of_rank(points, communicator.rank(), ranks, runs), options);
    const std::lock_guard lock(mutex);
    add(made, all);
  });
  return all;
}

void expect_as_in_core(const std::vector<glm::dvec3>& positions, int dim, const AllParts& got) {
  Options in_core;
  in_core.dim = dim;
  const Triangulation expected = triangulate(view(positions), in_core).triangulation;
  tests::expect_equal(got, expected);
}

template <class F>
void for_each_method(const F& f) {
  for (const int dim : {2, 3}) {
    for (const std::string_view name : distributed_methods_for(dim)) {
      DistributedOptions options;
      options.method = name;
      options.triangulate.dim = dim;
      SCOPED_TRACE(std::string(name) + ", " + std::to_string(dim) + "D");
      f(options);
    }
  }
}

std::vector<glm::dvec3> hard_set(int dim, std::size_t set, std::size_t n, std::uint64_t seed) {
  if (dim == 3) return hard_points_3d().at(set).make(n, seed);
  std::vector<glm::dvec3> points;
  for (const glm::dvec2& p : hard_points().at(set).make(n, seed)) points.emplace_back(p, 0.0);
  return points;
}
std::string name_of_hard_set(int dim, std::size_t set) {
  return dim == 3 ? hard_points_3d().at(set).name : hard_points().at(set).name;
}

TEST(Distributed, MethodsGiveTheTriangulationOfAllPoints) {
  for_each_method([](const DistributedOptions& options) {
    const int dim = options.triangulate.dim;
    std::uint64_t seed = 0;
    for (const PointGenerator& kind : point_generators()) {
      const auto positions = kind.generate(dim == 2 ? 150 : 60, dim, 3).positions;
      // With another kind, other numbers of ranks.
      for (int i = 0; i < 3; ++i) {
        const int ranks = 1 + static_cast<int>(seed++ % 9);
        SCOPED_TRACE(std::string(kind.name) + ", " + std::to_string(ranks) + " ranks, seed " +
                     std::to_string(seed));
        expect_as_in_core(
            positions, dim,
            triangulate_on(ranks, positions, options, in_any_order(seed), seed % 2 == 0));
      }
    }
  });
}

TEST(Distributed, MethodsWorkOnThreads) {
  for_each_method([](const DistributedOptions& options) {
    const int dim = options.triangulate.dim;
    for (const char* kind : {"uniform", "cluster"}) {
      const auto positions = generate_points(kind, dim == 2 ? 300 : 100, dim, 5).positions;
      for (const int ranks : {2, 5}) {
        SCOPED_TRACE(std::string(kind) + ", " + std::to_string(ranks) + " ranks");
        expect_as_in_core(positions, dim, triangulate_on(ranks, positions, options, on_threads));
      }
    }
  });
}

// The interface asks for rings of simplices, and workers walk for it: one by one there were some 3
// to 4 waits for each of the points.
TEST(Distributed, InterfaceWaitsForManySimplicesAtATime) {
  const auto positions = generate_points("uniform", 300, 2, 1).positions;
  DistributedOptions options;
  options.method = "interface-workers";
  options.triangulate.dim = 2;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const AllParts made = triangulate_on(3, positions, options, in_any_order(seed));
    expect_as_in_core(positions, 2, made);
    EXPECT_LE(made.statistics.waits, 500U) << "seed " << seed;
  }
}

TEST(Distributed, MethodsTakeHardPointsInAnyOrderOfArrival) {
  for_each_method([](const DistributedOptions& options) {
    const int dim = options.triangulate.dim;
    const std::size_t sets = dim == 2 ? hard_points().size() : hard_points_3d().size();
    for (std::size_t set = 0; set < sets; ++set) {
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const auto positions = hard_set(dim, set, 20 + 15 * seed, seed);
        const int ranks = static_cast<int>(1 + (set * 3 + seed * 5) % 9);
        SCOPED_TRACE(name_of_hard_set(dim, set) + ", " + std::to_string(ranks) + " ranks, seed " +
                     std::to_string(seed));
        expect_as_in_core(positions, dim,
                          triangulate_on(ranks, positions, options, in_any_order(seed), false));
      }
    }
  });
}

TEST(Distributed, MethodsTakeFewPoints) {
  const std::vector<glm::dvec3> positions = {{0, 0, 0}, {1, 0, 0},   {0, 1, 0}, {0, 0, 1},
                                             {1, 1, 1}, {2, 0.5, 3}, {0, 0, 0}, {-1, -2, 0.5}};
  for_each_method([&](const DistributedOptions& options) {
    for (std::size_t n = 0; n <= positions.size(); ++n) {
      const std::vector<glm::dvec3> some(positions.begin(),
                                         positions.begin() + static_cast<std::ptrdiff_t>(n));
      for (const int ranks : {1, 3, 9}) {
        SCOPED_TRACE(std::to_string(n) + " points, " + std::to_string(ranks) + " ranks");
        expect_as_in_core(some, options.triangulate.dim,
                          triangulate_on(ranks, some, options, on_threads));
      }
    }
  });
}

// Of equal points, wherever they begin, the lowest row represents.
TEST(Distributed, MethodsLetTheLowestRowRepresent) {
  for_each_method([](const DistributedOptions& options) {
    auto positions = generate_points("uniform", 60, options.triangulate.dim, 1).positions;
    const auto copies = positions;
    positions.insert(positions.begin(), copies.rbegin(), copies.rend());
    expect_as_in_core(positions, options.triangulate.dim,
                      triangulate_on(4, positions, options, on_threads));
  });
}

// After every insertion all of the triangulation so far is there, and rows that come late represent
// equal points if they are lower.
TEST(Distributed, PointsMayArriveOnLine) {
  for_each_method([](const DistributedOptions& options) {
    const bool on_line =
        files::find_named(distributed_methods(), options.method)->on_line != nullptr;
    if (!on_line) return;
    const int dim = options.triangulate.dim;
    // Lattices have many equal points; the first batches are too few for a simplex, or flat.
    const auto lattice = hard_set(dim, dim == 2 ? 7 : 8, 90, 11);
    const std::uint64_t last_row = lattice.size() - 1;
    for (const int ranks : {1, 4, 7}) {
      const std::vector<std::size_t> ends = ranks == 4
                                                ? std::vector<std::size_t>{0, 1, 2, 5, 40, 41, 90}
                                                : std::vector<std::size_t>{0, 40, 41, 70, 90};
      SCOPED_TRACE(std::to_string(ranks) + " ranks");
      std::vector<AllParts> stages(ends.size());
      comm::run_simulated(ranks, comm::any_order(), 5, [&](comm::Communicator& communicator) {
        const auto triangulation = make_online_triangulation(communicator, options);
        std::size_t begin = 0;
        for (std::size_t stage = 0; stage < ends.size(); ++stage) {
          std::vector<RowPoint> mine;
          for (std::size_t i = begin; i < ends[stage]; ++i) {
            if (static_cast<int>(i) % ranks == communicator.rank())
              mine.push_back({lattice[i], last_row - i});
          }
          begin = ends[stage];
          triangulation->insert(mine);
          add(triangulation->extract(), stages[stage]);
        }
      });
      for (std::size_t stage = 0; stage < ends.size(); ++stage) {
        SCOPED_TRACE(std::to_string(ends[stage]) + " points");
        // Reversed, so that rows ascend as those that were given.
        const std::vector<glm::dvec3> so_far(
            lattice.rend() - static_cast<std::ptrdiff_t>(ends[stage]), lattice.rend());
        Options in_core;
        in_core.dim = dim;
        const Triangulation expected = triangulate(view(so_far), in_core).triangulation;
        std::vector<std::uint64_t> rows;
        for (const std::uint32_t vertex : expected.vertices)
          rows.push_back(lattice.size() - ends[stage] + vertex);
        EXPECT_EQ(to_string(stages[stage].hash), to_string(hash(dim, rows)));
        EXPECT_EQ(stages[stage].distinct, expected.distinct);
        EXPECT_EQ(stages[stage].hull_facets, expected.hull_facets);
      }
    }
  });
}

// Figure 8.3: along the cut through n uniform points there are about sqrt(n) of them, and about
// twice as many triangles.
TEST(Distributed, SharedSimplicesGrowAsTheSquareRootOfThePoints) {
  DistributedOptions options;
  options.triangulate.statistics = true;
  for (const std::string_view name : distributed_methods_for(2)) {
    options.method = name;
    std::vector<double> per_root;
    const int ranks =
        2 + files::find_named(distributed_methods(), name)->ranks_without_area;  // two areas
    for (const std::size_t n : {500U, 2000U}) {
      const auto points = generate_points("uniform", n, 2, 2).positions;
      const AllParts all = triangulate_on(ranks, points, options, in_any_order(n));
      per_root.push_back(static_cast<double>(all.statistics.shared_simplices) /
                         std::sqrt(static_cast<double>(n)));
    }
    EXPECT_GT(per_root[0], 1) << name;
    EXPECT_LT(per_root[0], 8) << name;
    EXPECT_NEAR(per_root[1] / per_root[0], 1, 0.35) << name;
  }
}

// Ranks that fail end the run with their reason.
TEST(Distributed, FailuresEndAllRanks) {
  for_each_method([](DistributedOptions options) {
    const auto points = generate_points("uniform", 200, options.triangulate.dim, 1).positions;
    parallel::Progress progress;
    progress.request_stop();
    options.triangulate.progress = &progress;
    EXPECT_THROW(triangulate_on(4, points, options, on_threads), parallel::Interrupted);
  });
}

TEST(Distributed, RefusesWhatCannotBe) {
  comm::run_threads(2, 1, [&](comm::Communicator& communicator) {
    const std::vector<RowPoint> points = {{{0, 0, 0}, 7}, {{1, std::nan(""), 0}, 8}};
    const auto complaint = [&](std::span<const RowPoint> given, const DistributedOptions& options) {
      try {
        triangulate_distributed(communicator, given, options);
      } catch (const std::invalid_argument& error) {
        return std::string(error.what());
      }
      return std::string();
    };
    const std::span<const RowPoint> given = points;
    // Only one of the ranks has it; both say so.
    EXPECT_NE(complaint(communicator.rank() == 0 ? given : given.first(0), {}).find("row 8"),
              std::string::npos);
    EXPECT_NE(complaint({}, {"tile"}).find("methods: tiles, "), std::string::npos);
    DistributedOptions in_space{"chen"};
    in_space.triangulate.dim = 3;
    EXPECT_NE(complaint({}, in_space).find("\"chen\" in 3D"), std::string::npos);
    EXPECT_THROW(make_online_triangulation(communicator, {"tiles"}), std::invalid_argument);
    EXPECT_NE(complaint({}, {"tiles", "no"}).find("'no' is no partition"), std::string::npos);
  });
}

}  // namespace
}  // namespace delray::delaunay
