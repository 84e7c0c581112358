// The compression of PCD files.
#pragma once

#include <span>
#include <string_view>

namespace delray::delaunay {

// Unpacks what LZF has packed (M. Lehmann, LibLZF): runs of literal bytes, and copies of 3 to 264
// bytes from at most 8 192 bytes before. Returns whether `packed` is whole and gives exactly as
// many bytes as `unpacked` has. O(bytes).
bool unpack_lzf(std::string_view packed, std::span<char> unpacked);

// At most how many bytes so many packed ones can give.
inline constexpr std::size_t most_lzf_bytes(std::size_t packed) { return packed * 88; }

}  // namespace delray::delaunay
