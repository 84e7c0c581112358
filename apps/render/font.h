// A font of pixels, for the few words in a picture.
#pragma once

#include <array>
#include <cstdint>

namespace delray::apps {

inline constexpr int kGlyphWidth = 7, kGlyphHeight = 13;

// Row j from the top; bit 7 - i is pixel i.
using Glyph = std::array<std::uint8_t, kGlyphHeight>;

// Of printable ASCII; other characters look as a question mark does.
const Glyph& glyph(char letter);

}  // namespace delray::apps
