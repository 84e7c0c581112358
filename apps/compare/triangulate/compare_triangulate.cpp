// Runs every triangulation method on subsets of the points, with several numbers of threads.
//
// Subsets are the first of one random order. Each way runs once to count and to hash its result;
// timed runs count nothing, and all ways take turns until another run would exceed a way's share of
// the time.
//
// Degenerate: a stop keeps what is finished, fewest points first.
#include "apps/compare/triangulate/compare_triangulate.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <thread>
#include <utility>

#include "apps/compare/triangulate/makers_picture.h"
#include "apps/compare/verdict.h"
#include "delaunay/adjacency.h"
#include "delaunay/methods.h"
#include "delaunay/simplify_terrain.h"
#include "parallel/arena.h"

namespace delray::apps {
namespace {

constexpr std::size_t kFewestPoints = 100;  // of a part of them
constexpr int kMostShownThreads = 8;        // their colours can be told apart
constexpr int kPictureSide = 460;           // pixels; two fit beside each other
// The number of times everything is timed: at least, at most, and as long as the repetitions of a
// way to triangulate take no more than its share of so many seconds.
struct Repetitions {
  int least, most;
  double seconds;
};
constexpr Repetitions kUsual = {3, 9, 120}, kQuick = {1, 3, 25};
// A run that is predicted to take longer than `run`, or one that is not quick where all have taken
// as long as `all`, is left out, unless its method was asked for by name.
struct Limits {
  double run, quick, all;  // seconds
};
constexpr Limits kUsualLimits = {60, 5, 3600}, kQuickLimits = {5, 0.5, 130};
// The method whose splits and deadlock strategies are compared, as in the report.
constexpr std::string_view kOfSplits = "optimistic";
// Capacities of queues that are compared, in points, as in the report.
constexpr std::size_t kQueues[] = {16, 256, 4096};
// Above it, slow methods have to be asked for by name.
constexpr std::size_t kMostForSlow = 20'000;  // points
// The report's sequential algorithm.
constexpr std::string_view kSequential = "insertion", kOfSequential = "dag";

// The methods of a dimension that the request names; without names, those that do not take too
// long, and the others told to `left_out`.
std::vector<const delaunay::Method*> compared_methods(const TriangulateRequest& request,
                                                      std::size_t points, int dim,
                                                      std::vector<std::string>& left_out) {
  std::vector<const delaunay::Method*> result;
  for (const delaunay::Method& method : delaunay::methods()) {
    if (std::ranges::find(method.dims, dim) == method.dims.end()) continue;
    if (!request.methods.empty()) {
      if (std::ranges::find(request.methods, method.name) == request.methods.end()) continue;
    } else if (method.slow && points > kMostForSlow) {
      left_out.push_back(fmt::format("{} (slow above {} points)", method.name, kMostForSlow));
      continue;
    }
    result.push_back(&method);
  }
  if (!left_out.empty()) {
    spdlog::info("left out, unless --method names them: {}", fmt::join(left_out, ", "));
  }
  return result;
}

// Numbers of threads that locate points, beside the one that the method chooses by itself.
std::vector<int> searching_threads(const delaunay::Method& method, int threads) {
  std::vector<int> result;
  if (!method.queued || threads < 3) return result;
  for (int searching = 1; searching < threads - 1; searching *= 2) result.push_back(searching);
  result.push_back(threads - 1);
  return result;
}

// Every way to triangulate by these methods that goes with the request.
std::vector<delaunay::Options> ways(const std::vector<const delaunay::Method*>& methods,
                                    const TriangulateRequest& request, int dim,
                                    const std::vector<int>& threads, int shown_threads) {
  std::vector<delaunay::Options> result;
  for (const delaunay::Method* const entry : methods) {
    const delaunay::Method& method = *entry;
    delaunay::Options how;
    how.dim = dim;
    how.method = method.name;
    how.seed = request.seed;
    if (method.alone) {
      result.push_back(resolve(how));
      if (method.name != kSequential) continue;
      how.location = kOfSequential;
      result.push_back(resolve(how));
      continue;
    }
    for (const int count : threads) {
      how.threads = count;
      result.push_back(resolve(how));
    }
    how.threads = shown_threads;
    for (const std::size_t queue : kQueues) {
      if (!method.queued || shown_threads < 2) break;
      how.queue = queue;
      result.push_back(resolve(how));
    }
    how.queue = 0;
    for (const int searching : searching_threads(method, shown_threads)) {
      how.searching = searching;
      result.push_back(resolve(how));
    }
    how.searching = 0;
    for (std::size_t i = 1; i < method.locks.size(); ++i) {
      how.locks = method.locks[i];
      result.push_back(resolve(how));
    }
    how.locks = "auto";
    for (std::size_t i = 1; i < method.unlocks.size(); ++i) {
      how.unlock = method.unlocks[i];
      result.push_back(resolve(how));
    }
    how.unlock = "auto";
    if (method.name != kOfSplits) continue;
    how.deadlocks = method.deadlocks.back();
    result.push_back(resolve(how));
    how.deadlocks = method.deadlocks.front();
    for (std::size_t i = 1; i < method.splits.size(); ++i) {
      how.split = method.splits[i];
      result.push_back(resolve(how));
    }
  }
  return result;
}

// What its method does without being told.
delaunay::Options plain_of(const delaunay::Options& how) {
  delaunay::Options plain;
  plain.dim = how.dim;
  plain.method = how.method;
  return resolve(plain);
}

// The rows in a random order, of which each comparison of fewer points takes the first.
std::vector<std::uint32_t> shuffled_rows(std::size_t points, std::uint64_t seed) {
  std::vector<std::uint32_t> rows(points);
  std::iota(rows.begin(), rows.end(), 0);
  std::mt19937_64 random(seed);
  for (std::size_t i = points; i > 1; --i) std::swap(rows[i - 1], rows[random() % i]);
  return rows;
}

// The time for so many points, if it goes on growing as over the last two rows, at least with their
// number and at most with its cube; as its square after one row alone. `rows` are of fewer points,
// ascending. By the least times, which what else the machine did has in them least.
std::optional<double> predicted_seconds(const std::vector<const ComparedTriangulation*>& rows,
                                        std::size_t points) {
  if (rows.empty()) return std::nullopt;
  const auto log_ratio = [](auto a, auto b) {
    return std::log(static_cast<double>(a) / static_cast<double>(b));
  };
  const ComparedTriangulation& last = *rows.back();
  double exponent = 2;
  if (rows.size() > 1) {
    const ComparedTriangulation& other = *rows[rows.size() - 2];
    exponent = std::clamp(
        log_ratio(last.seconds.least, other.seconds.least) / log_ratio(last.points, other.points),
        1.0, 3.0);
  }
  return last.seconds.least *
         std::pow(static_cast<double>(points) / static_cast<double>(last.points), exponent);
}

class TriangulationRuns {
 public:
  TriangulationRuns(const TriangulateRequest& request, const delaunay::PointCloud& points, int dim,
                    parallel::Progress& progress)
      : request_(request), points_(points), steps_(progress) {
    result_.dim = dim;
    result_.points = points.size();
    result_.cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    result_.threads = request.threads.empty() ? usual_threads(result_.cores) : request.threads;
    result_.shown_threads = result_.threads.front();
    for (const int count : result_.threads)
      if (count <= kMostShownThreads) result_.shown_threads = count;
    ways_ = ways(compared_methods(request, points.size(), dim, result_.left_out), request, dim,
                 result_.threads, result_.shown_threads);
  }

