// Chooses the mesh of the dimension and asks it for all that is wanted, in the order that it needs.
#include "delaunay/tiles/settle.h"

#include <utility>

namespace delray::delaunay {
namespace {

template <int D>
Settled settle_in(Region&& region, const OtherTiles& others, const Options& options,
                  const SettleWish& wish) {
  Settled settled;
  const std::size_t own = region.own, halo = region.halo();
  RegionMesh<D> mesh(std::move(region), options);
  if (wish.is_tile) {
    settled.points = own;
    // Points of halos are distinct, and equal to none of the tile's own.
    settled.distinct = mesh.distinct() - halo;
  }
  settled.simplices = mesh.simplices();
  mesh.find_open(others);
  if (wish.messages) settled.messages = mesh.find_messages(others);
  settled.rest = mesh.rest();
  settled.finals = mesh.take_settled(wish.finals);
  return settled;
}

}  // namespace

Settled settle(Region&& region, const OtherTiles& others, const Options& options,
               const SettleWish& wish) {
  return options.dim == 2 ? settle_in<2>(std::move(region), others, options, wish)
                          : settle_in<3>(std::move(region), others, options, wish);
}

}  // namespace delray::delaunay
