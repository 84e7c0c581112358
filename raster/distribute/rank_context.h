// The context of a strategy on one rank: the scene, the frame, memory, and what it counts.
#pragma once

#include <memory>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "comm/communicator.h"
#include "composite/shown_blocks.h"
#include "loadbalance/schedule.h"
#include "raster/distribute/regions.h"
#include "raster/render.h"
#include "raster/strategies.h"
#include "scenes/scene_part.h"

namespace delray::raster {

struct FrameMemory;
class PackedScene;

// A scene with what is made of it once for all frames.
struct PreparedScene {
  // Without a shader one is made.
  PreparedScene(const scenes::Scene& scene, std::shared_ptr<const shading::Shader> shader);
  // Of a part, where other ranks have the rest. Collective.
  PreparedScene(comm::Communicator& communicator, const scenes::ScenePart& part,
                std::shared_ptr<const shading::Shader> shader);

  const shading::Shader& shader() const { return *shader_of_scene; }

  const scenes::Scene& scene;
  std::shared_ptr<const shading::Shader> shader_of_scene;
  std::vector<std::uint64_t> first_primitives;  // scenes::first_primitives(scene), of the part
  std::uint64_t primitives;                     // of all of the scene
  bool is_part = false;
  bool transparent;  // some mesh of the scene is blended
  SceneClusters clusters;
  PackedScene* packed = nullptr;  // of a scene whose triangles are in a pack
};

// A frame on one rank.
struct RankContext {
  comm::Communicator& communicator;
  PreparedScene& prepared;
  const Screen& screen;  // in samples
  const RenderOptions& options;
  parallel::Progress* progress;
  Scratch& scratch;
  FrameMemory& memory;
  RegionCounts counts = {};
  std::uint64_t triangles_travelled = 0, fragments_travelled = 0;
  loadbalance::ScheduleCounts schedule = {};  // of a schedule that ran
  PackCounts pack = {};
  // Which rank the owner k of the screen's partition is; empty: rank k.
  std::vector<int> rank_of_owner = {};
  // In steps, of which only the last may use the communicator: work is reported then.
  bool in_steps = false;
  // Whether ranks may see different things at the same pixel.
  bool composites = true;
  // The rank that gets what is composited, a frame or a display of it.
  int root = 0;
  std::vector<Picture> shown = {};  // of this rank's displays, in their order

  int number() const { return communicator.rank(); }
  int ranks() const { return communicator.size(); }

  // The primitives that this rank has before anything travels: its part of a scene in parts, else
  // an equal part of all, in order.
  std::pair<std::uint64_t, std::uint64_t> own_primitives() const { return own_primitives(ranks()); }
  // The primitives that this rank has if the first `holders` ranks have them all. REQUIRES: these
  // are all ranks where the scene is in parts.
  std::pair<std::uint64_t, std::uint64_t> own_primitives(int holders) const;
  // Whether depths are distances at once, since none are compared between ranks.
  bool depths_are_distances() const { return ranks() == 1 || !composites; }
  geometry::Rect frame() const { return {0, 0, options.width, options.height}; }
  int samples_per_pixel() const { return options.supersampling * options.supersampling; }

  void report_work(const RegionCounts& done) const;
  // Adds it to the counts and, unless in steps, reports it.
  void count(const RegionCounts& done);

  // A drawing of `list`, or of what it is given later, into regions (in pixels).
  RegionDrawing begin(const DrawList& list, std::span<const geometry::Rect> regions);
  // Finishes and counts it; `finish_tile` as in RegionDrawing, in samples.
  void end(RegionDrawing& drawing, FinishTile finish_tile);
  // As RegionDrawing::finish_rows, and counts; work is reported before rows_finished is called.
  void end_rows(RegionDrawing& drawing, int first, int rows, FinishTile finish_tile,
                parallel::FunctionRef<void(int begin, int end)> rows_finished);
  // As end, into an image of the frame: pixels, with samples averaged.
  template <class Colour>
  void end_pixels(RegionDrawing& drawing, image::BasicImage<Colour>& image);

