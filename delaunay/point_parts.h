// Points in parts that any thread may read in any order: inputs that memory need not hold.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "delaunay/points.h"

namespace delray::delaunay {

// Parts are byte ranges of text, chunks of LAZ, runs of rows of binary files. Rows are those of
// read_points() over the whole input: the points of part i follow those of part i - 1. How many
// points a part has is known once it has been read, as filters and empty lines leave some out.
class PointParts {
 public:
  virtual ~PointParts() = default;
  virtual std::size_t parts() const = 0;
  // Whether points have heights, where that is known without reading them.
  virtual std::optional<bool> has_z() const { return std::nullopt; }
  // At least as many as read() gives: a bound for memory, not far off. REQUIRES: part < parts().
  virtual std::uint64_t most_rows(std::size_t part) const = 0;
  // Replaces `points` by those of the part, in the order of the input. Any thread, again and again,
  // with equal results. Throws files::FileError, naming file and place. REQUIRES: part < parts().
  virtual void read(std::size_t part, PointCloud& points) const = 0;
};

// A cloud in memory as parts: runs of rows; attributes other than positions are left out. The cloud
// outlives it.
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
