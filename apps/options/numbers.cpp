// Validators for CLI11, all of one template that rejects text that is no finite number.
#include "apps/options/numbers.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "files/parse_count.h"
#include "image/image.h"
#include "loadbalance/cache_block.h"

namespace delray::apps {
namespace {

// `fits` is only asked about finite numbers.
template <class Fits>
CLI::Validator numbers(Fits&& fits, const std::string& range, const std::string& shown) {
  const auto check = [fits, range](std::string& text) {
    double value = 0;
    const bool fine = CLI::detail::lexical_cast(text, value) && std::isfinite(value) && fits(value);
    return fine ? std::string() : fmt::format("'{}' is not a number {}", text, range);
  };
  return CLI::Validator(check, shown);
}

}  // namespace

CLI::Validator positive_number() {
  return numbers([](double value) { return value > 0.0; }, "above 0", "above 0");
}

CLI::Validator positive_float() {
  using Limits = std::numeric_limits<float>;
  constexpr double kLeast = Limits::min(), kMost = Limits::max();
  return numbers([](double value) { return kLeast <= value && value <= kMost; },
                 fmt::format("from {:.2g} to {:.2g}", kLeast, kMost), "above 0");
}

CLI::Validator non_negative_number() {
  return numbers([](double value) { return value >= 0.0; }, "from 0 on", "0 or more");
}

CLI::Validator number_between(double least, double most) {
  return numbers([least, most](double value) { return least <= value && value <= most; },
                 fmt::format("from {} to {}", least, most), fmt::format("{} to {}", least, most));
}

CLI::Validator count_between(std::uint64_t least, std::uint64_t most) {
  const auto check = [least, most](std::string& text) {
    try {
      const std::uint64_t count = files::parse_count(text);
      if (count < least || count > most)
        return fmt::format("'{}' is not from {} to {}", text, least, most);
      text = std::to_string(count);
      return std::string();
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
  };
  return CLI::Validator(check, fmt::format("{} to {}", least, most));
}

CLI::Validator block_side() {
  constexpr int kMost = 4096;
  const auto check = [](std::string& text) {
    if (text != "cache") return count_between(1, kMost)(text);
    const int side = loadbalance::cache_block_side(
        loadbalance::first_level_cache(), sizeof(image::RgbaF) + sizeof(float), sizeof(float));
    text = std::to_string(side < kMost ? side : kMost);
    return std::string();
  };
  return CLI::Validator(check, "1 to 4096, or cache");
}

CLI::Validator any_count() {
  CLI::Validator count = count_between(0, std::numeric_limits<std::uint64_t>::max());
  return count.description("");
}

}  // namespace delray::apps
