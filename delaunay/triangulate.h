// Delaunay triangulations of points in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "delaunay/points.h"
#include "delaunay/triangulation.h"
#include "parallel/progress.h"

namespace delray::delaunay {

// Flips by how many simplices they replace by how many. In the plane all are of 2 by 2; in space
// those of 2 by 2 are of a flat side of the hull.
struct FlipCounts {
  std::uint64_t two_two = 0, two_three = 0, three_two = 0, four_four = 0;

  std::uint64_t sum() const { return two_two + two_three + three_two + four_four; }
  bool operator==(const FlipCounts&) const = default;
};

// Lists that threads keep while they insert a point, one for each insertion, that which is undone
// included.
struct ListLengths {
  std::uint64_t lists = 0, entries = 0, longest = 0;
};

// Counts of how threads of the methods with locks met, summed over threads. 0 where a
// method does not have it.
struct Synchronization {
  std::uint64_t lock_calls = 0;      // each for all simplices that the next step needs
  std::uint64_t already_locked = 0;  // simplices that the thread held when it asked for them
  std::uint64_t free = 0;            // simplices that were locked at once
  std::uint64_t waits = 0;           // simplices, or critical sections, that another thread held
  std::uint64_t unlocked_early = 0;  // simplices that were unlocked before their insertion ended
  std::uint64_t deadlocks = 0;       // found, or (strategy priorities) feared
  std::uint64_t rollbacks = 0;       // insertions that were undone and tried again
  std::uint64_t burglaries = 0;      // of simplices of a waiting thread
  std::uint64_t repaired = 0;        // simplices that the repair at the end replaced
  std::uint64_t rebuilds = 0;        // repairs that had to start from the points
  std::uint64_t fragments = 0;       // connected sets of simplices made by one thread
  std::uint64_t mutex_locks = 0;     // mutexes of the operating system that were locked
  std::uint64_t mutex_waits = 0;     // of these, how many another thread held
  std::uint64_t mutex_bytes = 0;     // memory of all mutexes of the run
  ListLengths journals;              // links that an undone insertion would restore
  ListLengths lock_lists;            // simplices that a thread held at the end, new ones among them
};

// The threads of the batch method that located points, from so many insertions on.
struct SearchingThreads {
  std::uint64_t inserted = 0;
  int threads = 0;

  bool operator==(const SearchingThreads&) const = default;
};

// Seconds of the phases, summed over threads; a phase that a method does not have stays 0.
struct Statistics {
  double order = 0;                  // sorting the points
  double locate = 0;                 // finding the simplex that a point falls into
  double subdivide = 0;              // making simplices
  double legalize = 0;               // flips
  double extract = 0;                // from the mesh to the result
  FlipCounts flips;                  // of methods that flip; those that were undone included
  std::uint64_t dag_nodes = 0;       // simplices that ever were, if the method keeps them
  std::uint64_t dag_node_bytes = 0;  // of each of them, with its share of what few have
  Synchronization synchronization;
  std::vector<SearchingThreads> searching;  // ascending; where the method has such threads
};

inline constexpr int kMostThreads = 4096;

// Names are those of the tables in methods.h; "auto" stands for the best that goes with the others.
struct Options {
  int dim = 2;
  std::string method = "auto";
  std::string location = "auto";
  std::string split = "auto";
  std::string order = "auto";
  std::string deadlocks = "auto";  // what a thread does that must not wait
  std::string locks = "auto";      // what a thread locks by
  std::string unlock = "auto";     // when a thread unlocks
  int searching = 0;               // threads of the batch method that locate; 0: as times tell
  std::size_t queue = 0;           // places in the queue of the batch method; 0: as in the report
  std::uint64_t seed = 1;          // of everything that is random
  int threads = 1;                 // at most; from 1 to kMostThreads
  bool statistics = false;         // whether to count, and to time each phase of each point
  bool created_by = false;         // whether to note the threads that make simplices
  parallel::Progress* progress =
      nullptr;  // started with the number of points and advanced, if not null
};

// The result of triangulate().
struct Result {
  Triangulation triangulation;
  Statistics statistics;  // zeros without Options::statistics
  // With Options::created_by, for simplex i the number of the thread that made it, below `threads`;
  // empty without.
  std::vector<std::uint16_t> created_by;
};

// The triangulation that the perturbed lifting of conflict.h defines: whatever the options are, the
// same set of simplices. Reads the first `dim` coordinates of each point; -0 equals 0. No simplices
// if all points are equal or collinear, or there are none.
//
// Errors: std::invalid_argument for a coordinate that is not finite (names the row), for options
// that do not go together (names those that do) or cannot be, for a view without memory or whose
// points have too few coordinates, for more than 2^29 points; parallel::Interrupted;
// std::bad_alloc.
Result triangulate(PointView<double> points, const Options& options = {});

// Triangulates floats, each as the double that equals it: 8 * dim bytes a point more.
Result triangulate(PointView<float> points, const Options& options = {});

}  // namespace delray::delaunay
