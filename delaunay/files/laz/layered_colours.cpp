// Which model and which colour predicts the next colour of a chunk of LAZ points in layers, with
// the slips of version 3 (see the header), which its encoder makes as well.
#include "delaunay/files/laz/layered_colours.h"

namespace delray::delaunay::laz {

void LayeredColours::begin(Channel& channel, const Colour& last) {
  channel.used = true;
  channel.decoder.reset();
  channel.last = last;
}

void LayeredColours::reset(std::string_view layer, const Colour& first, unsigned channel,
                           int version) {
  empty_ = layer.empty();
  decoder_ = ArithmeticDecoder(layer);
  version_ = version;
  current_ = channel;
  for (Channel& each : channels_) each.used = false;
  begin(channels_[channel], first);
}

Colour LayeredColours::decode(unsigned channel, bool channel_changed) {
  Colour* last = &channels_[current_].last;
  const unsigned next = version_ > 3 || channel_changed ? channel : 0;
  if (next != current_) {
    current_ = next;
    const bool used = channels_[next].used;
    if (!used) begin(channels_[next], *last);
    if (!used || version_ > 3) last = &channels_[next].last;
  }
  if (!empty_) *last = channels_[current_].decoder.decode(decoder_, *last);
  return *last;
}

}  // namespace delray::delaunay::laz