  TriangulateComparison run() {
    const parallel::AllowThreads allowed(result_.threads.back());
    const std::vector<std::size_t> sizes = compared_sizes(points_.size());
    const std::size_t all = std::accumulate(sizes.begin(), sizes.end(), std::size_t{0});
    const Repetitions often = request_.quick ? kQuick : kUsual;
    steps_.start(all * ways_.size() * static_cast<std::size_t>(1 + often.most));
    const std::vector<std::uint32_t> order = shuffled_rows(points_.size(), request_.seed);
    try {
      // Fewest points first: what is finished when somebody cannot wait tells of every method.
      for (const std::size_t size : sizes) {
        spdlog::info("{} points", size);
        std::vector<std::uint32_t> rows(order.begin(),
                                        order.begin() + static_cast<std::ptrdiff_t>(size));
        std::sort(rows.begin(), rows.end());
        const double share =
            static_cast<double>(size) / static_cast<double>(std::max<std::size_t>(all, 1));
        compare(size == points_.size() ? points_ : select_rows(points_, rows), often,
                share * often.seconds);
      }
    } catch (const parallel::Interrupted&) {
      if (result_.rows.empty()) throw;
      result_.unfinished = true;
    }
    return std::move(result_);
  }

 private:
  // Counts and times every way, then times all of them again and again: what the machine does
  // meanwhile meets them all alike.
  void compare(const delaunay::PointCloud& points, const Repetitions& often, double seconds) {
    const double share = seconds / static_cast<double>(ways_.size());
    std::vector<std::vector<double>> times(ways_.size());
    std::vector<std::size_t> row_of(ways_.size());
    for (int round = 0; round < often.most; ++round) {
      for (std::size_t i = 0; i < ways_.size(); ++i) {
        std::vector<double>& own = times[i];
        if (round == 0 && leaves_out(i, points.size())) {
          own.push_back(std::numeric_limits<double>::infinity());
          steps_.done(points.size());
        }
        const double spent = std::accumulate(own.begin(), own.end(), 0.0);
        const bool is_over = round >= often.least && spent + spent / round > share;
        if (is_over || std::isinf(spent)) {
          steps_.done(points.size());
          continue;
        }
        std::optional<ComparedTriangulation> row;
        if (round == 0) row = count(points, ways_[i]);
        own.push_back(time(points, ways_[i]));
        if (row) {
          row_of[i] = result_.rows.size();
          result_.rows.push_back(std::move(*row));
        }
        result_.rows[row_of[i]].seconds = spread_of(own);
      }
    }
  }

