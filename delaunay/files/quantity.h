// Quantities that columns of text and properties of PLY give of a point.
#pragma once

namespace delray::delaunay {

enum Quantity {
  kX,
  kY,
  kZ,
  kRed,
  kGreen,
  kBlue,
  kAlpha,
  kIntensity,
  kClass,
  kQuantities,
  kSkipped = kQuantities
};

}  // namespace delray::delaunay
