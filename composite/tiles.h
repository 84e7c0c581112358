// A distributed framebuffer: tiles are composited while others are still being drawn.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "comm/communicator.h"
#include "composite/layer.h"
#include "composite/scheme.h"

namespace delray::composite {

// Tiles are pieces of the image, assigned to ranks in turn (OSPRay's: Usher, Wald, Amstutz et al.
// 2019). A rank draws them in any order, each into its own layer; the tile goes to its owner at
// once, who merges what has come for it, in one fixed order, so that the result depends on nobody's
// speed. All ranks make one, of layers of the same size, draw every tile once, and finish.
//
//   TileCompositor compositor(communicator, std::move(layer), options);
//   for (int tile = 0; tile < compositor.tiles(); ++tile) {
//     ... draw compositor.range(tile) into compositor.layer() ...
//     compositor.drawn(tile);
//   }
//   Part part = compositor.finish();
class TileCompositor {
 public:
  TileCompositor(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                 const ComposeOptions& options);

  int tiles() const { return tiles_; }  // a multiple of the number of ranks
  PixelRange range(int tile) const;     // may be empty
  int owner(int tile) const { return tile % communicator_.size(); }
  Layer& layer() { return *layer_; }

  // Sends the tile to its owner and merges what has come for own tiles that are drawn. REQUIRES:
  // nobody draws into the layer meanwhile, or only into tiles that are not drawn yet of a layer
  // with an image; neither this nor nothing_in was called for this tile before.
  void drawn(int tile);
  // Says that this rank has nothing in a tile: no pixels of it travel.
  void nothing_in(int tile);
  // Waits for the tiles of the others.
  OwnedPixels finish();

 private:
  // The state of a tile that this rank owns.
  struct Own {
    bool drawn = false;
    std::size_t merged = 0;  // ranks of order_
    // Messages that have come before their turn; none from ranks that have nothing.
    std::map<int, std::optional<comm::Buffer>> not_yet{};
  };
  using Announced = std::map<int, std::deque<int>>;
  Own& own(int tile) { return own_[static_cast<std::size_t>(tile / communicator_.size())]; }
  void hand_over(int tile, bool has_pixels);
  std::optional<int> sender_of_next_number(comm::Deadline deadline);
  void take_number(int from);
  void take_pixels(Announced::iterator from);
  void take_what_came();
  void add(int tile, int from, std::optional<comm::Buffer>&& pixels);
  void merge_what_came(int tile);

  comm::Communicator& communicator_;
  std::unique_ptr<Layer> layer_;
  int samples_per_pixel_;
  int tiles_ = 0;
  std::vector<int> order_;  // in which the images of other ranks are merged
  std::vector<Own> own_;    // of tile rank + i * ranks
  Announced announced_;     // tiles whose pixels are on their way, by source, in their order
  std::vector<std::size_t> numbers_to_come_;  // by source
  std::size_t missing_ = 0;                   // of other ranks
};

}  // namespace delray::composite