  // Whether another run would take too long, by those of fewer points; what is left out is told.
  bool leaves_out(std::size_t way, std::size_t points) {
    if (!request_.methods.empty()) return false;
    const Limits& limits = request_.quick ? kQuickLimits : kUsualLimits;
    const std::string name = fmt::format("{}, {} threads", name_of(ways_[way]), ways_[way].threads);
    std::vector<const ComparedTriangulation*> before;
    for (const ComparedTriangulation& row : result_.rows) {
      if (row.how.threads == ways_[way].threads && name_of(row.how) == name_of(ways_[way]))
        before.push_back(&row);
    }
    const std::optional<double> seconds = predicted_seconds(before, points);
    if (!seconds) return false;
    constexpr double kRuns = 2;  // at least: one counts, one is timed
    const bool is_late = *seconds > limits.quick && spent_ + kRuns * *seconds > limits.all;
    if (*seconds <= limits.run && !is_late) return false;
    result_.left_out.push_back(
        fmt::format("{} ({} points: {:.0f} s predicted)", name, points, *seconds));
    spdlog::info("left out, unless --method names it: {}", result_.left_out.back());
    return true;
  }

  delaunay::Result triangulate(const delaunay::PointCloud& points, delaunay::Options how) {
    steps_.stop_if_asked();
    how.progress = steps_.inside();
    return parallel::Arena(how.threads).execute([&] {
      return delaunay::triangulate(delaunay::view(points.positions), how);
    });
  }

  double time(const delaunay::PointCloud& points, const delaunay::Options& how) {
    Stopwatch watch;
    const delaunay::Result result = triangulate(points, how);
    const double seconds = watch.lap();
    spent_ += seconds;
    steps_.done(points.size());
    return seconds;
  }

  ComparedTriangulation count(const delaunay::PointCloud& points, const delaunay::Options& how) {
    ComparedTriangulation row;
    row.how = how;
    row.points = points.size();
    delaunay::Options counting = how;
    counting.statistics = true;
    counting.created_by = true;
    Stopwatch watch;
    const auto [made, statistics, makers] = triangulate(points, counting);
    spent_ += watch.lap();
    row.statistics = statistics;
    row.distinct = made.distinct;
    row.simplices = made.size();
    row.hull_facets = made.hull_facets;
    row.hash = to_string(hash(made));
    row.simplices_by_thread.resize(static_cast<std::size_t>(how.threads));
    for (const std::uint16_t maker : makers) ++row.simplices_by_thread[maker];
    row.fragments = count_fragments(made, makers, points.size());
    if (!request_.output.empty() && how.threads == result_.shown_threads && how.threads > 1 &&
        is_plain_but_for_makers(how))
      show(points, made, makers, row);
    steps_.done(points.size());
    return row;
  }

