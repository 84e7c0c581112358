// The rasterizer: a scene into a picture over any number of ranks and threads.
//
// The picture is the same, byte for byte, for every strategy, scheme, partition, number of ranks
// and number of threads (but for Blend::by_cell): a pixel shows the primitive with the least
// (depth, primitive number) of those that cover its centre by the top-left rule, at positions
// snapped to 1/256 pixel.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "comm/communicator.h"
#include "composite/deep_image.h"
#include "composite/layer_costs.h"
#include "geometry/rect.h"
#include "image/image.h"
#include "loadbalance/cost_model.h"
#include "loadbalance/partition.h"
#include "packs/pack_reader.h"
#include "packs/page_cache.h"
#include "parallel/progress.h"
#include "scenes/pose.h"
#include "scenes/scene.h"
#include "scenes/scene_part.h"
#include "shading/shader.h"

namespace delray::raster {

// phong: lit at every pixel. gouraud: lit at the vertices with the material's factors,
// interpolated, and multiplied by the base colour texture (Gouraud 1971); other textures are not
// looked at.
enum class Lighting : std::uint8_t { phong, gouraud };

// The content of a message with primitives for another rank: their vertices and indices, as a scene
// that is shared out needs, or its number, which is enough where every rank has the whole scene.
enum class Travel : std::uint8_t { geometry, numbers };

// When a pixel is shaded (Molnar et al. 1992). deferred: once everything that the rank has is
// drawn. immediate: whenever it comes to show another triangle, so that hidden surfaces are shaded
// too. composited: once the ranks' pixels are composited, by the rank that owns it then, so that
// what travels is what shading needs, not colours (sort-last with phong lighting).
enum class Shade : std::uint8_t { deferred, immediate, composited };

// Where transparent surfaces are blended (sort-last). by_owner: all of them travel, and the owner
// of a pixel blends them, once. by_cell: space is cut into a cell for each rank (a kd-tree), every
// rank blends what lies in its own, and what travels are colours, put over each other front to back
// as seen from the camera. That takes a layer's bytes however many surfaces lie behind each other,
// and rounds at every merge, so that the picture depends on scheme and number of ranks: colours in
// float by some 2^-23 for each rank, 8-bit codes by 1 here and there.
enum class Blend : std::uint8_t { by_owner, by_cell };

// The prices of a triangle set up and of a sample shaded, relative to each other, as fitted to what
// a few scenes took (bench/raster/balance.cpp): phong takes longer for a sample.
loadbalance::RasterCostModel cost_model(Lighting lighting);

// How partitions estimate the cost of primitives and pixels. model: prices that are fixed.
// measured: prices fitted to what ranks did and how long it took them in the last frame, regions
// scaled to what they took.
enum class CostSource : std::uint8_t { model, measured };

// Sort-middle: every rank transforms and draws, or some transform and the others draw (Molnar et
// al. 1994).
enum class Groups : std::uint8_t { one, two };
// Sort-middle: triangles are sent once a rank's geometry is all done, or in batches meanwhile,
// which are drawn as they come.
// broadcast: at the end, too, but what others need goes to all of them in one message, which a bus
// carries once (InfiniteReality: Montrym et al. 1997).
enum class Redistribution : std::uint8_t { at_end, immediate, broadcast };

// The size and quality of a frame, and how it is shared out.
struct RenderOptions {
  int width = 1024, height = 768;
  // Of the frame: the part of it that is rendered, with the bytes that it has in the whole; costs
  // and memory are the part's. Empty: all of it.
  geometry::Rect window;
  bool float_pixels = false;  // an ImageF with linear light rather than 8-bit sRGB
  int supersampling = 1;      // 1, 2 or 4: so many samples per pixel in either direction
  Lighting lighting = Lighting::phong;
  bool eye_dome = false;  // pixels are darker behind what stands before them: shading/eye_dome.h
  Shade shade = Shade::deferred;
  // Faces away from the viewer of materials that are not double-sided are not drawn.
  bool cull_single_sided = false;
  // Clusters of triangles behind what was drawn before are skipped whole: the same picture sooner.
  bool skip_hidden_clusters = true;
  std::string strategy = "sort-last";
  Blend blend = Blend::by_owner;
  std::string scheme = "binary-swap";  // of composite::schemes(); sort-last
  std::string codec = "active";        // of composite::codecs(); sort-last
  std::string partition = "mahd";      // of loadbalance::partitioners(); sort-first and -middle
  CostSource costs = CostSource::model;
  int regions_per_rank = 1;  // more than one: the costliest go first to the least loaded rank
  // A partition is kept from frame to frame for as long as no rank would have to do more than so
  // many times an equal share.
  double keep_factor = 1.1;
  // Who shows which part of the frame (loadbalance/wall.h): every rank gets the pixels of the
  // displays that it owns, and rank 0 no picture. Disjoint; without a window. Sort-last composites
  // one after the other, the others draw regions of the whole frame, of which every rank sends on
  // what others show (Samanta et al. 1999). Empty: all of it goes to rank 0.
  std::vector<loadbalance::Region> displays;
  // Sort-first, and sort-middle with one group: instead of `partition`, displays are the regions,
  // each drawn by its owner. Primitives travel, pixels do not.
  bool owners_draw = false;
  // Of loadbalance::schedules(): blocks of the screen change rank while they are rendered, for
  // instance from a rank whose region takes long to one that is done with its own. Every rank needs
  // all primitives then, and knows from their clusters' bounds which a block shows. Empty: none.
  std::string schedule;
  bool master_works = true;  // whether ranks that hand out blocks draw some themselves
  int block = 64;            // pixels, the side of a block that is handed out
  // Of packs: how far, in pixels, what is drawn may be from where it belongs; 0: nowhere.
  double error = 0;
  bool report_partition = false;     // costs time of about that of cutting
  Travel travel = Travel::geometry;  // sort-first, hybrid
  Groups groups = Groups::one;       // sort-middle; a single rank does both
  // Of two groups: ranks 0 .. geometry_ranks - 1 have the primitives, the others draw. 0: half.
  int geometry_ranks = 0;
  Redistribution redistribution = Redistribution::immediate;  // sort-middle
  // Sort-last: the images that are composited are masks of covered pixels
  // (composite/metadata_only.h), and cutting and merging them takes so long. All is drawn, sent and
  // counted, but there is no picture, and a rank needs an image only while it draws. With codec
  // `active`, an opaque scene and ranks of one process; otherwise nothing changes.
  std::optional<composite::LayerCosts> count_only;
};

// The first four are seconds of processor time, summed over threads: clusters culled, transformed
// and set up; sorted by tile; rasterized; pixels shaded. The others pass on the rank's clock
// (Communicator::seconds), waiting for other ranks included.
struct Phases {
  double transform = 0, bin = 0, rasterize = 0, shade = 0;
  double redistribute = 0, compose = 0, gather = 0;

