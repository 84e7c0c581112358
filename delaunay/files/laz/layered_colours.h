// The layer of colours of LAZ points of the formats 7 and 8.
#pragma once

#include <array>
#include <string_view>

#include "delaunay/files/laz/arithmetic_decoder.h"
#include "delaunay/files/laz/colour_decoder.h"

namespace delray::delaunay::laz {

// Predicts a colour by the last one of the same scanner channel, with models of that channel.
// Version 3 of the items means to, but is told of a channel only when it changes, and takes it for
// the first one until then; and a channel that was seen before is predicted by, and kept as, the
// last colour of the one in turn. Version 4 does as is meant.
class LayeredColours {
 public:
  // `layer` without bytes: all colours are as `first`, that of a point of `channel`.
  void reset(std::string_view layer, const Colour& first, unsigned channel, int version);
  Colour decode(unsigned channel, bool channel_changed);
  bool overrun() const { return !empty_ && decoder_.overrun(); }

 private:
  struct Channel {
    bool used = false;
    ColourDecoder decoder;
    Colour last{};
  };
  void begin(Channel& channel, const Colour& last);

  bool empty_ = true;
  int version_ = 3;
  unsigned current_ = 0;
  ArithmeticDecoder decoder_;
  std::array<Channel, 4> channels_;
};

}  // namespace delray::delaunay::laz