  // In place of the picture of fewer points.
  void show(const delaunay::PointCloud& points, const delaunay::Triangulation& made,
            const std::vector<std::uint16_t>& makers, const ComparedTriangulation& row) {
    PictureOfMakers shown{name_of(row.how), points.size(), row.fragments,
                          makers_picture(points, made, makers, kPictureSide)};
    const auto before = std::ranges::find(result_.pictures, shown.name, &PictureOfMakers::name);
    if (before != result_.pictures.end())
      *before = std::move(shown);
    else
      result_.pictures.push_back(std::move(shown));
  }

  const TriangulateRequest& request_;
  const delaunay::PointCloud& points_;
  Steps steps_;
  std::vector<delaunay::Options> ways_;
  double spent_ = 0;  // seconds in all runs
  TriangulateComparison result_;
};

}  // namespace

std::vector<int> usual_threads(int cores) {
  std::set<int> result = {cores};
  for (int count = 1; count <= 8 && count <= cores; count *= 2) result.insert(count);
  if (cores < 8) result.insert(2 * cores);
  return {result.begin(), result.end()};
}

std::vector<std::size_t> compared_sizes(std::size_t points) {
  std::vector<std::size_t> result;
  for (const std::size_t part : {8, 4, 2})
    if (points / part >= kFewestPoints) result.push_back(points / part);
  result.push_back(points);
  return result;
}

std::string name_of(const delaunay::Options& how) {
  const delaunay::Options plain = plain_of(how);
  std::string name = how.method;
  if (how.location != plain.location) name += ", " + how.location;
  if (how.split != plain.split) name += ", " + how.split;
  if (how.deadlocks != plain.deadlocks) name += ", " + how.deadlocks;
  if (how.locks != plain.locks) name += ", " + how.locks;
  if (how.unlock != plain.unlock) name += ", " + how.unlock;
  if (how.searching != plain.searching) name += fmt::format(", {} searching", how.searching);
  if (how.queue != plain.queue) name += fmt::format(", queue of {}", how.queue);
  return name;
}

bool is_plain_but_for_makers(const delaunay::Options& how) {
  const delaunay::Options plain = plain_of(how);
  return how.locks == plain.locks && how.unlock == plain.unlock && how.queue == plain.queue &&
         how.searching == plain.searching;
}

bool is_plain(const delaunay::Options& how) {
  const delaunay::Options plain = plain_of(how);
  return how.split == plain.split && how.deadlocks == plain.deadlocks &&
         is_plain_but_for_makers(how);
}

double speed_up(const std::vector<ComparedTriangulation>& rows, const ComparedTriangulation& row) {
  for (const ComparedTriangulation& other : rows) {
    // Alone it makes no difference which points are whose.
    if (other.points == row.points && other.how.threads == 1 &&
        other.how.method == row.how.method && other.how.location == row.how.location)
      return row.seconds.median > 0 ? other.seconds.median / row.seconds.median : 0;
  }
  return 0;
}

std::vector<const ComparedTriangulation*> fastest(const std::vector<ComparedTriangulation>& rows,
                                                  std::size_t points, int threads) {
  std::vector<const ComparedTriangulation*> wanted;
  for (const ComparedTriangulation& row : rows) {
    if (row.points == points && (threads == 0 || row.how.threads == threads))
      wanted.push_back(&row);
  }
  return winners<ComparedTriangulation>(
      wanted, [](const ComparedTriangulation& row) { return row.seconds; });
}

TriangulateComparison compare_triangulate(const TriangulateRequest& request,
                                          const delaunay::PointCloud& points, int dim,
                                          parallel::Progress& progress) {
  return TriangulationRuns(request, points, dim, progress).run();
}

}  // namespace delray::apps
