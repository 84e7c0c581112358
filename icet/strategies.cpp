// The tables of strategies. All tiles of a display are composited at once, as one image, so that a
// strategy says no more than by which scheme.
#include "icet/strategies.h"

#include <algorithm>
#include <array>

#include "icet/context.h"
#include "icet/error.h"

namespace delray::icet {
namespace {

constexpr std::array kStrategies = {
    Strategy{ICET_STRATEGY_DIRECT, "Direct", "direct-send", true},
    Strategy{ICET_STRATEGY_SEQUENTIAL, "Sequential", nullptr, true, true},
    Strategy{ICET_STRATEGY_SPLIT, "Split", "direct-send", false},
    Strategy{ICET_STRATEGY_REDUCE, "Reduce", nullptr, true, true},
    Strategy{ICET_STRATEGY_VTREE, "Virtual Tree", "2-3-swap", false},
};

constexpr std::array kSingleImageStrategies = {
    Strategy{ICET_SINGLE_IMAGE_STRATEGY_AUTOMATIC, "Automatic", "radix-k", true},
    Strategy{ICET_SINGLE_IMAGE_STRATEGY_BSWAP, "Binary Swap", "binary-swap:telescoping", true},
    Strategy{ICET_SINGLE_IMAGE_STRATEGY_TREE, "Binary Tree", "tree", true},
    Strategy{ICET_SINGLE_IMAGE_STRATEGY_RADIXK, "Radix-k", "radix-k", true},
    Strategy{ICET_SINGLE_IMAGE_STRATEGY_RADIXKR, "Radix-kr", "radix-k", true},
    Strategy{ICET_SINGLE_IMAGE_STRATEGY_BSWAP_FOLDING, "Folded Binary Swap", "binary-swap", true},
};

}  // namespace

std::span<const Strategy> strategies() { return kStrategies; }
std::span<const Strategy> single_image_strategies() { return kSingleImageStrategies; }

const Strategy* find_strategy(std::span<const Strategy> table, IceTEnum value) {
  const auto found = std::find_if(table.begin(), table.end(),
                                  [&](const Strategy& row) { return row.value == value; });
  return found == table.end() ? nullptr : &*found;
}

}  // namespace delray::icet

using delray::icet::current;
using delray::icet::Error;
using delray::icet::find_strategy;
using delray::icet::guarded;

extern "C" {

void icetStrategy(IceTEnum strategy) {
  guarded([&] {
    if (find_strategy(delray::icet::strategies(), strategy) == nullptr)
      throw Error(ICET_INVALID_ENUM, "there is no such strategy");
    current().settings.strategy = strategy;
  });
}

const char* icetGetStrategyName(void) {
  return guarded([&]() -> const char* {
    const auto* const row = find_strategy(delray::icet::strategies(), current().settings.strategy);
    if (row == nullptr) throw Error(ICET_INVALID_ENUM, "no strategy was chosen");
    return row->name;
  });
}

void icetSingleImageStrategy(IceTEnum strategy) {
  guarded([&] {
    if (find_strategy(delray::icet::single_image_strategies(), strategy) == nullptr)
      throw Error(ICET_INVALID_ENUM, "there is no such single-image strategy");
    current().settings.single_image = strategy;
  });
}

const char* icetGetSingleImageStrategyName(void) {
  return guarded([&]() -> const char* {
    return find_strategy(delray::icet::single_image_strategies(), current().settings.single_image)
        ->name;
  });
}

}  // extern "C"
