// delray compare triangulate --ranks: the distributed methods on points of the user's own, counted
// and predicted for several numbers of ranks.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "apps/compare/triangulate/compare_triangulate.h"
#include "apps/triangulate_distributed.h"
#include "delaunay/points.h"

namespace delray::apps {

struct PredictedTriangulation {
  std::string network;
  double seconds = 0;  // from points on their ranks to simplices on theirs
};

// A method by so many ranks, on so many of the points. Counts are those of the run over the first
// network: where ranks wait for each other, what comes first decides them.
struct ComparedDistributedMethod {
  std::string method;
  int ranks = 1;
  std::size_t points = 0;
  std::uint64_t simplices = 0;
  std::string hash;
  int rounds = 0;
  delaunay::DistributedStatistics sum;  // of all ranks
  std::uint64_t bytes_sent_max = 0;     // of one rank
  std::vector<PredictedTriangulation> predicted;
};

struct DistributedComparison {
  int dim = 2;
  std::size_t points = 0;
  std::vector<int> ranks;

  std::vector<ComparedDistributedMethod> rows;  // by method, then points, then ranks
  std::vector<std::string> left_out;            // "method, ranks": too slow or large
  std::vector<comm::NamedNetwork> networks;     // of predictions; counts are of the first
  bool unfinished = false;                      // told to stop before the end
};

// So many ranks of a method have two areas: by them rows with fewer points are counted.
int two_areas(std::string_view method);

// As compare_triangulate(). Every rank has a core of its own, on this thread, one after the other.
DistributedComparison compare_distributed(const TriangulateRequest& request,
                                          const delaunay::PointCloud& points, int dim,
                                          parallel::Progress& progress);

}  // namespace delray::apps
