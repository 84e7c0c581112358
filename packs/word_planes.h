// Arrays of numbers as bytes that compress well.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace delray::packs {

// Appends n values of 4 bytes, `stride` values apart from each other: the difference of each to the
// one before, in the order of floats, with the sign in the lowest bit; the first bytes of all
// differences, then the second ones, the third and the fourth. Exact for any bits.
void append_planes(const std::uint32_t* values, std::size_t n, std::size_t stride,
                   std::vector<char>& bytes);

// The inverse for vectors of k values: from 4 * k * n bytes, which are the planes of the first
// value of all vectors, then those of the second and so on.
//
// REQUIRES: 1 <= k <= 4.
void read_planes(const char* bytes, std::size_t n, int k, std::uint32_t* values);

// Compressed by LZ4, or as they are where that is no smaller.
std::vector<char> compress(std::span<const char> bytes);
// Into exactly so many bytes. Returns whether that is what they unpack to.
bool decompress(std::span<const char> compressed, std::span<char> bytes);

}  // namespace delray::packs
