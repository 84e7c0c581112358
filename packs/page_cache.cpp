// Entries in a table, their uses in a list, and a queue that threads take pages from.
//
// A page is in one of three states: waiting in the queue, being made by one thread, or there.
// Whoever needs one that waits makes it himself rather than wait for a thread to come to it, and
// while another makes it he makes the next ones in the queue: threads that sleep and wake for every
// page cost as much as reading it. Pages are dropped outside of the lock, as that takes long, too.
//
// Degenerate: where more is held than the limit allows nothing is dropped until it is given back; a
// page that cannot be made is forgotten, so that who asks next tries again.
#include "packs/page_cache.h"

#include <algorithm>
#include <chrono>

namespace delray::packs {
namespace {

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

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

PageCache::PageCache(Make make, BytesOf bytes_of, std::uint64_t limit, int threads)
    : make_(std::move(make)), bytes_of_(std::move(bytes_of)), limit_(limit) {
  for (int i = 0; i < threads; ++i)
    threads_.emplace_back([this](const std::stop_token& stop) { run(stop); });
}

PageCache::~PageCache() {
  cancel();
  for (std::jthread& thread : threads_) thread.request_stop();
}

std::shared_ptr<const CachedPage> PageCache::get(std::uint32_t page) {
  std::unique_lock lock(mutex_);
  const auto found = entries_.find(page);
  if (found != entries_.end() && found->second.page != nullptr) {
    ++counts_.hits;
    uses_.splice(uses_.end(), uses_, found->second.use);
    return found->second.page;
  }
  ++counts_.misses;
  ++counts_.stalls;
  const auto begin = std::chrono::steady_clock::now();
  for (;;) {
    const auto entry = entries_.find(page);
    if (entry == entries_.end() || entry->second.waiting) {
      std::shared_ptr<const CachedPage> made = make(page, lock);
      counts_.stall_seconds += seconds_since(begin);
      return made;
    }
    if (entry->second.page != nullptr) {
      counts_.stall_seconds += seconds_since(begin);
      uses_.splice(uses_.end(), uses_, entry->second.use);
      return entry->second.page;
    }
    if (!make_next(lock)) made_.wait(lock);
  }
}

void PageCache::prefetch(std::span<const std::uint32_t> pages) {
  if (threads_.empty()) return;
  const std::lock_guard lock(mutex_);
  std::size_t fresh = 0;
  for (const std::uint32_t page : pages) {
    const auto [entry, is_new] = entries_.try_emplace(page);
    if (!is_new) continue;
    entry->second.waiting = true;
    queue_.push_back(page);
    ++fresh;
  }
  if (fresh == 1)
    queued_.notify_one();
  else if (fresh > 1)
    queued_.notify_all();
}

void PageCache::cancel() {
  const std::lock_guard lock(mutex_);
  for (const std::uint32_t page : queue_) {
    const auto entry = entries_.find(page);
    if (entry != entries_.end() && entry->second.waiting) entries_.erase(entry);
  }
  queue_.clear();
}

void PageCache::set_limit(std::uint64_t limit) {
  Dropped dropped;  // after the lock
  const std::lock_guard lock(mutex_);
  limit_ = limit;
  dropped = drop_unused();
}

CacheCounts PageCache::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

std::uint64_t PageCache::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

void PageCache::run(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  for (;;) {
    if (!queued_.wait(lock, stop, [this] { return !queue_.empty(); })) return;
    make_next(lock);
  }
}

// The first page that waits in the queue; false: none does.
bool PageCache::make_next(std::unique_lock<std::mutex>& lock) {
  while (!queue_.empty()) {
    const std::uint32_t page = queue_.front();
    queue_.pop_front();
    const auto entry = entries_.find(page);
    if (entry == entries_.end() || !entry->second.waiting) continue;  // somebody made it already
    try {
      make(page, lock);
    } catch (...) {  // who gets it makes it again, and is told
    }
    return true;
  }
  return false;
}

// With the lock, which it gives up meanwhile.
std::shared_ptr<const CachedPage> PageCache::make(std::uint32_t page,
                                                  std::unique_lock<std::mutex>& lock) {
  entries_[page].waiting = false;
  lock.unlock();
  std::shared_ptr<const CachedPage> made;
  try {
    made = make_(page);
  } catch (...) {
    lock.lock();
    entries_.erase(page);
    made_.notify_all();
    throw;
  }
  lock.lock();
  Entry& entry = entries_[page];
  entry.page = made;
  entry.use = uses_.insert(uses_.end(), page);
  bytes_ += made->bytes();
  ++counts_.pages_read;
  counts_.bytes_read += bytes_of_(page);
  Dropped dropped = drop_unused();
  made_.notify_all();
  if (!dropped.empty()) {
    lock.unlock();
    dropped = {};
    lock.lock();
  }
  return made;
}

PageCache::Dropped PageCache::drop_unused() {
  Dropped dropped;
  for (auto use = uses_.begin(); bytes_ > limit_ && use != uses_.end();) {
    const auto entry = entries_.find(*use);
    if (entry->second.page.use_count() > 1) {
      ++use;
      continue;
    }
    bytes_ -= entry->second.page->bytes();
    dropped.push_back(std::move(entry->second.page));
    entries_.erase(entry);
    use = uses_.erase(use);
  }
  return dropped;
}

}  // namespace delray::packs
