// IceT's strategies as compositing schemes.
#pragma once

#include <span>

#include "icet/interface.h"

namespace delray::icet {

// A value for icetStrategy, or for icetSingleImageStrategy.
struct Strategy {
  IceTEnum value;
  const char* name;    // for people, as the interface tells it
  const char* scheme;  // for composite::compose; null: that of the single-image strategy
  bool ordered;        // IceT's own blends in order; here all do
  // Blended colours are over the background without ICET_CORRECT_COLORED_BACKGROUND, too.
  bool always_corrects = false;
};

// The tables.
std::span<const Strategy> strategies();
std::span<const Strategy> single_image_strategies();
// Null where there is no such value.
const Strategy* find_strategy(std::span<const Strategy> table, IceTEnum value);

}  // namespace delray::icet
