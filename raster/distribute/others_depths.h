// What of a rank's drawing others hide.
#pragma once

#include <optional>

#include "comm/collectives.h"
#include "raster/distribute/rank_context.h"

namespace delray::raster {

// What each block of the screen hides on any rank, while that is found out, so that none shades
// what another hides. Nothing happens where drawings are not composited or that cannot be
// known in time.
class OthersDepths {
 public:
  // Tells the others. Collective; nobody waits. Until `hide` the phase is redistribute.
  OthersDepths(RankContext& rank, RegionDrawing& drawing);

  // Waits for all ranks, and has the drawing drop what is hidden. Returns the part of the screen,
  // in samples, outside of which no rank has drawn anything, as far as is known; of whole tiles,
  // and at least one. REQUIRES: no other all_reduce since they were told.
  geometry::Rect hide();

  bool is_pending() const { return pending_.has_value(); }
  // The part of the screen, in samples and of whole tiles, that may show something of this rank.
  geometry::Rect shown() const;

  // Until all ranks have told, before hide(): tiles that are wanted, with all that was drawn in
  // them. Returns these.
  std::span<const TileJob> finish_meanwhile(FinishTile finish_tile,
                                            parallel::FunctionRef<bool(int tile)> wanted);
  // hide(), and RankContext::end_samples until all ranks have told and after it: the same image and
  // counts as if it had waited. Before it come tiles of which others hid nothing in the frame
  // before, for they are not likely to now. `seen` becomes what hide returns. REQUIRES:
  // is_pending(); one sample per pixel; a list that stays in memory.
  template <class Colour>
  image::BasicImage<Colour> end_samples_meanwhile(geometry::Rect& seen);

 private:
  geometry::Rect in_samples(const geometry::Rect& tiles) const;

  RankContext& rank_;
  RegionDrawing& drawing_;
  geometry::Rect mine_ = {};                // tiles seen
  std::optional<comm::AllReduce> pending_;  // none: there is nothing to wait for
};

}  // namespace delray::raster