  void operator+=(const Phases& other);
};

// Work of a rank, or of all of them, with the pages of a pack.
struct PackCounts {
  static constexpr std::size_t kLevels = 64;

  std::uint64_t pages = 0;         // in view
  std::uint64_t pages_hidden = 0;  // left out, as they were behind what was drawn before
  std::uint64_t clusters = 0;      // of the pages that were drawn
  // Of the pages that were drawn the triangles by level, the finest first; the last has all beyond.
  std::array<std::uint64_t, kLevels> levels{};
  packs::CacheCounts cache;  // with several threads these depend on which of them was faster

  void operator+=(const PackCounts& other);
};

// The memory that a rank may take for the pages of a pack.
struct PackMemory {
  std::uint64_t cache_bytes = std::uint64_t{1} << 30;
  bool one_frame = false;  // pages need not stay for another one
};

// One rank's work for a frame.
struct RankStatistics {
  int rank = 0;
  double busy = 0;          // transform + bin + rasterize + shade
  std::uint64_t tasks = 0;  // tiles
  Phases phases;
  std::uint64_t triangles_in = 0;           // of the clusters that the rank looked at
  std::uint64_t triangles = 0, shaded = 0;  // triangles rasterized, samples shaded
  std::uint64_t bytes_sent = 0, bytes_received = 0, messages = 0;  // messages: sent
  std::uint64_t requests = 0, steals = 0, blocks_stolen = 0;       // of a schedule
  double idle = 0;  // seconds that threads waited for tasks of a schedule
  PackCounts pack;

