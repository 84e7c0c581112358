// Delaunay triangulations of points in memory.
#pragma once

#include <cstdint>
#include <string>

#include "delaunay/points.h"
#include "delaunay/triangulation.h"
#include "parallel/progress.h"

namespace delray::delaunay {

// Seconds of the phases, summed over threads; a phase that a method does not have stays 0.
struct Statistics {
  double order = 0;      // sorting the points
  double locate = 0;     // finding the simplex that a point falls into
  double subdivide = 0;  // making simplices
  double legalize = 0;   // flips
  double extract = 0;    // from the mesh to the result
};

// Names are those of the tables in methods.h; "auto" stands for the best that goes with the others.
struct Options {
  int dim = 2;
  std::string method = "auto";
  std::string location = "auto";
  std::string split = "auto";
  std::string order = "auto";
  std::uint64_t seed = 1;            // of everything that is random
  int threads = 1;                   // at most
  Statistics* statistics = nullptr;  // filled in if not null
  parallel::Progress* progress =
      nullptr;  // started with the number of points and advanced, if not null
};

// The triangulation that the perturbed lifting of conflict.h defines: whatever the options are, the
// same set of simplices. Reads the first `dim` coordinates of each point; -0 equals 0. No simplices
// if all points are equal or collinear, or there are none.
//
// Errors: std::invalid_argument for a coordinate that is not finite (names the row), for options
// that do not go together (names those that do), for more than 2^29 points; parallel::Interrupted;
// std::bad_alloc.
Triangulation triangulate(PointView<double> points, const Options& options = {});

}  // namespace delray::delaunay
