// Pictures by ray tracing over ranks and threads, whether every rank has the whole scene or each a
// part of it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "comm/communicator.h"
#include "geometry/rect.h"
#include "image/image.h"
#include "loadbalance/partition.h"
#include "loadbalance/schedule.h"
#include "parallel/progress.h"
#include "raytrace/distribution.h"
#include "raytrace/integrator.h"
#include "raytrace/tracer.h"
#include "scenes/camera.h"

namespace delray::raytrace {

// What tiles are taken to cost, by the last frame: the rays that were sent for them, which is the
// same whoever traced them, or the processor time that they took.
enum class CostSource : std::uint8_t { rays, seconds };

// Where the hits of camera rays come from: rays, or rasterization, which gives the same bytes:
// samples of which that is not certain are traced. raster: all are traced where rasterizing is
// expected to take longer. raster_always: nowhere, as tests want it.
enum class Primary : std::uint8_t { trace, raster, raster_always };

// The part of a picture that a call renders; all of it unless told otherwise.
struct Part {
  geometry::Rect window;  // of the frame, its sides on multiples of kTaskSide or on the frame's;
                          // empty: the frame
  int first_sample = 0;
  int samples = 0;  // from the first on; 0: all others
  // One for each square of kTaskSide pixels of the window, row by row; only those with 1 are
  // rendered. Empty: all.
  std::span<const std::uint8_t> squares;
  // One for each pixel of the frame, row by row: primary rays go through those with 1 alone, and
  // others get any colour. The same on every rank. Empty: all.
  std::span<const std::uint8_t> pixels;
};

// The size and quality of a frame, and how it is shared out.
struct RenderOptions {
  int width = 1280, height = 720;
  int samples = 1;  // per pixel; 1: in its centre
  TraceOptions trace;
  bool scattered = false;  // FrameContext::scattered
  std::string integrator = "whitted";
  Part part;
  Primary primary = Primary::trace;  // over a scene that is shared out: traced
  // Of loadbalance::schedules(): tiles are handed out to ranks and threads.
  std::string schedule = "interlaced";
  bool master_works = true;  // whether ranks that hand out tiles trace some themselves
  // Who shows which part of the window (loadbalance/wall.h): every rank gets the pixels of the
  // displays that it owns, and rank 0 no picture. Disjoint, of frames without Part::squares. Empty:
  // all of it goes to rank 0.
  std::vector<loadbalance::Region> displays;
  // Pixels, the side of a tile; 0: Integrator::side. The smaller the more evenly work is shared
  // out; there is more to hand out and to collect then, and tasks are no larger than tiles. Packets
  // of 4 x 4 pixels are traced whole: of those that reach beyond a tile it keeps its own pixels
  // (RayCounts::surplus), so that a side that is a multiple of 4 wastes nothing.
  int tile = 0;
  // Of loadbalance::partitioners(), over what the tiles cost in the last frame of a Renderer: with
  // the schedules that begin with shares (static and both kinds of stealing) a rank begins with the
  // tiles of its region. Empty: with as many consecutive ones.
  std::string partition;
  CostSource costs = CostSource::rays;
  int regions_per_rank = 1;
  // A partition is kept from frame to frame for as long as no rank would have to do more than so
  // many times an equal share.
  double keep_factor = 1.1;
  BuildOptions build;                      // where a tracer is made
  parallel::Progress* progress = nullptr;  // steps are tiles
};

// Of one rank and frame, counted but for the times.
struct RankCounts {
  double busy = 0.0;  // seconds of processor time that its threads spent on tiles
  double idle = 0.0;  // seconds that they waited for tiles
  std::uint64_t tasks = 0;
  RayCounts rays;
  std::uint64_t bytes_sent = 0, bytes_received = 0, messages = 0;  // messages: sent
  // Of the schedule. `rays_stolen`: of tiles that other ranks had begun.
  std::uint64_t requests = 0, steals = 0, tasks_stolen = 0, rays_stolen = 0;
  // Of a scene that is shared out: rays sent to other ranks and answers sent back; rays against
  // clusters; clusters that came from another rank, with their bytes, and that were dropped again
  // or moved to a neighbour for good. Of any scene: the most bytes of geometry and acceleration
  // structures at any time (ranks that are threads may have those of a whole scene in common).
  std::uint64_t rays_sent = 0, answers_sent = 0, tests = 0, clusters_fetched = 0,
                clusters_fetched_bytes = 0, clusters_dropped = 0, clusters_moved = 0,
                geometry_bytes = 0;
  // Of a scene that is shared out: clusters that the rank owns, and bytes of the upper part of the
  // hierarchy, which every rank has.
  std::uint64_t clusters = 0, tree_bytes = 0;
};

// One rank's work for a frame.
struct RankStatistics : RankCounts {
  std::vector<loadbalance::Interval> timeline;  // by thread, then time, on the rank's clock

