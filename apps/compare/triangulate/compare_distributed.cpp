// Runs every distributed method on the simulated machine, once for each network: real code in its
// own time (comm/charged.h), so that what ranks wait for is what they would wait for there.
//
// Methods whose ranks wait much take long to simulate. Where a run took longer than a limit, or the
// areas of all ranks would not fit the memory, more ranks of the method are left out, which the
// page says.
#include "apps/compare/triangulate/compare_distributed.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <random>

#include "comm/charged.h"
#include "comm/collectives.h"
#include "comm/simulated.h"
#include "delaunay/simplify_terrain.h"
#include "files/find_named.h"
#include "files/memory_budget.h"
#include "parallel/arena.h"
#include "parallel/processor_time.h"

namespace delray::apps {
namespace {

constexpr double kLongestRun = 30, kLongestQuickRun = 5;  // seconds of processor time
constexpr std::size_t kFiberStack = std::size_t{8} << 20;

struct SimulatedTriangulation {
  DistributedRun run;
  double seconds = 0;  // of the last rank
};

SimulatedTriangulation simulate_method(const delaunay::PointCloud& points,
                                       const delaunay::DistributedOptions& options, int ranks,
                                       const comm::Network& network) {
  SimulatedTriangulation result;
  comm::SimulationOptions simulation;
  simulation.stack_bytes = kFiberStack;
  parallel::Arena(1).execute([&] {
    comm::run_simulated(
        ranks, network, 1,
        [&](comm::Communicator& communicator) {
          const std::vector<delaunay::RowPoint> mine = own_rows(communicator, points);
          comm::barrier(communicator);
          const double begin = communicator.seconds();
          delaunay::DistributedTriangulation made;
          {
            comm::Charged charged(communicator);
            made = delaunay::triangulate_distributed(charged, mine, options);
            charged.mark(comm::Phase::other, 0);  // what was done since the last message
          }
          result.seconds = std::max(result.seconds, communicator.seconds() - begin);
          DistributedRun run = gather_run(communicator, made, /*with_vertices=*/false);
          if (communicator.rank() == 0) result.run = std::move(run);
        },
        simulation);
  });
  return result;
}

// Whether the ranks of a method, which share this process's memory, may have all areas at a time.
bool fits_memory(std::string_view method, int ranks) {
  if (!files::find_named(delaunay::distributed_methods(), method)->cuts_areas) return true;
  constexpr std::uint64_t kBytesPerArea = 1024;  // planes, boxes, extreme points, on their way too
  const auto areas = static_cast<std::uint64_t>(ranks);
  return areas * areas * kBytesPerArea <= files::MemoryBudget().left();
}

class DistributedRuns {
 public:
  DistributedRuns(const TriangulateRequest& request, const delaunay::PointCloud& points, int dim,
                  parallel::Progress& progress)
      : request_(request), points_(points), steps_(progress) {
    result_.dim = dim;
    result_.points = points.size();
    result_.ranks = request.ranks;
    options_.triangulate.dim = dim;
    options_.triangulate.seed = request.seed;
    options_.triangulate.statistics = true;
    for (const std::string_view name : delaunay::distributed_methods_for(dim)) {
      if (request.distributed.empty() ||
          std::ranges::find(request.distributed, name) != request.distributed.end())
        methods_.emplace_back(name);
    }
  }

  DistributedComparison run() {
    result_.networks = request_.networks;
    const std::vector<std::size_t> sizes = compared_sizes(points_.size());
    steps_.start(methods_.size() * (sizes.size() - 1 + request_.ranks.size()));
    try {
      for (const std::string& method : methods_) compare(method, sizes);
    } catch (const parallel::Interrupted&) {
      if (result_.rows.empty()) throw;
      result_.unfinished = true;
    }
    return std::move(result_);
  }

 private:
  void compare(const std::string& method, const std::vector<std::size_t>& sizes) {
    spdlog::info("{}", method);
    options_.method = method;
    // Fewer points by a few ranks only, to show how what is shared grows.
    for (const std::size_t size : sizes) {
      if (size < points_.size()) add_row(random_part(size), two_areas(method), 1);
    }
    const double longest = request_.quick ? kLongestQuickRun : kLongestRun;
    double last = 0;
    for (const int ranks : request_.ranks) {
      if (last > longest || !fits_memory(method, ranks)) {
        result_.left_out.push_back(fmt::format("{}, {} ranks", method, ranks));
        steps_.done();
        continue;
      }
      const std::int64_t begin = parallel::processor_nanoseconds();
      add_row(points_, ranks, result_.networks.size());
      last = static_cast<double>(parallel::processor_nanoseconds() - begin) * 1e-9;
    }
  }

  delaunay::PointCloud random_part(std::size_t size) const {
    std::vector<std::uint32_t> rows(points_.size());
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<std::uint32_t>(i);
    std::mt19937_64 random(request_.seed);
    for (std::size_t i = rows.size(); i > 1; --i) std::swap(rows[i - 1], rows[random() % i]);
    rows.resize(size);
    std::ranges::sort(rows);
    return select_rows(points_, rows);
  }

  void add_row(const delaunay::PointCloud& points, int ranks, std::size_t networks) {
    ComparedDistributedMethod row;
    row.method = options_.method;
    row.ranks = ranks;
    row.points = points.size();
    for (std::size_t i = 0; i < networks; ++i) {
      steps_.stop_if_asked();
      const comm::NamedNetwork& network = result_.networks[i];
      const SimulatedTriangulation made = simulate_method(points, options_, ranks, network.network);
      row.predicted.push_back({network.name, made.seconds});
      if (i > 0) continue;
      row.simplices = made.run.made.simplices;
      row.hash = to_string(made.run.made.hash);
      row.rounds = made.run.made.rounds;
      row.sum = sum_of(made.run.ranks);
      for (const delaunay::DistributedStatistics& rank : made.run.ranks) {
        row.bytes_sent_max = std::max(row.bytes_sent_max, rank.bytes);
      }
    }
    result_.rows.push_back(std::move(row));
    steps_.done();
  }

  const TriangulateRequest& request_;
  const delaunay::PointCloud& points_;
  Steps steps_;
  delaunay::DistributedOptions options_;
  std::vector<std::string> methods_;
  DistributedComparison result_;
};

}  // namespace

int two_areas(std::string_view method) {
  return 2 + files::find_named(delaunay::distributed_methods(), method)->ranks_without_area;
}

DistributedComparison compare_distributed(const TriangulateRequest& request,
                                          const delaunay::PointCloud& points, int dim,
                                          parallel::Progress& progress) {
  return DistributedRuns(request, points, dim, progress).run();
}

}  // namespace delray::apps
