// The random numbers of ray tracing: a pixel, the number of its sample and a dimension decide each
// of them, so that they are the same whoever asks for them, when and in which order.
//
// A pair of dimensions is a Sobol (0,2)-sequence (Sobol 1967) under a nested uniform scrambling
// (Owen 1995) of its own, over samples in an order of its own, so that pairs can be put side by
// side (Burley 2020). The scrambling is by hashing, after Laine and Karras (2011): the first 2^k
// samples of a pixel, and any aligned 2^k after them, have exactly one point in every box of the
// unit square whose sides are powers of two and whose area is 2^-k.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "shading/points.h"

namespace delray::raytrace {

// What all numbers of a pixel derive from; different for every pixel and seed (Philox: Salmon et
// al. 2011).
std::uint64_t pixel_key(std::uint64_t seed, int x, int y);

// The keys of sixteen pixels, in halves, by vectors.
struct PixelKeys {
  alignas(64) std::uint32_t low[shading::kBlockPoints], high[shading::kBlockPoints];

  std::uint64_t key(int i) const { return std::uint64_t{high[i]} << 32 | low[i]; }
};

// Of 4 x 4 pixels: lane i is (x + i % 4, y + i / 4).
void pixel_keys(std::uint64_t seed, int x, int y, PixelKeys& keys);

// Number `sample` of a dimension, and of a pair of dimensions: multiples of 2^-24 from [0, 1). A
// dimension and a pair with the same number have nothing to do with each other.
float sobol(std::uint64_t pixel, std::uint32_t sample, std::uint32_t dimension);
glm::vec2 sobol_pair(std::uint64_t pixel, std::uint32_t sample, std::uint32_t dimension);

// A sampler without any order among samples: independent numbers, to compare with.
glm::vec2 independent_pair(std::uint64_t pixel, std::uint32_t sample, std::uint32_t dimension);

// Sixteen samples, of any pixels, and a dimension of each. The key is in two halves.
struct SampleLanes {
  alignas(64) std::uint32_t key_low[shading::kBlockPoints], key_high[shading::kBlockPoints];
  alignas(64) std::uint32_t sample[shading::kBlockPoints], dimension[shading::kBlockPoints];

  void set(int i, std::uint64_t pixel, std::uint32_t number, std::uint32_t at) {
    set(i, static_cast<std::uint32_t>(pixel), static_cast<std::uint32_t>(pixel >> 32), number, at);
  }
  void set(int i, std::uint32_t low, std::uint32_t high, std::uint32_t number, std::uint32_t at) {
    key_low[i] = low;
    key_high[i] = high;
    sample[i] = number;
    dimension[i] = at;
  }
};

struct Pairs16 {
  shading::Floats16 x, y;
};

// By vectors: lane i of pairs[k] is sobol_pair of lane i, its dimension plus k.
void sobol_pairs(const SampleLanes& lanes, std::span<Pairs16> pairs);

// Dimension after dimension of one sample of a pixel. Copies are cheap and go on by themselves.
class Sampler {
 public:
  Sampler() = default;
  Sampler(std::uint64_t pixel, std::uint32_t sample, std::uint32_t dimension = 0)
      : pixel_(pixel), sample_(sample), dimension_(dimension) {}

  float one() { return sobol(pixel_, sample_, dimension_++); }
  glm::vec2 two() { return sobol_pair(pixel_, sample_, dimension_++); }

  // Whoever does without some numbers leaves them out, so that later ones stay what they are.
  void skip(std::uint32_t dimensions) { dimension_ += dimensions; }
  std::uint32_t dimension() const { return dimension_; }

 private:
  std::uint64_t pixel_ = 0;
  std::uint32_t sample_ = 0, dimension_ = 0;
};

}  // namespace delray::raytrace
