// The tiles that ranks have drawn become those of the display.
#pragma once

#include <optional>
#include <vector>

#include "composite/borrowed.h"
#include "icet/context.h"
#include "image/image.h"

namespace delray::icet {

// The pixels that this rank has drawn, where they are, one for each tile of the display; nothing
// where it has drawn nothing.
template <class Colour>
using TilePixels = std::vector<std::optional<composite::BorrowedPixels<Colour>>>;

// Composites them as the settings say, brings each tile to the rank that shows it, and leaves it in
// context.result, with the background and which of its pixels are valid (Frame::valid_tile).
// Where images are not collected, each rank keeps the pixels that it has composited, if there is
// one tile; of several, they are collected all the same.
//
// Collective; throws what composite::compose throws. In the end all that this rank has sent is on
// its way: nobody waits for it, however long it draws the next frame.
template <class Colour>
void compose_frame(Context& context, const TilePixels<Colour>& tiles);

extern template void compose_frame(Context&, const TilePixels<image::Rgba8>&);
extern template void compose_frame(Context&, const TilePixels<image::RgbaF>&);

// What a rank calls instead that cannot go on: compose_frame throws on the others.
void fail_frame(Context& context);

}  // namespace delray::icet
