// Groups the rows by place with a hash and applies the policy to the few places that have several
// rows.
#include "delaunay/duplicates.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <unordered_map>

#include "delaunay/mesh/equal_points.h"

namespace delray::delaunay {
namespace {

constexpr std::array kPolicies = {
    DuplicatesName{"first", "the z of the first row", Duplicates::first},
    DuplicatesName{"min", "the lowest z", Duplicates::min},
    DuplicatesName{"max", "the highest z", Duplicates::max},
    DuplicatesName{"mean", "the mean z", Duplicates::mean},
};

// The heights at one place.
struct Heights {
  double low, high, mean;
  std::size_t rows;
};

double choose(const Heights& heights, double first, Duplicates policy) {
  switch (policy) {
    case Duplicates::min:
      return heights.low;
    case Duplicates::max:
      return heights.high;
    case Duplicates::mean:
      return std::clamp(heights.mean, heights.low, heights.high);
    case Duplicates::first:
      break;
  }
  return first;
}

}  // namespace

std::span<const DuplicatesName> duplicates_policies() { return kPolicies; }

std::optional<Duplicates> duplicates_policy(std::string_view name) {
  const auto found = std::ranges::find(kPolicies, name, &DuplicatesName::name);
  if (found == kPolicies.end()) return std::nullopt;
  return found->policy;
}

DuplicatesCount merge_duplicates(PointCloud& cloud, Duplicates policy) {
  if (!cloud.has_z) return {};
  const std::vector<std::uint32_t> lowest = lowest_equal_rows(view(cloud.positions), 2);
  // Only rows that are not the lowest of their place come here: few, or the file is unusual.
  std::unordered_map<std::uint32_t, Heights> places;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (lowest[i] == i) continue;
    const double first = cloud.positions[lowest[i]].z, z = cloud.positions[i].z;
    Heights& heights = places.try_emplace(lowest[i], Heights{first, first, first, 1}).first->second;
    heights.low = std::min(heights.low, z);
    heights.high = std::max(heights.high, z);
    // A running mean cannot overflow where its heights do not.
    heights.rows += 1;
    const auto rows = static_cast<double>(heights.rows);
    heights.mean += z / rows - heights.mean / rows;
  }
  DuplicatesCount count;
  for (const auto& [row, heights] : places) {
    if (heights.low == heights.high) continue;
    count.places += 1;
    count.rows += heights.rows;
    double& z = cloud.positions[row].z;
    z = choose(heights, z, policy);
  }
  return count;
}

}  // namespace delray::delaunay
