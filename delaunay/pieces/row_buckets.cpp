// A block goes to the end of the file, which all buckets share, as soon as it is full.
#include "delaunay/pieces/row_buckets.h"

#include <xxhash.h>

#include <algorithm>
#include <utility>

#include "files/error.h"

namespace delray::delaunay::internal {
namespace {

std::uint64_t check_of(std::span<const std::byte> block) {
  return XXH3_64bits(block.data(), block.size());
}

}  // namespace

RowBuckets::RowBuckets(std::size_t buckets, std::filesystem::path folder)
    : buckets_(buckets), folder_(std::move(folder)) {}
RowBuckets::~RowBuckets() = default;

files::UnnamedFile& RowBuckets::file() {
  if (!file_) file_ = std::make_unique<files::UnnamedFile>(folder_, "scratch file of the mesh");
  return *file_;
}

void RowBuckets::add(std::size_t number, std::span<const std::byte> records) {
  Bucket& bucket = buckets_[number];
  const std::lock_guard lock(bucket.mutex);
  bucket.bytes += records.size();
  if (bucket.open.size() + records.size() > kBlockBytes) {
    flush(bucket, bucket.open);
    bucket.open.clear();
  }
  if (records.size() > kBlockBytes) return flush(bucket, records);
  bucket.open.reserve(kBlockBytes);
  bucket.open.insert(bucket.open.end(), records.begin(), records.end());
}

void RowBuckets::flush(Bucket& bucket, std::span<const std::byte> block) {
  if (block.empty()) return;
  std::uint64_t offset = 0;
  const files::UnnamedFile* to = nullptr;
  {
    const std::lock_guard lock(mutex_);
    to = &file();
    offset = std::exchange(end_, end_ + block.size());
  }
  to->write(offset, block);
  bucket.blocks.push_back({offset, block.size(), check_of(block)});
}

void RowBuckets::read(std::size_t number, std::span<std::byte> records) const {
  const Bucket& bucket = buckets_[number];
  for (const Block& block : bucket.blocks) {
    file_->read(block.offset, records.first(block.bytes));
    if (check_of(records.first(block.bytes)) != block.check) {
      throw files::FileError(files::Cause::device, folder_.string(), "scratch file of the mesh",
                             "is not as it was written");
    }
    records = records.subspan(block.bytes);
  }
  std::ranges::copy(bucket.open, records.begin());
}

}  // namespace delray::delaunay::internal
