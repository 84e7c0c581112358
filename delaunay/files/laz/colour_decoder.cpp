// Colours byte by byte, each as the difference to what the bytes before it lead to expect
// (Isenburg, LASzip, 2013, section on RGB).
#include "delaunay/files/laz/colour_decoder.h"

#include <algorithm>

namespace delray::delaunay::laz {
namespace {

constexpr unsigned kColouredBit = 6;  // set: the channels differ

int byte_of(std::uint16_t channel, int byte) { return channel >> (8 * byte) & 0xff; }

}  // namespace

void ColourDecoder::reset() {
  changes_.reset(1U << (kColouredBit + 1));
  for (auto& channel : bytes_) {
    for (SymbolModel& model : channel) model.reset(256);
  }
}

Colour ColourDecoder::decode(ArithmeticDecoder& decoder, const Colour& last) {
  const unsigned changes = decoder.decode(changes_);
  const bool grey = (changes >> kColouredBit & 1) == 0;
  // Of the low and the high byte.
  std::array<std::array<int, 2>, 3> now{};
  const auto decode_byte = [&](int channel, int byte, int predicted) {
    int value = byte_of(last[channel], byte);
    if ((changes >> (2 * channel + byte) & 1) != 0) {
      value = (predicted + static_cast<int>(decoder.decode(bytes_[channel][byte]))) & 0xff;
    }
    now[channel][byte] = value;
  };
  for (int byte = 0; byte < 2; ++byte) decode_byte(0, byte, byte_of(last[0], byte));
  for (int byte = 0; byte < 2; ++byte) {
    if (grey) {
      now[1][byte] = now[2][byte] = now[0][byte];
      continue;
    }
    const auto moved = [&](int channel, int difference) {
      return std::clamp(byte_of(last[channel], byte) + difference, 0, 255);
    };
    const int red = now[0][byte] - byte_of(last[0], byte);
    decode_byte(1, byte, moved(1, red));
    const int green = now[1][byte] - byte_of(last[1], byte);
    decode_byte(2, byte, moved(2, (red + green) / 2));
  }
  Colour colour;
  for (int channel = 0; channel < 3; ++channel) {
    colour[channel] = static_cast<std::uint16_t>(now[channel][0] | now[channel][1] << 8);
  }
  return colour;
}

}  // namespace delray::delaunay::laz
