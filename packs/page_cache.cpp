// An entry for each page, those that are there and not held in a list, under one lock, which nobody
// has while he makes or frees a page.
//
// Who needs a page makes it, and there are no threads for it: what is read by one thread and drawn
// by another goes through memory in between, and threads that sleep and wake for every page cost as
// much as reading it. The disk is kept busy by the system, which is told what will be needed. The
// memory of pages that go is used for those that come: a page takes a dozen blocks of the heap, and
// to free what other threads have allocated costs more than to unpack it.
//
// Degenerate: where more is held than the limit allows nothing is dropped until it is given back; a
// page that cannot be made is forgotten, so that who asks next tries again.
#include "packs/page_cache.h"

#include <iterator>

namespace delray::packs {
namespace {

constexpr std::size_t kSpares = 16;  // about as many as there are threads that make pages

}  // namespace

CacheCounts CacheCounts::operator-(const CacheCounts& before) const {
  return {hits - before.hits,
          misses - before.misses,
          stalls - before.stalls,
          stall_seconds - before.stall_seconds,
          pages_read - before.pages_read,
          bytes_read - before.bytes_read};
}

void CacheCounts::operator+=(const CacheCounts& other) {
  hits += other.hits;
  misses += other.misses;
  stalls += other.stalls;
  stall_seconds += other.stall_seconds;
  pages_read += other.pages_read;
  bytes_read += other.bytes_read;
}

PageCache::PageCache(std::uint32_t pages, Make make, BytesOf bytes_of, std::uint64_t limit)
    : make_(std::move(make)), bytes_of_(std::move(bytes_of)), entries_(pages), limit_(limit) {}

PageCache::Held PageCache::get(std::uint32_t page) {
  std::unique_lock lock(mutex_);
  Entry& entry = entries_[page];
  ++(entry.page != nullptr ? counts_.hits : counts_.misses);
  // If he who makes it cannot, somebody else may try.
  while (entry.being_made) made_.wait(lock);
  if (entry.page == nullptr) {
    make(page, lock);
  } else if (entry.holders == 0) {
    take_out(entry);
  }
  ++entry.holders;
  return {*this, page, *entry.page};
}

void PageCache::release(std::uint32_t page) {
  Dropped dropped;  // freed after the lock
  const std::lock_guard lock(mutex_);
  if (--entries_[page].holders > 0) return;
  append(page);
  dropped = drop_unused();
}

std::vector<std::uint32_t> PageCache::missing(std::span<const std::uint32_t> pages) const {
  std::vector<std::uint32_t> result;
  const std::lock_guard lock(mutex_);
  for (const std::uint32_t page : pages)
    if (entries_[page].page == nullptr && !entries_[page].being_made) result.push_back(page);
  return result;
}

void PageCache::begin_frame() {
  const std::lock_guard lock(mutex_);
  ++frame_;
}

void PageCache::set_limit(std::uint64_t limit) {
  Dropped dropped;  // freed after the lock
  const std::lock_guard lock(mutex_);
  limit_ = limit;
  dropped = drop_unused();
  dropped.insert(dropped.end(), std::make_move_iterator(spare_.begin()),
                 std::make_move_iterator(spare_.end()));
  spare_.clear();
}

CacheCounts PageCache::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

std::uint64_t PageCache::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

std::uint64_t PageCache::limit() const {
  const std::lock_guard lock(mutex_);
  return limit_;
}

// To the list, as given back now.
void PageCache::append(std::uint32_t page) {
  Entry& entry = entries_[page];
  entry.frame = frame_;
  entry.before = most_recent_;
  entry.after = kNone;
  (most_recent_ != kNone ? entries_[most_recent_].after : least_recent_) = page;
  most_recent_ = page;
}

void PageCache::take_out(const Entry& entry) {
  (entry.before != kNone ? entries_[entry.before].after : least_recent_) = entry.after;
  (entry.after != kNone ? entries_[entry.after].before : most_recent_) = entry.before;
}

// With the lock, which it gives up meanwhile. The page is not in the list.
void PageCache::make(std::uint32_t page, std::unique_lock<std::mutex>& lock) {
  Entry& entry = entries_[page];
  entry.being_made = 1;
  std::unique_ptr<CachedPage> old;
  if (!spare_.empty()) {
    old = std::move(spare_.back());
    spare_.pop_back();
  }
  lock.unlock();
  Made made;
  try {
    made = make_(page, std::move(old));
  } catch (...) {
    lock.lock();
    entry.being_made = 0;
    made_.notify_all();
    throw;
  }
  Dropped dropped;
  lock.lock();
  entry.being_made = 0;
  entry.page = std::move(made.page);
  bytes_ += entry.page->bytes();
  ++counts_.pages_read;
  counts_.bytes_read += bytes_of_(page);
  if (made.waited > 0) {
    ++counts_.stalls;
    counts_.stall_seconds += made.waited;
  }
  ++entry.holders;  // so that it stays while there is no lock
  dropped = drop_unused();
  if (!dropped.empty()) {
    lock.unlock();
    dropped.clear();
    lock.lock();
  }
  --entry.holders;
  made_.notify_all();
}

void PageCache::drop(std::uint32_t page, Dropped& dropped) {
  Entry& entry = entries_[page];
  bytes_ -= entry.page->bytes();
  (spare_.size() < kSpares ? spare_ : dropped).push_back(std::move(entry.page));
  take_out(entry);
}

// What does not fit the limit, and nobody holds; some of it is kept for its memory.
PageCache::Dropped PageCache::drop_unused() {
  Dropped dropped;
  while (bytes_ > limit_ && least_recent_ != kNone && entries_[least_recent_].frame != frame_)
    drop(least_recent_, dropped);
  while (bytes_ > limit_ && most_recent_ != kNone) drop(most_recent_, dropped);
  return dropped;
}

}  // namespace delray::packs
