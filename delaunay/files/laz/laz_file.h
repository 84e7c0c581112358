// What makes a LAS file a LAZ file: how its points are coded, and the table of its chunks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

#include "delaunay/files/las_header.h"
#include "delaunay/files/laz/layered_decoder.h"
#include "delaunay/files/laz/pointwise_decoder.h"

namespace delray::delaunay::laz {

// A run of points that is decoded without any other.
struct Chunk {
  std::uint64_t begin = 0, size = 0;  // its bytes in the file
  std::size_t first = 0, count = 0;   // its points
  std::size_t number = 0;             // in the file
};

struct LazFile {
  std::variant<PointwiseItems, LayeredItems> items;
  std::vector<Chunk> chunks;  // in the order of their points, none of them empty
};

// Throws FileError (input) for damaged tables, and for what is not read: items of other versions
// than 2 to 4 (files of before 2011), wave packets. O(chunks).
LazFile parse_laz_file(const ByteSource& source, const LasHeader& header);

// Decodes chunks, one at a time: each thread has its own.
class ChunkDecoder {
 public:
  explicit ChunkDecoder(const LazFile& file);

  // The records of a chunk of `count` points as an uncompressed file has them: count times
  // header.record_size bytes, valid until the next call. Of the fields those are decoded that
  // readers need (see LayeredDecoder). Empty if the chunk is damaged. O(points), some 0.2
  // microseconds each. REQUIRES: count >= 1.
  std::string_view decode(std::string_view chunk, std::size_t count);

 private:
  std::variant<PointwiseDecoder, LayeredDecoder> decoder_;
  std::size_t record_size_;
  std::vector<char> records_;
};

}  // namespace delray::delaunay::laz
