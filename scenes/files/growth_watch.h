// Lists that grow while a file is read.
#pragma once

#include <cstdint>

#include "files/memory_budget.h"
#include "scenes/files/source.h"

namespace delray::scenes::internal {

// Asks, before lists may grow to twice their size, for as much memory as they have taken since the
// watch began. For readers that know no counts beforehand.
class GrowthWatch {
 public:
  explicit GrowthWatch(const Source& source) : source_(source) {}

  // To be called for every line, corner or value that may make something longer.
  void step() {
    constexpr std::uint32_t kSteps = 1U << 16;  // looking takes as long as some hundred lines
    if (++steps_ % kSteps == 0) look();
  }

 private:
  void look() const {
    const std::uint64_t now = files::resident_set();
    if (now > before_) source_.require_memory(now - before_);
  }

  const Source& source_;
  std::uint64_t before_ = files::resident_set();
  std::uint32_t steps_ = 0;
};

}  // namespace delray::scenes::internal
