// A wavefront integrator (Laine et al. 2013): a state machine over the pixels of one task that
// enqueues rays batch by batch and shades them once they are intersected. It serves a scene that
// this rank holds whole as well as scenes distributed over ranks, where rays travel and the task
// waits.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "geometry/rect.h"
#include "raytrace/integrators/primary_rays.h"
#include "raytrace/sampling/light_table.h"
#include "raytrace/sampling/sampler.h"
#include "raytrace/scene/ray_batch.h"
#include "scenes/camera.h"
#include "shading/batch_shader.h"

namespace delray::raytrace {

struct TraceOptions {
  int depth = 8;  // how often light may be mirrored or refracted on its way to the camera
  // How often it may be scattered diffusely, by `path`. Russian roulette ends paths long before.
  int diffuse_depth = 64;
  bool shadows = true;                                   // of integrators that can do without
  float reach = std::numeric_limits<float>::infinity();  // of ambient occlusion, in the world
  std::uint64_t seed = 0;                                // of everything random
  enum class Background : std::uint8_t {
    environment,  // where nothing is hit the environment shows, alpha 1
    transparent,  // where nothing is hit colour and alpha are 0
  } background = Background::environment;
};

// Rays sent. A ray that goes on behind a see-through layer counts again. `surplus` of the primary
// ones were sent because packets are never cut, through pixels that belong to another tile, and of
// `rasterized` ones the hit was found by rasterization (Primary::raster).
struct RayCounts {
  std::uint64_t primary = 0, shadow = 0, secondary = 0, surplus = 0, rasterized = 0;
  RayCounts& operator+=(const RayCounts& b) {
    primary += b.primary;
    shadow += b.shadow;
    secondary += b.secondary;
    surplus += b.surplus;
    rasterized += b.rasterized;
    return *this;
  }
  RayCounts& operator-=(const RayCounts& b) {
    primary -= b.primary;
    shadow -= b.shadow;
    secondary -= b.secondary;
    surplus -= b.surplus;
    rasterized -= b.rasterized;
    return *this;
  }
  std::uint64_t sent() const { return primary + shadow + secondary; }
  bool operator==(const RayCounts&) const = default;
};

// Values that all tasks of a frame share.
struct FrameContext {
  const shading::BatchShader& shader;
  const LightTable& lights;
  scenes::View view;
  TraceOptions options;
  int samples = 1;  // per pixel, in all tasks together
  // Samples lie anywhere in their pixels, whatever the integrator: the first few of them are spread
  // out as evenly as all are.
  bool scattered = false;
  // Primary rays of other pixels meet nothing.
  geometry::Rect filled = {0, 0, std::numeric_limits<int>::max(), std::numeric_limits<int>::max()};
  std::span<const std::uint8_t> traced = {};  // Part::pixels
};

// Pixels are walked through in squares of this side, cut from the frame's left upper corner on
// however large tiles are: rays of so many stay in the cache between tracing and shading.
inline constexpr int kTaskSide = 16;

// Samples [first_sample, first_sample + samples) of every pixel of a rectangle, whose left and
// upper sides are on multiples of kBlockSide; blocks that its other sides cut are filled in part.
// How pixels and samples are cut into tasks changes no pixel.
struct Task {
  geometry::Rect pixels;
  int first_sample = 0, samples = 1;

  int columns() const { return (pixels.width() + kBlockSide - 1) / kBlockSide; }  // of blocks
  int rows() const { return (pixels.height() + kBlockSide - 1) / kBlockSide; }
  int blocks() const { return columns() * rows(); }
};

// One sample of each pixel of a block; lanes outside the task hold anything.
struct SampleBlock {
  shading::Vectors16 colour;  // linear, premultiplied
  shading::Floats16 alpha;
  shading::Floats16 depth;  // along the view axis, of the first layer that is not fully
                            // transparent; kEmptyDepth where there is none
};

class RayReader;
class RayWriter;

// Keeps its memory from task to task. Nothing in it depends on the task before.
class WavefrontIntegrator {
 public:
  virtual ~WavefrontIntegrator() = default;
  WavefrontIntegrator(const WavefrontIntegrator&) = delete;
  WavefrontIntegrator& operator=(const WavefrontIntegrator&) = delete;

  // Enqueues the primary rays of a task.
  void start(const Task& task);

  // REQUIRES: all of batch() is intersected, and not done.
  void advance();

  // Rays of each block of samples() that wait in batch(). REQUIRES: they are not intersected.
  std::vector<std::uint32_t> waiting();
  // Moves the samples of blocks b with moved[b] != 0, as far as they are, and their rays that wait
  // to the end of a message (waiting_rays.h). These rays no longer count here. REQUIRES: as above.
  void release(std::span<const std::uint8_t> moved, RayWriter& to);
  // In place of start: goes on with what an integrator of the same frame has released. The rays
  // that wait count from now on here. Returns the blocks as they were marked there. Throws
  // comm::BadMessage.
  std::vector<std::uint8_t> resume(const Task& task, RayReader& from);

  bool done() const { return batch_.empty(); }
  RayBatch& batch() { return batch_; }

  // Once done: element s * blocks + b is sample first_sample + s of block b; blocks go row by row.
  std::span<const SampleBlock> samples() const { return samples_; }
  const RayCounts& rays() const { return rays_; }

 protected:
  // Where samples lie in their pixels: at the same places in all of them, or anywhere.
  enum class Positions : std::uint8_t { regular, random };
  explicit WavefrontIntegrator(const FrameContext& context,
                               Positions positions = Positions::regular)
      : context_(context), positions_(positions) {}

  // Prepares for primary rays, which are in next_ already: group g is of samples_[g].
  virtual void begin() = 0;
  // Shades the intersected batch_, adds to samples_ and enqueues into next_, which is empty.
  virtual void shade() = 0;

  // Rays that wait in batch_: counted, moved to a message with their counts, read from one into
  // batch_, where nothing is enqueued (waiting_rays.h).
  virtual void count_waiting(std::span<std::uint32_t> by_block) = 0;
  virtual RayCounts write_waiting(std::span<const std::uint8_t> moved, RayWriter& to) = 0;
  virtual void read_waiting(RayReader& from) = 0;

  // Random numbers of lane `pixel % 16` of samples_[pixel / 16], none of them used before.
  Sampler sampler(std::uint32_t pixel);
  // As sampler, for sixteen lanes, of which those in `lanes` are set.
  void draw(const std::uint32_t* pixels, shading::LaneMask lanes, SampleLanes& samples);

  FrameContext context_;
  Task task_;
  RayBatch batch_, next_;
  std::vector<SampleBlock> samples_;
  RayCounts rays_;

 private:
  void clear_for(const Task& task);
  void enqueue_primary_rays();
  void keep_primaries(RayBatch& batch);
  const PixelKeys& keys(std::uint32_t block);

  Positions positions_;
  // Groups of primary rays, the first so many of which were filled; they are in batch_ until it is
  // shaded.
  RayBatch primaries_;
  std::size_t primaries_filled_ = 0;
  bool has_primaries_ = false;
  PrimarySteps steps_;
  // Keys of the task's blocks, where they were asked for.
  std::vector<PixelKeys> keys_;
  std::vector<bool> has_keys_;
};

}  // namespace delray::raytrace
