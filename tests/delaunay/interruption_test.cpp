// Progress and interruption, for every method of every dimension.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "delaunay/generate.h"
#include "delaunay/methods.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay {
namespace {

// With every location and order that goes with a method.
std::vector<Options> combinations(int dim) {
  using Names = std::vector<std::string_view>;
  const auto or_none = [](const Names& names) { return names.empty() ? Names{"none"} : names; };
  std::vector<Options> result;
  for (const Method& method : methods()) {
    if (std::ranges::find(method.dims, dim) == method.dims.end()) continue;
    for (const auto location : or_none(locations_for(method, dim))) {
      for (const auto order : or_none(orders_for(method, location))) {
        Options options;
        options.dim = dim;
        options.method = method.name;
        options.location = location;
        options.order = order;
        result.push_back(options);
      }
    }
  }
  return result;
}

TEST(Interruption, EveryMethodCountsItsPointsAndStopsWhenAsked) {
  for (const int dim : {2, 3}) {
    auto points = generate_points("uniform", dim == 2 ? 6000 : 1000, dim, 2).positions;
    points.insert(points.end(), points.begin(), points.begin() + 500);
    points.emplace_back(1e12, 1e12, 1e12);  // leaves the others one cell, with a grid of its own
    for (Options options : combinations(dim)) {
      for (const int threads : {1, 2}) {
        SCOPED_TRACE(options.method + ", " + options.location + ", " + options.order + ", " +
                     std::to_string(dim) + "D, threads " + std::to_string(threads));
        parallel::Progress progress;
        options.threads = threads;
        options.progress = &progress;
        triangulate(view(points), options);
        EXPECT_EQ(progress.done(), progress.total());
        EXPECT_EQ(progress.total(), points.size());
        progress.request_stop();
        EXPECT_THROW(triangulate(view(points), options), parallel::Interrupted);
      }
    }
  }
}

}  // namespace
}  // namespace delray::delaunay
