// Progress and interruption, for every method of every dimension.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "delaunay/combinations.h"
#include "delaunay/generate.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay {
namespace {

TEST(Interruption, EveryMethodCountsItsPointsAndStopsWhenAsked) {
  for (const int dim : {2, 3}) {
    auto points = generate_points("uniform", dim == 2 ? 2000 : 400, dim, 2).positions;
    points.insert(points.end(), points.begin(), points.begin() + 200);
    points.emplace_back(1e12, 1e12, 1e12);  // leaves the others one cell, with a grid of its own
    for (Options options : locations_and_orders(dim)) {
      for (const int threads : {1, 2}) {
        SCOPED_TRACE(name_of(options) + ", " + std::to_string(dim) + "D, threads " +
                     std::to_string(threads));
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