  void operator+=(RankStatistics&& more);
};

// The partition that rank 0 has cut the frame into.
struct PartitionStatistics {
  double predicted = 1;   // imbalance that the last frame's costs foretell
  bool measured = false;  // whether there was a last frame; equal costs otherwise
  bool kept = false;      // from the last frame
};

// The cost of a frame, and the work that was done.
struct Statistics {
  double build_seconds = 0.0, frame_seconds = 0.0;
  double trace_seconds = 0.0, gather_seconds = 0.0;  // of rank 0; shading is part of trace
  RayCounts rays;                                    // of all ranks
  double imbalance_rays = 1;          // max over mean of the rays that ranks sent; 1 without any
  std::uint64_t degenerate = 0;       // triangles that can never be hit
  std::uint64_t structure_bytes = 0;  // of the acceleration structure
  std::optional<PartitionStatistics> partition;
  std::vector<RankStatistics> ranks;
  std::string embree_version, embree_isa;
  std::string why_traced;  // with Primary::raster, if rank 0 rasterized nothing

  // Of several renderings by the same ranks: times and counts are summed, the rest is the last's.
  void operator+=(Statistics&& more);
};

// The cost of a tile, whichever rank traced it.
struct TileCost {
  std::uint32_t tile = 0;
  std::uint32_t pixels = 0;  // that were rendered; 0: none of its squares were
  std::uint64_t rays = 0;
  double seconds = 0;
};

// On rank 0; other ranks get an empty image and no ranks' statistics.
struct Result {
  image::ImageF image;  // of the window: linear, premultiplied, the mean of the part's samples;
                        // depth along the view axis; of size 0 where there are displays
  std::vector<image::ImageF> shown;  // on any rank, of its displays, in their order
  Statistics statistics;
  std::vector<TileCost> tile_costs;  // in no particular order; tiles are cut from the window
};

// Pixels: RenderOptions::tile where it is set. Throws as integrator().
int tile_side(const RenderOptions& options);

// How so many tiles are handed out to ranks with so many threads, but for the shares that they
// begin with.
loadbalance::ScheduleOptions tile_schedule(std::uint32_t tiles, int ranks, int threads);

// Bytes that a ray of a tile in progress takes to another rank, about, and what it finds to its
// own.
inline constexpr std::uint64_t kMovedRayBytes = 110, kMovedResultBytes = 20;

// Renders frames of one scene, each with shares of tiles by what they cost in the one before. One
// per rank.
class Renderer {
 public:
  // Refers to the tracer, which several ranks may share.
  explicit Renderer(const Tracer& tracer);
  // Refers to this rank's part of a scene that is shared out. Once clusters have gone round by
  // `ring` no other distribution finds them. Throws std::invalid_argument where rays are pooled and
  // no rank has all clusters (share_options). REQUIRES: !distribution.replicated.
  Renderer(SharedScene& scene, const Distribution& distribution);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  // Collective. Same bytes for every schedule, partition, size of tiles, distribution and number of
  // ranks and
  // threads (and the same Embree instruction set). Works in as many threads as the caller's arena
  // has; with no width or height the image is empty. Of several samples colours are averaged and
  // the least depth is kept. Throws std::invalid_argument for names that are in no table and for
  // displays that nobody owns or that reach beyond the window; parallel::Interrupted when the
  // progress is told to stop.
  //
  // REQUIRES: samples >= 1, depth >= 0, regions_per_rank >= 1, keep_factor >= 1; the same scene,
  // camera and options on every rank.
  Result render(comm::Communicator& communicator, const scenes::Camera& camera,
                const RenderOptions& options);
  // The next picture of the same size is made in the memory of this one.
  void recycle(image::ImageF&& picture);

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

// One frame.
Result render(comm::Communicator& communicator, const Tracer& tracer, const scenes::Camera& camera,
              const RenderOptions& options);

// Makes the tracer first, which every rank does for itself.
Result render(comm::Communicator& communicator, const scenes::Scene& scene,
              const scenes::Camera& camera, const RenderOptions& options);

}  // namespace delray::raytrace
