// Chunks of LAZ points of the formats 0 to 3, which are coded point by point into one stream.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "delaunay/files/laz/arithmetic_decoder.h"
#include "delaunay/files/laz/colour_decoder.h"
#include "delaunay/files/laz/laz_items.h"

namespace delray::delaunay::laz {

// What the records of a file consist of, in this order: 20 bytes of coordinates and attributes,
// then
struct PointwiseItems {
  bool time = false;    // 8 bytes
  bool colour = false;  // 6 bytes
  std::size_t extra_bytes = 0;

  std::size_t record_size() const { return 20 + (time ? 8 : 0) + (colour ? 6 : 0) + extra_bytes; }
};

// Times of pulses, as integers with the bits of a double: of up to four interleaved sequences
// (flight lines), each with a last time and a last step, that of the sequence in turn is coded as a
// multiple of its step.
class TimeDecoder {
 public:
  TimeDecoder() : steps_(32, 9) {}
  void reset(std::int64_t first);
  std::int64_t decode(ArithmeticDecoder& decoder);

 private:
  // Return whether the next symbol is of another sequence, into which they have changed.
  bool decode_without_step(ArithmeticDecoder& decoder);
  bool decode_with_step(ArithmeticDecoder& decoder);
  void begin_sequence(ArithmeticDecoder& decoder);
  // Counts a step that is no multiple of the sequence's, or out of their range. After some of them
  // in a row the last one becomes the sequence's step.
  void count_extreme(std::int32_t step);

  struct Sequence {
    std::int64_t time = 0;
    std::int32_t step = 0;
    int extremes = 0;  // since a step was about the sequence's: see count_extreme
  };
  std::array<Sequence, 4> sequences_;
  unsigned current_ = 0, newest_ = 0;
  SymbolModel multiples_, multiples_of_zero_;
  IntegerDecoder steps_;
};

class PointwiseDecoder {
 public:
  explicit PointwiseDecoder(const PointwiseItems& items);

  // Decodes a chunk into records as in an uncompressed file; it begins with one of those. Returns
  // whether `chunk` had enough bytes; without, what is in `records` is arbitrary.
  //
  // REQUIRES: records.size() is a multiple of items.record_size(), and at least one times it.
  bool decode(std::string_view chunk, std::span<char> records);

 private:
  void reset(const char* first);
  void decode_point(ArithmeticDecoder& decoder, const char* last, char* record);

  PointwiseItems items_;
  SymbolModel changes_;
  std::vector<SymbolModel> returns_, classifications_, user_data_;  // by the last value
  std::array<SymbolModel, 2> scan_angles_;                          // by direction of scan
  IntegerDecoder intensities_, sources_, x_, y_, z_;
  std::array<StreamingMedian, 16> x_steps_, y_steps_;
  std::array<std::uint16_t, 16> last_intensity_{};
  std::array<std::int32_t, 8> last_z_{};
  TimeDecoder times_;
  ColourDecoder colours_;
  std::vector<SymbolModel> extra_bytes_;
};

}  // namespace delray::delaunay::laz
