// Compositing schemes: who sends which pixels to whom.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "comm/communicator.h"
#include "composite/layer.h"

namespace delray::composite {

// Parameters of schemes.
struct ComposeOptions {
  int samples_per_pixel = 1;  // ranges are cut at multiples of it
  // Radices of a scheme that takes_radices, each >= 1: radix-k the sizes of its groups, round by
  // round, mesh its columns. Where the number of ranks does not allow them it takes what is near;
  // without any it chooses.
  std::vector<int> radices = {};
  // compose() only: which pixels lie beside each other in an encoded range. See interlaced.h.
  bool interlace = false;
  // compose() only: all ranks, each once, as their layers lie one behind the other, the foremost
  // first, for layers that are blended in order; the lower of two ranks is then the one that comes
  // earlier here. Empty: by number. The same on every rank.
  std::vector<int> order = {};
};

// A scheme takes each rank's layer (all of the same size) and leaves every pixel final on exactly
// one rank. Collective over `communicator`; any number of ranks. What each costs is told in
// docs/compositing.md.
struct Scheme {
  const char* name;
  const char* description;
  OwnedPixels (*compose)(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                         const ComposeOptions& options);
  const char* group;  // of schemes that work alike; reports show these in one colour
  bool takes_radices = false;
};

// The table: --list, tests, benchmarks and reports iterate over it.
std::span<const Scheme> schemes();

// As users name it: "tree", and with radices "radix-k:4,2" or "mesh:4x2".
struct SchemeChoice {
  const Scheme* scheme = nullptr;  // null when there is no such scheme
  std::vector<int> radices;
};
SchemeChoice choose_scheme(std::string_view name);
// That of choose_scheme.
const Scheme* find_scheme(std::string_view name);

// The scheme of that name, among those ranks alone that have something: an empty layer's rank owns
// nothing in the end, unless all are empty. Beyond what the scheme costs, an all-reduce of a bit
// per rank and 16 bytes. Collective. All ranks throw std::invalid_argument where there is no such
// scheme, the options cannot be, or ranks differ in them or in the size or kind of their layers.
OwnedPixels compose(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                    std::string_view scheme, ComposeOptions options = {});

// Brings all parts to rank `root`; there the result owns all pixels, elsewhere none. Collective.
// Throws std::invalid_argument for a root that does not exist, and a part without a layer.
OwnedPixels gather(comm::Communicator& communicator, OwnedPixels&& part, int root);

// Pixels that are wanted on a rank.
struct Destination {
  PixelRange range;
  int rank = 0;
};

// Brings pixels of all parts to several ranks, of which each owns in the end what `destinations`
// have for it: tiles of a display to those who show them. They are the same on every rank, in the
// same order; what no destination has is dropped. Otherwise as above.
OwnedPixels gather(comm::Communicator& communicator, OwnedPixels&& part,
                   std::span<const Destination> destinations);

}  // namespace delray::composite
