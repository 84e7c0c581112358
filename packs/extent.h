// The extent of a packed scene, which cameras are fitted to.
#pragma once

#include "packs/pack_reader.h"
#include "scenes/extent.h"

namespace delray::packs {

// As scenes::farthest_points of the scene that was packed, to the last bit. Only pages whose boxes
// reach far enough are read. Refers to the pack.
scenes::FarthestPoints farthest_points(const PackReader& pack);

}  // namespace delray::packs
