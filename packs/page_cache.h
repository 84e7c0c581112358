// Pages in memory, read by threads before they are needed.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <span>
#include <thread>
#include <unordered_map>
#include <vector>

namespace delray::packs {

// What somebody makes of a page, and keeps for as long as it is used.
class CachedPage {
 public:
  virtual ~CachedPage() = default;
  virtual std::uint64_t bytes() const = 0;  // in memory; does not change
};

// Counts since the cache was made.
struct CacheCounts {
  std::uint64_t hits = 0, misses = 0;  // pages that were, and were not, in memory when asked for
  std::uint64_t stalls = 0;            // of the misses those that somebody had to wait for
  double stall_seconds = 0;            // that threads waited, summed over them
  std::uint64_t pages_read = 0, bytes_read = 0;

  CacheCounts operator-(const CacheCounts& before) const;
  void operator+=(const CacheCounts& other);
};

// A cache by least recent use (Correa, Klosowski and Silva 2002, with threads that fetch). What
// somebody holds stays, and counts; what nobody holds goes when there are more bytes than the
// limit. Any thread may call anything.
class PageCache {
 public:
  // Makes a page: reads it. Called by several threads.
  using Make = std::function<std::shared_ptr<const CachedPage>(std::uint32_t page)>;
  // The bytes of a page in its file, for counting.
  using BytesOf = std::function<std::uint64_t(std::uint32_t page)>;

  // REQUIRES: threads >= 0; what is passed outlives the cache.
  PageCache(Make make, BytesOf bytes_of, std::uint64_t limit, int threads);
  ~PageCache();
  PageCache(const PageCache&) = delete;
  PageCache& operator=(const PageCache&) = delete;

  // The page, which stays in memory while the pointer does. One that is not there is made by the
  // calling thread, unless another is about to; throws what making it threw.
  std::shared_ptr<const CachedPage> get(std::uint32_t page);
  // Has the threads make these pages, in this order, unless they are there. What making one of them
  // throws is thrown by who gets it. Without threads nothing happens.
  void prefetch(std::span<const std::uint32_t> pages);
  // Forgets what is not yet begun.
  void cancel();
  // Another limit; takes effect at once.
  void set_limit(std::uint64_t limit);

  CacheCounts counts() const;
  std::uint64_t bytes() const;  // of all pages in memory now

 private:
  struct Entry {
    std::shared_ptr<const CachedPage> page;  // null while somebody makes it
    std::list<std::uint32_t>::iterator use;  // in uses_, once it is there
    bool waiting = false;                    // in the queue, not begun
  };

  void run(const std::stop_token& stop);
  std::shared_ptr<const CachedPage> make(std::uint32_t page, std::unique_lock<std::mutex>& lock);
  bool make_next(std::unique_lock<std::mutex>& lock);
  // What does not fit the limit, and nobody holds.
  using Dropped = std::vector<std::shared_ptr<const CachedPage>>;
  Dropped drop_unused();

  const Make make_;
  const BytesOf bytes_of_;
  mutable std::mutex mutex_;
  std::condition_variable_any queued_;
  std::condition_variable made_;
  std::unordered_map<std::uint32_t, Entry> entries_;
  std::list<std::uint32_t> uses_;  // the least recent first
  std::deque<std::uint32_t> queue_;
  std::uint64_t limit_, bytes_ = 0;
  CacheCounts counts_;
  std::vector<std::jthread> threads_;
};

}  // namespace delray::packs