  void operator+=(const RankStatistics& other);  // but for `rank`
};

// Measures of the screen's partition: see loadbalance/balance.h.
struct PartitionStatistics {
  double predicted = 1;   // imbalance that the costs foretell
  double over_share = 1;  // largest load over an equal share, what falls to several owners counted
  double overlap = 1;     // owners of a primitive, on average
  std::uint64_t primitives = 0, shared = 0;  // in the frame; of those, with several owners
  double seconds = 0;                        // that cutting took on rank 0; 0 when kept
  bool kept = false;                         // from the last frame
  loadbalance::Partition partition;
  std::vector<double> loads;  // by owner, as the costs foretell
};

// The cost of a frame, and the work that was done.
struct Statistics {
  Phases phases;                      // summed over ranks
  std::vector<RankStatistics> ranks;  // ascending
  double imbalance = 1;               // max over mean of the ranks' busy times; 1 when all are 0
  // Summed over ranks: with sort-first a primitive counts on each rank that gets it.
  std::uint64_t triangles_in = 0, triangles_culled = 0, triangles_clipped = 0,
                triangles_rasterized = 0;
  // Of clusters skipped because they were hidden, and how many these were: with several threads
  // that depends on which of them was faster.
  std::uint64_t triangles_hidden = 0, clusters_hidden = 0;
  std::uint64_t triangles_travelled = 0;  // sent from one rank to another, once per receiver
  std::uint64_t fragments_travelled = 0;  // surfaces at samples that another rank owns; hybrid
  // Before ranks are composited: surfaces seen at samples, but for those that a rank knows to be
  // hidden by another, and how often one was shaded.
  std::uint64_t fragments = 0, shaded = 0;
  std::optional<PartitionStatistics> partition;  // if asked for, and the screen was cut
  std::optional<PackCounts> pack;                // summed over ranks, where there is one
  std::vector<std::string> warnings;

  // Of several renderings by the same ranks: times and counts are summed, the rest is the last's.
  void operator+=(Statistics&& more);
};

// Depths are distances along the view axis, in the scene's units.
using Picture = std::variant<image::Image8, image::ImageF>;

// A frame.
struct Result {
  Picture picture;             // on rank 0; of size 0 elsewhere, and where there are displays
  std::vector<Picture> shown;  // of this rank's displays, in their order
  Statistics statistics;       // on rank 0; empty elsewhere
};

// One rank's part of a frame in the making, in steps that follow each other. Steps may be taken by
// different threads, and frames of one Renderer may be in different steps at the same time: see
// Renderer::begin.
class FrameInSteps {
 public:
  virtual ~FrameInSteps() = default;
  // Culls, transforms and sets up; draws small triangles as they come.
  virtual void transform() = 0;
  // Draws what is left, and shades.
  virtual void rasterize() = 0;
  // Collective: composites over ranks. As Renderer::render.
  virtual Result compose() = 0;
};

// A partial image of sort-last: colours and depths (smaller is nearer; no distances) of an opaque
// scene, or all surfaces of one that blends some.
using PartialImage = std::variant<image::Image8, composite::DeepImage<image::RgbaF>>;

// Renders frames of one scene, keeping the memory that a frame needs for the next one. One per
// rank.
class Renderer {
 public:
  // Refers to the scene, which must not change unless `follow` is told. The shader may be shared
  // among ranks; without one it is made from the scene.
  //
  // REQUIRES: indices of the scene are in range (as scenes::load and the generators leave it).
  explicit Renderer(const scenes::Scene& scene,
                    std::shared_ptr<const shading::Shader> shader = nullptr);
  // Renders a scene of which every rank has a part: ascending runs of its triangles, that of rank 0
  // first. Refers to the part. Only strategies that say so render parts, with one group of ranks
  // and not blended by cell. Collective; draw_share and costs are not for parts.
  Renderer(comm::Communicator& communicator, const scenes::ScenePart& part,
           std::shared_ptr<const shading::Shader> shader = nullptr);
  // Renders a pack, of which no more than some pages are in memory. `scene` is what the pack has
  // besides (packs::PackReader::scene), with whatever light. Refers to both. Only strategies that
  // say so render packs, without schedules, not in steps, without displays, and not blended by
  // cell; draw_share and costs do not.
  Renderer(const packs::PackReader& pack, const scenes::Scene& scene, const PackMemory& memory,
           std::shared_ptr<const shading::Shader> shader = nullptr);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  // The scene has been posed (scenes::pose), and its shader has the lights of the pose. To be told
  // on every rank, between frames: sort-first and hybrid then send transforms of what moved, and
  // what bent, and nothing else again. Not of packs; no frame in steps is under way.
  void follow(const scenes::Movement& movement);

