// Chunks of LAZ points of the formats 6 to 8, which have a stream for each of their fields.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

#include "delaunay/files/laz/layered_colours.h"

namespace delray::delaunay::laz {

// What the records of a file consist of, in this order: 30 bytes of coordinates and attributes,
// then
struct LayeredItems {
  bool colour = false;         // 6 bytes
  bool near_infrared = false;  // 2 bytes
  std::size_t extra_bytes = 0;
  int version = 3;  // of the items, 3 or 4

  std::size_t record_size() const {
    return 30 + (colour ? 6 : 0) + (near_infrared ? 2 : 0) + extra_bytes;
  }
};

// Decodes coordinates, numbers of returns, classification, intensity and colour. Streams of other
// fields are skipped, and their bytes are as in the chunk's first point.
class LayeredDecoder {
 public:
  explicit LayeredDecoder(const LayeredItems& items);
  ~LayeredDecoder();

  // Decodes a chunk into records as in an uncompressed file; it begins with one of those. Returns
  // whether `chunk` had enough bytes; without, what is in `records` is arbitrary.
  //
  // REQUIRES: records.size() is a multiple of items.record_size(), and at least one times it.
  bool decode(std::string_view chunk, std::span<char> records);

 private:
  struct Channel;
  struct Layers;

  // What it has not seen yet begins as in the channel before.
  Channel& change_channel(unsigned channel);

  LayeredItems items_;
  unsigned current_ = 0;
  std::array<std::unique_ptr<Channel>, 4> channels_;
  LayeredColours colours_;
};

}  // namespace delray::delaunay::laz
