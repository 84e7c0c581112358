// Look-ups among the rows by linear search, and words that the page uses again and again.
#include "apps/compare/triangulate/triangulate_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "apps/report/series.h"
#include "delaunay/methods.h"

namespace delray::apps {

using Row = ComparedTriangulation;
using Rows = ComparedTriangulations;

std::vector<std::size_t> sizes_of(const Rows& rows) {
  return report::unique_of(rows, [](const Row& row) { return row.points; });
}

std::size_t most_points(const Rows& rows) {
  const auto count = [&](std::size_t points) {
    return std::ranges::count(rows, points, &Row::points);
  };
  std::size_t most = rows.front().points;
  for (const std::size_t points : sizes_of(rows))
    if (4 * count(points) >= 3 * count(rows.front().points)) most = points;
  return most;
}
Rows rows_of(const Rows& rows, const std::function<bool(const Row&)>& wanted) {
  Rows result;
  std::ranges::copy_if(rows, std::back_inserter(result), wanted);
  return result;
}

const Row* base_of(const Rows& rows, const Row& row) {
  const auto at = std::ranges::find_if(rows, [&](const Row& other) {
    return other.points == row.points && other.how.threads == 1 &&
           other.how.method == row.how.method && other.how.location == row.how.location;
  });
  return at == rows.end() ? nullptr : &*at;
}

bool is_alone(const Row& row) {
  return std::ranges::find(delaunay::methods(), row.how.method, &delaunay::Method::name)->alone;
}

std::string threads_text(int count) {
  return fmt::format("{} {}", count, count == 1 ? "thread" : "threads");
}
const char* simplices_text(int dim) { return dim == 2 ? "triangles" : "tetrahedra"; }

std::string crowded_text(const TriangulateComparison& comparison) {
  if (comparison.threads.back() <= comparison.cores) return "";
  return fmt::format(
      " This machine runs {} at once: more share the cores, and tell what the locks "
      "do rather than how fast it goes.",
      threads_text(comparison.cores));
}

}  // namespace delray::apps
