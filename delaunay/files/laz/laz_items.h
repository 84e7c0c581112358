// What decoders of LAZ points have in common.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>

namespace delray::delaunay::laz {

// Little-endian values anywhere in a record.
template <class T>
T load(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}
template <class T>
void store(char* at, T value) {
  std::memcpy(at, &value, sizeof value);
}

// a + b in 32 bits, wrapping.
inline std::int32_t add(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}

// The median of about the last five numbers, as LAZ keeps it: of five sorted ones a new number
// displaces the greatest and the smallest in turns.
class StreamingMedian {
 public:
  std::int32_t get() const { return sorted_[2]; }
  void add(std::int32_t value);

 private:
  std::array<std::int32_t, 5> sorted_{};
  bool drop_greatest_ = true;
};

inline void StreamingMedian::add(std::int32_t value) {
  const bool above = value > sorted_[2] || (drop_greatest_ && value == sorted_[2]);
  if (drop_greatest_) {
    int i = 4;
    for (; i > (above ? 3 : 0) && value < sorted_[i - 1]; --i) sorted_[i] = sorted_[i - 1];
    sorted_[i] = value;
  } else {
    int i = 0;
    for (; i < (above ? 4 : 1) && sorted_[i + 1] < value; ++i) sorted_[i] = sorted_[i + 1];
    sorted_[i] = value;
  }
  drop_greatest_ = !above;
}

// The context that the magnitude class of other coordinates gives: even ones, up to `most`.
inline unsigned even_context(unsigned magnitude, unsigned most) {
  return magnitude < most ? magnitude & ~1U : most;
}

}  // namespace delray::delaunay::laz
