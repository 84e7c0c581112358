// "Did you mean": the optimal string alignment distance (Damerau 1964, Wagner and Fischer 1974).
// Dynamic programming over prefixes of both names, of which three rows are kept.
#include "files/similar_name.h"

#include <algorithm>
#include <vector>

namespace delray::files {
namespace {

constexpr std::size_t kShortestPrefix = 3;
constexpr std::size_t kLongestName = 64;  // of what people type by mistake

std::string_view only_name_beginning_with(std::string_view prefix,
                                          std::span<const std::string> names) {
  if (prefix.size() < kShortestPrefix) return {};
  std::string_view found;
  for (const std::string& name : names) {
    if (!name.starts_with(prefix)) continue;
    if (!found.empty()) return {};
    found = name;
  }
  return found;
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // row[j]: distance of the first i characters of a to the first j of b.
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(before, last);
    std::swap(last, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, substituted});
      const bool exchanged = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (exchanged) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

std::string_view similar_name(std::string_view name, std::span<const std::string> names) {
  if (name.size() > kLongestName) return {};
  std::string_view nearest;
  std::size_t least = kLongestName;
  for (const std::string& candidate : names) {
    const std::size_t distance = edit_distance(name, candidate);
    const std::size_t allowed = std::max<std::size_t>(1, candidate.size() / 3);
    if (distance >= least || distance > allowed || distance >= candidate.size()) continue;
    least = distance;
    nearest = candidate;
  }
  return nearest.empty() ? only_name_beginning_with(name, names) : nearest;
}

std::string did_you_mean(std::string_view name, std::span<const std::string> names) {
  const std::string_view similar = similar_name(name, names);
  return similar.empty() ? std::string() : "; did you mean '" + std::string(similar) + "'?";
}

}  // namespace delray::files
