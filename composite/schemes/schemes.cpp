// The table of compositing schemes, and the names with radices behind a colon that choose from it.
#include <algorithm>
#include <array>
#include <charconv>

#include "composite/scheme.h"
#include "composite/schemes/schemes.h"

namespace delray::composite {
namespace {

constexpr std::array kSchemes = {
    Scheme{"binary-swap",
           "pairs of ranks exchange halves of their images, log2 n rounds; surplus ranks send "
           "theirs first",
           &internal::binary_swap_folded, "swap"},
    Scheme{"binary-swap:remainder",
           "binary swap; of an odd number of ranks the last one splits its image",
           &internal::binary_swap_remainder, "swap"},
    Scheme{"binary-swap:telescoping",
           "binary swap in groups of 2^k ranks; the smaller groups join the larger ones",
           &internal::binary_swap_telescoping, "swap"},
    Scheme{"binary-swap:234",
           "binary swap after a first round in groups of two, three or four ranks",
           &internal::binary_swap_234, "swap"},
    Scheme{"2-3-swap", "a tree of groups of ranks, two or three of which merge at a time",
           &internal::two_three_swap, "swap"},
    Scheme{"radix-k",
           "groups of k ranks exchange pieces of their images, round by round; radix-k:8,4 sets "
           "the rounds",
           &internal::radix_k, "swap", true},
    Scheme{"direct-send", "each rank owns a piece of the image, which all others send to it",
           &internal::direct_send, "direct"},
    Scheme{
        "mesh",
        "ranks exchange along columns, then along rows of a grid; mesh:COLUMNSxROWS sets its size",
        &internal::mesh, "direct", true},
    Scheme{"tree", "half of the ranks send their images to the other half, log2 n rounds",
           &internal::tree, "tree"},
    Scheme{"pipeline",
           "each rank merges what it receives with its image, and sends it to the rank before",
           &internal::pipeline, "chain"},
    Scheme{"bus", "ranks broadcast in turn; later ones leave out what is hidden by then",
           &internal::bus, "chain"},
    Scheme{"tiles", "tiles of the image go to their owners at once, and are merged as they arrive",
           &internal::tiles, "direct"},
    Scheme{"centralized", "rank 0 receives and merges all images", &internal::centralized,
           "central"},
};

// "4,2" or "4x2"; nothing where that is not what it says.
std::vector<int> parse_radices(std::string_view text) {
  std::vector<int> result;
  const char *at = text.data(), *const end = at + text.size();
  for (;;) {
    int value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || value < 1) return {};
    result.push_back(value);
    if (next == end) return result;
    if (*next != ',' && *next != 'x') return {};
    at = next + 1;
  }
}

}  // namespace

std::span<const Scheme> schemes() { return kSchemes; }

SchemeChoice choose_scheme(std::string_view name) {
  if (name == "binary-swap:folded") name = "binary-swap";
  const auto find = [](std::string_view exact) {
    const auto at = std::find_if(kSchemes.begin(), kSchemes.end(),
                                 [&](const Scheme& scheme) { return scheme.name == exact; });
    return at == kSchemes.end() ? nullptr : &*at;
  };
  if (const Scheme* const scheme = find(name)) return {scheme, {}};
  const std::size_t colon = name.find(':');
  if (colon == name.npos) return {};
  const Scheme* const scheme = find(name.substr(0, colon));
  std::vector<int> radices = parse_radices(name.substr(colon + 1));
  if (scheme == nullptr || !scheme->takes_radices || radices.empty()) return {};
  return {scheme, std::move(radices)};
}

const Scheme* find_scheme(std::string_view name) { return choose_scheme(name).scheme; }

}  // namespace delray::composite
