// Compositing schemes: who sends which pixels to whom.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "comm/communicator.h"
#include "composite/layer.h"

namespace delray::composite {

struct ComposeOptions {
  int samples_per_pixel = 1;  // ranges are cut at multiples of it
};

// A scheme takes each rank's layer (all of the same size) and leaves every pixel final on exactly
// one rank. Collective over `communicator`; any number of ranks.
struct Scheme {
  const char* name;
  const char* description;
  Part (*compose)(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                  const ComposeOptions& options);
};

// The table: --list, tests, benchmarks and reports iterate over it.
std::span<const Scheme> schemes();

// nullptr when there is no such scheme.
const Scheme* find_scheme(std::string_view name);

// Brings all parts to rank `root`; there the result owns all pixels, elsewhere none. Collective.
Part gather(comm::Communicator& communicator, Part&& part, int root);

}  // namespace delray::composite
