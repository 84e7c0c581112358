// Colours of LAZ points, three channels of 16 bits, as all versions of the format code them.
#pragma once

#include <array>
#include <cstdint>

#include "delaunay/files/laz/arithmetic_decoder.h"

namespace delray::delaunay::laz {

using Colour = std::array<std::uint16_t, 3>;

// Which of the six bytes differ from those of `last` is one symbol; green is predicted by the
// change of red, blue by that of both.
class ColourDecoder {
 public:
  void reset();
  Colour decode(ArithmeticDecoder& decoder, const Colour& last);

 private:
  SymbolModel changes_;
  // Of the low and the high byte of each channel.
  std::array<std::array<SymbolModel, 2>, 3> bytes_;
};

}  // namespace delray::delaunay::laz
