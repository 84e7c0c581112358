// A cloud in memory as parts.
#pragma once

#include <algorithm>

#include "delaunay/point_parts.h"

namespace delray::delaunay {

// Runs of rows; attributes other than positions are left out. The cloud outlives it.
class CloudParts final : public PointParts {
 public:
  static constexpr std::size_t kRows = std::size_t{1} << 18;  // a few megabytes

  // REQUIRES: rows >= 1.
  explicit CloudParts(const PointCloud& cloud, std::size_t rows = kRows)
      : cloud_(cloud), rows_(rows) {}

  std::size_t parts() const override { return (cloud_.size() + rows_ - 1) / rows_; }
  std::uint64_t most_rows(std::size_t part) const override {
    return std::min(rows_, cloud_.size() - part * rows_);
  }
  void read(std::size_t part, PointCloud& points) const override {
    const auto first = cloud_.positions.begin() + static_cast<std::ptrdiff_t>(part * rows_);
    points.has_z = cloud_.has_z;
    points.geographic = cloud_.geographic;
    points.positions.assign(first, first + static_cast<std::ptrdiff_t>(most_rows(part)));
  }

 private:
  const PointCloud& cloud_;
  std::size_t rows_;
};

}  // namespace delray::delaunay
