// Points on disk, in buckets along a curve.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <mutex>
#include <span>
#include <vector>

#include "files/unnamed_file.h"

namespace delray::apps {

// A point of a scene, and what its colour is made of.
struct BucketPoint {
  glm::vec3 position;
  std::uint32_t row;
  std::uint32_t value;
};

// Points go to the bucket of their place along a curve, on disk in blocks.
class PointBuckets {
 public:
  // In a file without a name in the folder; `begins` are the places where buckets after the first
  // begin, ascending. Throws FileError (device), as all of it does.
  PointBuckets(const std::filesystem::path& folder, std::vector<std::uint64_t> begins);

  // Any thread. `places` has one for each point.
  void add(std::span<const BucketPoint> points, std::span<const std::uint64_t> places);

  std::size_t size() const { return buckets_.size(); }
  std::uint64_t points(std::size_t bucket) const { return buckets_[bucket].count; }
  // The points of a bucket in any order, after the last add().
  std::vector<BucketPoint> read(std::size_t bucket) const;

  static constexpr std::size_t kBlock = 2048;  // points: 40 KB, of which each bucket has one

 private:
  struct Bucket {
    std::vector<BucketPoint> last;      // not on disk yet
    std::vector<std::uint64_t> blocks;  // numbers of them in the file, each full
    std::uint64_t count = 0;
  };
  void append(Bucket& bucket, std::span<const BucketPoint> points);

  files::UnnamedFile file_;
  const std::vector<std::uint64_t> begins_;
  std::mutex mutex_;
  std::vector<Bucket> buckets_;
  std::uint64_t blocks_ = 0;
};

}  // namespace delray::apps