  // Collective: every rank calls it with the same scene, camera and options. Uncovered pixels are
  // transparent black with depth image::kEmptyDepth. A pixel's depth is that of the nearest
  // surface at its samples, opaque or not. `progress` counts tiles of this rank.
  //
  // Of a pack also files::FileError.
  //
  // Throws std::invalid_argument for names that are in no table, for options that exclude each
  // other, for sizes in samples below 1 or above 65534, for a window or display that reaches beyond
  // the frame and for owners that are no rank; parallel::Interrupted when asked to stop.
  Result render(comm::Communicator& communicator, const scenes::Camera& camera,
                const RenderOptions& options, parallel::Progress* progress = nullptr);

  // Whether frames of this strategy may be in different steps at the same time. Others have ranks
  // exchange messages before they draw, or learn from one frame for the next. Throws for options
  // that render would not take from so many ranks.
  static bool has_steps(const RenderOptions& options, int ranks);

  // The frame that render would give, in steps, none of which is taken yet. The frame refers to
  // this, to the communicator and to the progress, which it only looks at to stop, and has memory
  // of its own until it is rasterized, which later frames use again. It and its steps throw as
  // render does.
  //
  // REQUIRES: has_steps. No two frames are in `transform` at the same time, nor two in
  // `compose`, which all ranks take in the same order; nobody else uses the communicator meanwhile.
  std::unique_ptr<FrameInSteps> begin(comm::Communicator& communicator,
                                      const scenes::Camera& camera, const RenderOptions& options,
                                      const parallel::Progress* progress = nullptr);

  // The part that rank `rank` of `ranks` contributes to sort-last before anything travels: an
  // equal, ascending share of the primitives, drawn over the whole frame. Not collective. `options`
  // as above; only what concerns drawing counts, and supersampling is not allowed.
  PartialImage draw_share(int rank, int ranks, const scenes::Camera& camera,
                          const RenderOptions& options, parallel::Progress* progress = nullptr);

  // What sort-first and sort-middle would cut the screen into so many regions by: boxes around
  // groups of all primitives and a grid of their costs, by the model. Not collective. `options` as
  // above; only what concerns drawing counts. REQUIRES: regions >= 1.
  loadbalance::Costs costs(int regions, const scenes::Camera& camera, const RenderOptions& options);

  // Gives the memory of a picture that is no longer needed to the next frame: fresh memory takes
  // longer to write to than a simple scene takes to draw.
  //
  // REQUIRES: it is as this renderer returned it last, or in other memory than that picture: what
  // it shows nothing in is taken for clear.
  void recycle(Picture&& picture);

 private:
  struct Memory;
  struct Frame;
  class Steps;
  Result composite_displays(comm::Communicator& communicator, const scenes::Camera& camera,
                            const RenderOptions& options, parallel::Progress* progress);
  std::unique_ptr<Memory> memory_;
};

// One frame.
Result render(comm::Communicator& communicator, const scenes::Scene& scene,
              const scenes::Camera& camera, const RenderOptions& options,
              parallel::Progress* progress = nullptr);

}  // namespace delray::raster
