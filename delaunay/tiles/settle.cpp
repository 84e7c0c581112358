#include "delaunay/tiles/settle.h"

#include <utility>

namespace delray::delaunay {
namespace {

template <int D>
Settled settle_in(Region&& region, const OtherTiles& others, const Options& options,
                  Messages messages) {
  Settled settled;
  RegionMesh<D> mesh(std::move(region), options);
  settled.distinct = mesh.distinct();
  settled.simplices = mesh.simplices();
  mesh.find_open(others);
  if (messages == Messages::yes) settled.messages = mesh.find_messages(others);
  settled.rest = mesh.rest();
  settled.finals = mesh.take_settled();
  return settled;
}

}  // namespace

Settled settle(Region&& region, const OtherTiles& others, const Options& options,
               Messages messages) {
  return options.dim == 2 ? settle_in<2>(std::move(region), others, options, messages)
                          : settle_in<3>(std::move(region), others, options, messages);
}

}  // namespace delray::delaunay
