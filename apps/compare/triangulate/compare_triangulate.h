// delray compare triangulate: every triangulation method on points of the user's own, with several
// numbers of threads and of points.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/compare/comparison.h"
#include "apps/compare/spread.h"
#include "apps/input/point_input.h"
#include "apps/options/network_option.h"
#include "delaunay/points.h"
#include "delaunay/triangulate.h"
#include "image/image.h"

namespace delray::apps {

struct TriangulateRequest : ComparisonOptions {
  NetworkChoice network;
  std::vector<comm::NamedNetwork> networks;  // chosen, where ranks are compared
  PointInput input;
  int dim = 0;                           // 0: as the input is
  std::vector<std::string> methods;      // empty: all of the dimension
  std::vector<int> threads;              // ascending; empty: see usual_threads()
  std::vector<int> ranks;                // ascending; with any, distributed methods are compared
  std::vector<std::string> distributed;  // those; empty: all of the dimension
  std::uint64_t seed = 1;                // of the random subsets and of the methods
  bool each = false;                     // each of the inputs is compared by itself
};

// 1, 2, 4 and 8 as far as there are cores, the cores, and with fewer than 8 of them twice as many.
std::vector<int> usual_threads(int cores);

// A half, a quarter and an eighth of so many points, where that is a hundred or more, and all;
// ascending.
std::vector<std::size_t> compared_sizes(std::size_t points);

// A way to triangulate on so many of the points.
struct ComparedTriangulation {
  delaunay::Options how;  // resolved, without its pointers
  std::size_t points = 0;
  std::uint64_t distinct = 0, simplices = 0, hull_facets = 0;
  // Statistics of one run: counts, and the phases' seconds summed over threads.
  delaunay::Statistics statistics;
  std::vector<std::uint64_t> simplices_by_thread;
  std::uint64_t fragments = 0;  // of every method, counted in the result
  std::string hash;
  Spread seconds;  // of runs that count nothing
};

// A picture of the simplices by thread, in the plane, or in space where a plane cuts it.
struct PictureOfMakers {
  std::string name;  // that of the way to triangulate
  std::size_t points = 0;
  std::uint64_t fragments = 0;
  image::Image8 picture;
};

struct TriangulateComparison {
  int dim = 2;
  std::size_t points = 0;
  std::vector<int> threads;
  int cores = 1;                            // hardware threads
  int shown_threads = 1;                    // of the pictures, and where splits are compared
  std::vector<ComparedTriangulation> rows;  // by points, then as in the table of methods
  std::vector<PictureOfMakers> pictures;    // of most points, if a page is asked for
  std::vector<std::string> left_out;        // ways that would have taken too long, with why
  bool unfinished = false;                  // told to stop before the end
};

// The method, and what is not its default: "optimistic, slabs".
std::string name_of(const delaunay::Options& how);
// Whether split, queue, searching threads, deadlock strategy and locks are those that the method
// takes without being told.
bool is_plain(const delaunay::Options& how);
// Whether all but split and deadlock strategy are: what else there is decides about time alone, not
// about who makes which simplices.
bool is_plain_but_for_makers(const delaunay::Options& how);

// Its time with one thread over its time; 0 where that was not measured.
double speed_up(const std::vector<ComparedTriangulation>& rows, const ComparedTriangulation& row);

// With so many points and threads (0: any number), the row that took least and those that cannot be
// told from it (winners() in verdict.h); empty if there is none.
std::vector<const ComparedTriangulation*> fastest(const std::vector<ComparedTriangulation>& rows,
                                                  std::size_t points, int threads);

// Compares. Told to stop, gives what is finished; throws parallel::Interrupted where nothing is,
// and what triangulate() throws. `points` as load_points() gives them for this dimension.
TriangulateComparison compare_triangulate(const TriangulateRequest& request,
                                          const delaunay::PointCloud& points, int dim,
                                          parallel::Progress& progress);

}  // namespace delray::apps
