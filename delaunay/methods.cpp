// The table of triangulation methods with the locations, splits, orders, deadlock strategies and
// kinds of locks that go with each, and the rules by which "auto" is resolved: the first method
// that serves the dimension, and the first entry of each of its lists.
#include "delaunay/methods.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include "delaunay/cavity/cavity_insertion.h"
#include "delaunay/cavity/chrisochoides.h"
#include "delaunay/cavity/spielman.h"
#include "delaunay/construction/bowyer_watson.h"
#include "delaunay/construction/dewall.h"
#include "delaunay/construction/gift_wrapping.h"
#include "delaunay/construction/incode.h"
#include "delaunay/construction/quickhull.h"
#include "delaunay/construction/sweep.h"
#include "delaunay/construction/teng.h"
#include "delaunay/divide_and_conquer/divide.h"
#include "delaunay/history/batch.h"
#include "delaunay/history/burglary.h"
#include "delaunay/history/circumcircle.h"
#include "delaunay/history/insertion.h"
#include "delaunay/history/optimistic.h"
#include "delaunay/history/pessimistic.h"
#include "delaunay/mesh/arguments.h"
#include "files/similar_name.h"

namespace delray::delaunay {
namespace {

constexpr std::string_view kAuto = "auto", kNone = "none";

std::string list(std::span<const std::string_view> names) {
  std::string text;
  for (const std::string_view name : names) {
    text += (text.empty() ? "" : ", ") + std::string(name);
  }
  return text;
}

std::string did_you_mean(std::string_view name, std::span<const std::string_view> names) {
  return files::did_you_mean(name, std::vector<std::string>(names.begin(), names.end()));
}

bool serves(const Method& method, int dim) {
  return std::ranges::find(method.dims, dim) != method.dims.end();
}

const Method& choose_method(const Options& options) {
  std::vector<std::string_view> legal;
  for (const Method& method : methods()) {
    if (!serves(method, options.dim)) continue;
    if (options.method == kAuto || options.method == method.name) return method;
    legal.push_back(method.name);
  }
  throw std::invalid_argument(
      "there is no method \"" + options.method + "\" in " + std::to_string(options.dim) +
      "D; methods: " + (legal.empty() ? "none yet" : "auto, " + list(legal)) +
      did_you_mean(options.method, legal));
}

std::string choose(const char* what, const std::string& wanted,
                   std::span<const std::string_view> legal, std::string_view method) {
  if (wanted == kAuto) return std::string(legal.empty() ? kNone : legal.front());
  if (legal.empty() && wanted == kNone) return wanted;
  if (std::ranges::find(legal, wanted) != legal.end()) return wanted;
  const std::string name(method);
  if (legal.empty()) {
    throw std::invalid_argument("method \"" + name + "\" leaves no choice of " + what);
  }
  throw std::invalid_argument("method \"" + name + "\" has no " + what + " \"" + wanted +
                              "\"; it has: " + list(legal) + did_you_mean(wanted, legal));
}

}  // namespace

// The first method of a dimension is what "auto" means there.
std::span<const Method> methods() {
  static const std::vector<std::string_view> all_splits = {"random", "slabs", "distance", "curve"};
  // Threads that keep to places of their own seldom conflict.
  static const std::vector<std::string_view> curve_first = {"curve", "random", "slabs", "distance"};
  static const std::vector<std::string_view> simplex_locks = {"atomic", "mutex", "striped"};
  static const std::vector<Method> table = {
      {.name = "divide-and-conquer",
       .description = "triangulates the points on either side of a line and merges the halves; the "
                      "fastest in 2D",
       .group = "parts",
       .dims = {2},
       .seeded = false,
       .triangulate = internal::divide_and_conquer,
       .mesh_2d = internal::divide_and_conquer_mesh},
      {.name = "cavity",
       .description = "inserts random rounds of points along a curve, each into the cavity of "
                      "simplices that it replaces; the fastest in 3D",
       .group = "parts",
       .dims = {3},
       .triangulate = internal::insert_by_cavities,
       .mesh_3d = internal::mesh_by_cavities},
      {.name = "insertion",
       .description =
           "inserts one point after the other and restores the Delaunay property by flips",
       .group = "one thread",
       .dims = {2, 3},
       .locations = {"walk", "hierarchy", "dag"},
       .orders = {"brio", "hilbert", "random"},
       .alone = true,
       .triangulate = internal::insert_all},
      {.name = "batch",
       .description = "threads locate points, and one thread inserts them from a queue",
       .group = "one inserts",
       .dims = {2},
       .locations = {"dag"},
       .splits = all_splits,
       .orders = {"brio", "random"},
       .queued = true,
       .triangulate = internal::insert_in_batches},
      {.name = "pessimistic",
       .description =
           "threads locate points together, and insert them one at a time in a critical section",
       .group = "one inserts",
       .dims = {2, 3},
       .locations = {"dag"},
       .splits = all_splits,
       .orders = {"brio", "random"},
       .locks = {"mutex", "atomic"},
       .triangulate = internal::insert_pessimistically},
      {.name = "optimistic",
       .description =
           "threads lock the simplices that they need, and roll back insertions that cannot go on",
       .group = "locks",
       .dims = {2, 3},
       .locations = {"walk", "dag"},
       .splits = curve_first,
       .orders = {"brio", "random"},
       .deadlocks = {"detection", "priorities"},
       .locks = simplex_locks,
       .unlocks = {"end", "early"},
       .triangulate = internal::insert_optimistically},
      {.name = "burglary",
       .description = "as optimistic, but instead of rolling back a thread uses what a waiting "
                      "thread has locked",
       .group = "locks",
       .dims = {2, 3},
       .locations = {"walk", "dag"},
       .splits = curve_first,
       .orders = {"brio", "random"},
       .locks = simplex_locks,
       .unlocks = {"end", "early"},
       .triangulate = internal::insert_by_burglary},
      {.name = "circumcircle",
       .description =
           "threads wait for simplices whose circumcircles contain another thread's point",
       .group = "locks",
       .dims = {2},
       .locations = {"dag"},
       .splits = all_splits,
       .orders = {"brio", "random"},
       .triangulate = internal::insert_by_circles},
      {.name = "dewall",
       .description =
           "makes the simplices that a plane crosses, then those on its two sides, which "
           "planes divide in turn",
       .group = "parts",
       .dims = {2, 3},
       .seeded = false,
       .slow = true,
       .triangulate = internal::dewall},
      {.name = "spielman",
       .description = "inserts, in rounds and without locks, points whose cavities share nothing",
       .group = "rounds",
       .dims = {2, 3},
       .slow = true,
       .triangulate = internal::insert_independent_sets},
      {.name = "chrisochoides",
       .description = "threads insert the points of their regions of the mesh, and lock other "
                      "regions that a cavity reaches into",
       .group = "locks",
       .dims = {2, 3},
       .triangulate = internal::insert_in_regions},
      {.name = "incode",
       .description = "threads make all simplices with a corner in their areas; those that several "
                      "have made are dropped at the end",
       .group = "parts",
       .dims = {2, 3},
       .seeded = false,
       .slow = true,
       .triangulate = internal::incode},
      {.name = "teng",
       .description = "makes the simplices on all open facets at once, in rounds, after which "
                      "threads tell each other what they have made",
       .group = "rounds",
       .dims = {2, 3},
       .seeded = false,
       .slow = true,
       .triangulate = internal::teng},
      {.name = "guibas-stolfi",
       .description = "divide and conquer by vertical lines alone, as published first",
       .group = "parts",
       .dims = {2},
       .seeded = false,
       .triangulate = internal::guibas_stolfi},
      {.name = "bowyer-watson",
       .description =
           "inserts one point after the other into the hole of the triangles that it removes",
       .group = "one thread",
       .dims = {2},
       .orders = {"brio", "hilbert", "random"},
       .alone = true,
       .triangulate = internal::insert_by_holes},
      {.name = "gift-wrapping",
       .description = "makes one simplex after the other, each on a facet of those that are there",
       .group = "one thread",
       .dims = {2, 3},
       .alone = true,
       .seeded = false,
       .slow = true,
       .triangulate = internal::wrap_gifts},
      {.name = "quickhull",
       .description =
           "the lower hull of the points lifted onto a paraboloid, each facet's farthest "
           "point first",
       .group = "one thread",
       .dims = {2, 3},
       .alone = true,
       .seeded = false,
       .slow = true,
       .triangulate = internal::lower_hull_of_lifted},
      {.name = "sweep",
       .description = "sweeps a line over the points and keeps the arcs nearest to each below it",
       .group = "one thread",
       .dims = {2},
       .alone = true,
       .seeded = false,
       .triangulate = internal::sweep},
  };
  return table;
}

std::span<const Choice> locations() {
  static constexpr std::array<Choice, 3> table = {{
      {"dag",
       "down the history of the triangulation, a directed acyclic graph; slow for points along a "
       "curve, which make it deep"},
      {"hierarchy", "walks through coarser triangulations first; in 2D only"},
      {"walk", "from the last simplex towards the point, by edges in random order"},
  }};
  return table;
}

std::span<const Choice> splits() {
  static constexpr std::array<Choice, 4> table = {{
      {"random", "any points to any thread"},
      {"slabs", "strips by x"},
      {"distance", "rings by the distance from the origin"},
      {"curve", "intervals of a Hilbert curve"},
  }};
  return table;
}

std::span<const Choice> deadlock_strategies() {
  static constexpr std::array<Choice, 2> table = {{
      {"detection", "a thread whose waiting would close a cycle rolls back its insertion"},
      {"priorities",
       "a thread waits only for threads of lower priority, or else rolls back its insertion"},
  }};
  return table;
}

std::span<const Choice> lock_kinds() {
  static constexpr std::array<Choice, 3> table = {{
      {"atomic", "atomic instructions; a thread that waits yields"},
      {"mutex",
       "one mutex of the operating system: the critical section of the pessimistic method, and "
       "what the locks of all simplices are set under"},
      {"striped", "1024 such mutexes, among which the locks of simplices are divided"},
  }};
  return table;
}

std::span<const Choice> unlock_times() {
  static constexpr std::array<Choice, 2> table = {{
      {"end", "all simplices when the point is inserted"},
      {"early", "neighbours of the new simplices as soon as they are known to stay"},
  }};
  return table;
}

std::vector<std::string_view> locations_for(const Method& method, int dim) {
  std::vector<std::string_view> result = method.locations;
  if (dim != 2) std::erase(result, "hierarchy");
  return result;
}

std::vector<std::string_view> orders_for(const Method& method, std::string_view location) {
  std::vector<std::string_view> result = method.orders;
  if (location == "dag") std::erase(result, "hilbert");
  return result;
}

std::span<const Choice> orders() {
  static constexpr std::array<Choice, 3> table = {{
      {"brio", "random rounds of doubling size, each along a Hilbert curve"},
      {"hilbert", "along a Hilbert curve"},
      {"random", "in random order"},
  }};
  return table;
}

Options resolve(const Options& options) {
  internal::check_dim(options.dim);
  if (options.threads < 1 || options.threads > kMostThreads) {
    throw std::invalid_argument("threads: from 1 to " + std::to_string(kMostThreads) + ", not " +
                                std::to_string(options.threads));
  }
  const Method& method = choose_method(options);
  Options result = options;
  result.method = method.name;
  result.location =
      choose("location", options.location, locations_for(method, options.dim), method.name);
  result.split = choose("split", options.split, method.splits, method.name);
  result.order = choose("order", options.order, orders_for(method, result.location), method.name);
  result.deadlocks = choose("deadlock strategy", options.deadlocks, method.deadlocks, method.name);
  result.locks = choose("locks", options.locks, method.locks, method.name);
  result.unlock = choose("time of unlocking", options.unlock, method.unlocks, method.name);
  if (options.searching < 0 ||
      (method.queued && options.searching > std::max(options.threads - 1, 0))) {
    throw std::invalid_argument("searching: " + std::to_string(options.searching) +
                                " threads locate points and one inserts them, of " +
                                std::to_string(options.threads) + " threads");
  }
  return result;
}

const Method& method_of(const Options& resolved) {
  return *std::ranges::find(methods(), resolved.method, &Method::name);
}

}  // namespace delray::delaunay
