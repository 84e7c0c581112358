// What the tiles of a rank leave, and the exchange with other ranks that settles it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <unordered_set>
#include <utility>
#include <vector>

#include "delaunay/tiles/region.h"
#include "delaunay/tiles/settle.h"
#include "delaunay/tiles/settle_tiles.h"
#include "delaunay/tiles/tile_boxes.h"

namespace delray::delaunay {

// A point for another rank.
struct RankMessage {
  int rank = 0;
  RowPoint point;
};

// Triangulates what the rank knows and finds simplices that points of other tiles could be in
// conflict with. The ranks of these tiles are told of its own vertices of such a simplex. When
// nobody has anything new to tell, the stars of all own vertices are final (Caraffa et al., Tile &
// Merge, 2019; Funke and Sanders, Parallel d-D Delaunay triangulations in shared and distributed
// memory, 2017). The proof stands beside RegionMesh::find_messages().
class RankRegion {
 public:
  struct RankTiles {
    std::function<int(std::size_t tile)> rank_of;
    bool is_one = false;  // the region is a tile that nobody has triangulated yet
  };

  RankRegion(Region&& region, const OtherTiles& others, const SettleOptions& options,
             const RankTiles& tiles);
  ~RankRegion();

  // Takes the points in that it does not know.
  void add_halo(std::span<const RowPoint> points);
  // The first time gives away what others cannot change; later nothing. With the own points that
  // other ranks must be told of and have not been, by ascending rank and row.
  std::vector<RankMessage> look(Settled& settled);
  // The rest, once nobody has anything to tell. Not before look().
  Settled finish();

  std::uint64_t halo() const { return halo_rows_.size(); }

 private:
  struct Mesh;
  std::vector<RankMessage> untold(const std::vector<TileMessage>& messages);

  Region region_;
  OtherTiles others_;
  parallel::Progress progress_;  // of what was triangulated before
  Options options_;
  std::function<void(std::uint64_t points)> require_;
  FinalsWish finals_;
  RankTiles tiles_;
  std::unordered_set<std::uint64_t> halo_rows_;
  std::vector<std::pair<int, std::uint64_t>> told_;  // ranks, and rows of points; ascending
  bool changed_ = true, settled_ = false;
  std::unique_ptr<Mesh> mesh_;  // of all that it knows unless changed_
};

}  // namespace delray::delaunay
