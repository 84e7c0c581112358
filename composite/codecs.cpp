#include <algorithm>
#include <array>

#include "composite/active.h"
#include "composite/bounds.h"
#include "composite/codec.h"
#include "composite/dense.h"
#include "composite/lz4.h"

namespace delray::composite {
namespace {

constexpr std::array kCodecs = {
    Codec{"active", "covered pixels, and a bit mask in two levels that tells which", &make_active,
          &make_active},
    Codec{"bounds", "every pixel of the rectangle around those covered", &make_bounds,
          &make_bounds},
    Codec{"lz4", "active, compressed by LZ4: for slow networks", &make_lz4, &make_lz4},
    Codec{"dense", "every pixel, covered or not", &make_dense, &make_dense},
};

}  // namespace

std::span<const Codec> codecs() { return kCodecs; }

const Codec* find_codec(std::string_view name) {
  const auto at = std::find_if(kCodecs.begin(), kCodecs.end(),
                               [name](const Codec& codec) { return codec.name == name; });
  return at == kCodecs.end() ? nullptr : &*at;
}

}  // namespace delray::composite
