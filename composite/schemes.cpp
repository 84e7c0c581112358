#include <algorithm>
#include <array>

#include "composite/internal/schemes.h"
#include "composite/scheme.h"

namespace delray::composite {
namespace {

constexpr std::array kSchemes = {
    Scheme{"binary-swap", "partners exchange halves, log2 n rounds (hypercube)",
           &internal::binary_swap},
    Scheme{"centralized", "rank 0 receives and merges all images", &internal::centralized},
};

}  // namespace

std::span<const Scheme> schemes() { return kSchemes; }

const Scheme* find_scheme(std::string_view name) {
  const auto at = std::find_if(kSchemes.begin(), kSchemes.end(),
                               [name](const Scheme& scheme) { return scheme.name == name; });
  return at == kSchemes.end() ? nullptr : &*at;
}

}  // namespace delray::composite
