// "Did you mean": the known name that a mistyped one comes closest to.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace delray::files {

// Fewest insertions, deletions and substitutions of a character, and exchanges of two neighbours,
// that turn `a` into `b`, no character being changed twice (Damerau 1964; optimal string
// alignment). O(|a| |b|) time, O(|b|) memory.
std::size_t edit_distance(std::string_view a, std::string_view b);

// The name of `names` that is meant by `name`, which is none of them: the one at the least
// distance, the first of several, if that is at most a third of its length, or else the only one
// that begins with `name` (three characters or more). Empty if there is none.
std::string_view similar_name(std::string_view name, std::span<const std::string> names);

// "; did you mean 'render'?", or nothing if no name is similar.
std::string did_you_mean(std::string_view name, std::span<const std::string> names);

}  // namespace delray::files