  // Renders `list` into regions (in pixels) and counts; `finish_tile` as in RegionDrawing, in
  // samples.
  void render(const DrawList& list, std::span<const geometry::Rect> regions, FinishTile finish);
  // As render, into an image of the frame: pixels, with samples averaged.
  template <class Colour>
  void render_pixels(const DrawList& list, std::span<const geometry::Rect> regions,
                     image::BasicImage<Colour>& image);
  // Ends a drawing of the whole frame with the samples of a pixel together: see samples.h.
  template <class Colour>
  image::BasicImage<Colour> end_samples(RegionDrawing& drawing);
  // As end_pixels, into an image of a part of the frame, of whole tiles, outside of which nothing
  // is drawn. REQUIRES: one sample per pixel.
  template <class Colour>
  image::BasicImage<Colour> end_part(RegionDrawing& drawing, const geometry::Rect& part);
  // The picture of the frame that shows no more than such a part, whose memory the next frame gets.
  template <class Colour>
  image::BasicImage<Colour> picture_around(const geometry::Rect& part,
                                           image::BasicImage<Colour>&& image);
  // The picture on rank 0, of every region from its owner's image, which has distances instead of
  // depths; of size 0 elsewhere. Of displays their pictures, in `shown`. Collective.
  template <class Colour>
  Picture gather(const loadbalance::Partition& partition, image::BasicImage<Colour>&& image);
  // An image of any content; the spare one if that fits. Scratch::shown is of it.
  template <class Colour>
  image::BasicImage<Colour> take_image(int width, int height);
};

// An image of the frame, one sample per pixel, into which tiles are stored. What was left clear in
// the same memory by the frame before is not cleared again.
template <class Colour>
class ImageOfTiles {
 public:
  explicit ImageOfTiles(RankContext& rank);

  // To be called for each tile once; several threads may.
  void store(std::span<const geometry::Rect> rects, TileView& tile);

  image::BasicImage<Colour>& image() { return image_; }
  // After all tiles. Scratch::shown is of it.
  image::BasicImage<Colour> take();

 private:
  RankContext& rank_;
  image::BasicImage<Colour> image_;
  composite::ShownBlocks shown_;
};

// Parts of regions in a tile, rects in samples, into a window of pixels: n x n samples averaged.
template <class Colour>
void store_pixels(std::span<const geometry::Rect> rects, TileView& tile, int n,
                  const Window<Colour>& window);

// Parts of regions in a tile, rects in samples, into an image of the frame with the samples of a
// pixel together.
template <class Colour>
void store_samples(std::span<const geometry::Rect> rects, TileView& tile, int n,
                   image::BasicImage<Colour>& image);

// Runs f and adds the seconds that it took on this rank, waiting for others included.
template <class F>
auto timed(const comm::Communicator& communicator, double& seconds, F&& f) {
  const double begin = communicator.seconds();
  auto result = f();
  seconds += communicator.seconds() - begin;
  return result;
}

Picture sort_first(RankContext& rank);
// With options.schedule.
Picture sort_first_scheduled(RankContext& rank);
Picture sort_middle(RankContext& rank);
Picture sort_last(RankContext& rank);
// Finishes a drawing of the whole frame and composites it meanwhile, by the scheme `tiles`: a tile
// goes to its owner as soon as it is finished here. The part is in samples. Collective.
//
// REQUIRES: nothing is transparent; pixels are shaded before they are composited.
template <class Colour>
composite::OwnedPixels hand_over_tiles(RankContext& rank, RegionDrawing& drawing);
std::unique_ptr<FrameSteps> sort_last_steps(RankContext& rank);
// The part that sort_last composites, of a rank that need not have others. REQUIRES: one sample per
// pixel.
PartialImage sort_last_share(RankContext& rank);
Picture hybrid(RankContext& rank);

}  // namespace delray::raster
