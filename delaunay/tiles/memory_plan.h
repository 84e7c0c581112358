// How much of a triangulation is in memory at a time.
#pragma once

#include <cstdint>
#include <string>

namespace delray::delaunay {

// What is known of the task before points are cut.
struct Task {
  std::uint64_t points = 0;  // of all ranks
  int dim = 2, ranks = 1, threads = 1;
  int tiles = 0;             // that were asked for; 0: none
  std::uint64_t memory = 0;  // that this process may have; 0: no limit
};

struct MemoryPlan {
  bool on_disk = false;
  int tiles = 1;
  int workers = 1;                // tiles at a time
  int threads = 1;                // of each worker
  std::uint64_t tile_points = 0;  // of the largest tile that there is memory for
  std::uint64_t batch_rows = 0;   // points that a thread reads at a time
  std::uint64_t sample = 0;       // points by which space is cut
};

// Bytes that triangulating a point takes at most, besides those that hold it in its tile's file.
std::uint64_t bytes_to_triangulate(int dim);

// Throws FileError (memory) where not even small tiles would fit.
MemoryPlan plan_memory(const Task& task);

// Throws FileError (memory), which tells the numbers, unless there is memory to triangulate so many
// points that tiles could not settle.
void require_memory_for_rest(std::uint64_t points, int dim, std::uint64_t memory);

}  // namespace delray::delaunay
