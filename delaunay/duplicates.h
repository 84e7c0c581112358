// Points with equal x and y but different z, which a triangulation of a terrain cannot keep apart.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "delaunay/points.h"

namespace delray::delaunay {

// Which z a place gets that several points of different z share.
enum class Duplicates { first, min, max, mean };  // which z the place gets

// An entry of the table of policies for such places.
struct DuplicatesName {
  std::string_view name;
  std::string_view description;
  Duplicates policy;
};
std::span<const DuplicatesName> duplicates_policies();
std::optional<Duplicates> duplicates_policy(std::string_view name);  // none for an unknown name

// Numbers of places and rows that duplicates concern.
struct DuplicatesCount {
  std::size_t places = 0;  // (x, y) with more than one z
  std::size_t rows = 0;    // rows that stand at such places
};

// Gives the lowest row of each place (x, y) the first, lowest, highest or mean z of all its rows.
// No other row and no other attribute changes, so rows keep their numbers; by the rule that the
// lowest row represents equal points, a 2D triangulation then uses that z. -0 equals 0. Without z
// nothing happens. O(n) expected.
DuplicatesCount merge_duplicates(PointCloud& cloud, Duplicates policy);

}  // namespace delray::delaunay
