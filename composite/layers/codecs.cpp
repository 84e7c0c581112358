// The table of codecs: how images travel, each with its layer.
#include <array>

#include "composite/codec.h"
#include "composite/dense.h"
#include "composite/layers/active.h"
#include "composite/layers/bounds.h"
#include "composite/layers/lz4.h"
#include "files/find_named.h"

namespace delray::composite {
namespace {

constexpr std::array kCodecs = {
    Codec{"active", "covered pixels, with a bit mask in two levels that tells which they are",
          &make_active, &make_active},
    Codec{"bounds", "all pixels of the rectangle around those that are covered", &make_bounds,
          &make_bounds},
    Codec{"lz4", "as active, compressed by LZ4; for slow networks", &make_lz4, &make_lz4},
    Codec{"dense", "all pixels, covered or not", &make_dense, &make_dense},
};

}  // namespace

std::span<const Codec> codecs() { return kCodecs; }

const Codec* find_codec(std::string_view name) { return files::find_named(codecs(), name); }

}  // namespace delray::composite
