// Records on disk by runs of rows, in which they are wanted again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "files/unnamed_file.h"

namespace delray::delaunay::internal {

// Buckets of bytes that grow all at a time: what was added to one is read back as a whole, in no
// certain order of the calls that added it. Each has a block in memory; full ones go to a scratch
// file with their check sums.
class RowBuckets {
 public:
  static constexpr std::size_t kBlockBytes = std::size_t{32} << 10;

  // `folder` is where the file is made, once something has to go there.
  RowBuckets(std::size_t buckets, std::filesystem::path folder);
  ~RowBuckets();
  RowBuckets(const RowBuckets&) = delete;
  RowBuckets& operator=(const RowBuckets&) = delete;

  // Records of one call stay whole and in order. Any thread. Throws FileError (device).
  // REQUIRES: bucket < size().
  void add(std::size_t bucket, std::span<const std::byte> records);

  std::size_t size() const { return buckets_.size(); }
  std::uint64_t bytes(std::size_t bucket) const { return buckets_[bucket].bytes; }
  // All of a bucket, to where there are bytes() of them. Any thread, but not while others add().
  // Throws FileError (device), also where the file is not as it was written.
  void read(std::size_t bucket, std::span<std::byte> records) const;

 private:
  struct Block {
    std::uint64_t offset, bytes, check;
  };
  struct Bucket {
    std::mutex mutex;
    std::uint64_t bytes = 0;  // all told
    std::vector<std::byte> open;
    std::vector<Block> blocks;
  };
  void flush(Bucket& bucket, std::span<const std::byte> block);
  files::UnnamedFile& file();

  std::vector<Bucket> buckets_;
  std::filesystem::path folder_;
  std::mutex mutex_;  // of what follows
  std::unique_ptr<files::UnnamedFile> file_;
  std::uint64_t end_ = 0;
};

}  // namespace delray::delaunay::internal
