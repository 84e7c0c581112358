// Pages in memory.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

namespace delray::packs {

// What somebody makes of a page, and keeps for as long as it is used.
class CachedPage {
 public:
  virtual ~CachedPage() = default;
  virtual std::uint64_t bytes() const = 0;  // in memory; does not change while it is in a cache
};

// Counts since the cache was made.
struct CacheCounts {
  std::uint64_t hits = 0, misses = 0;  // pages that were, and were not, in memory when asked for
  std::uint64_t stalls = 0;            // of the misses those for which the disk was waited for
  double stall_seconds = 0;            // that threads waited, summed over them
  std::uint64_t pages_read = 0, bytes_read = 0;

  CacheCounts operator-(const CacheCounts& before) const;
  void operator+=(const CacheCounts& other);
};

// A cache for those who go through many pages again and again, frame by frame. What somebody holds
// stays, and counts. When there are more bytes than the limit, pages that were not used in this
// frame go, the least recently used ones first; then, as all of the frame do not fit and will be
// asked for in the same order in the next one, those that were used most recently (Chou and DeWitt
// 1985, on loops). Any thread may call anything.
class PageCache {
 public:
  struct Made {
    std::unique_ptr<CachedPage> page;
    double waited = 0;  // seconds for the disk; 0: the system had it in memory
  };
  // Makes a page, by reading it. Called by several threads. `old` is a page that this made before
  // and that nobody has any more, so that its memory can be used again, or null.
  using Make = std::function<Made(std::uint32_t page, std::unique_ptr<CachedPage> old)>;
  // The bytes of a page in its file, for counting.
  using BytesOf = std::function<std::uint64_t(std::uint32_t page)>;

  // A page that stays in memory while this lives, which the cache outlives.
  class Held {
   public:
    Held() = default;
    Held(Held&& other) noexcept { *this = std::move(other); }
    Held& operator=(Held&& other) noexcept {
      std::swap(cache_, other.cache_);
      std::swap(number_, other.number_);
      std::swap(page_, other.page_);
      return *this;
    }
    ~Held() {
      if (cache_ != nullptr) cache_->release(number_);
    }
    const CachedPage& operator*() const { return *page_; }

   private:
    friend class PageCache;
    Held(PageCache& cache, std::uint32_t number, const CachedPage& page)
        : cache_(&cache), number_(number), page_(&page) {}

    PageCache* cache_ = nullptr;
    std::uint32_t number_ = 0;
    const CachedPage* page_ = nullptr;
  };

  // Of pages [0, pages). Takes 24 bytes for each of them, besides those that are there, and the
  // memory of up to sixteen that waits for others.
  //
  // REQUIRES: what is passed outlives the cache.
  PageCache(std::uint32_t pages, Make make, BytesOf bytes_of, std::uint64_t limit);
  PageCache(const PageCache&) = delete;
  PageCache& operator=(const PageCache&) = delete;

  // The page. One that is not there is made by the calling thread, unless another is about to;
  // throws what making it threw.
  Held get(std::uint32_t page);
  // Those of the pages that are neither there nor being made.
  std::vector<std::uint32_t> missing(std::span<const std::uint32_t> pages) const;
  // All pages that are there were not used in this frame.
  void begin_frame();
  // Another limit; takes effect at once.
  void set_limit(std::uint64_t limit);

  CacheCounts counts() const;
  std::uint64_t bytes() const;  // of the pages that are there
  std::uint64_t limit() const;

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  // Entries of pages that are there and that nobody holds are in a list, by when they were given
  // back.
  struct Entry {
    std::unique_ptr<CachedPage> page;
    std::uint32_t before = kNone, after = kNone;
    std::uint32_t frame = 0;  // in which it was given back
    std::uint32_t holders : 31 = 0, being_made : 1 = 0;
  };
  using Dropped = std::vector<std::unique_ptr<CachedPage>>;

  void release(std::uint32_t page);
  void append(std::uint32_t page);
  void take_out(const Entry& entry);
  void make(std::uint32_t page, std::unique_lock<std::mutex>& lock);
  void drop(std::uint32_t page, Dropped& dropped);
  Dropped drop_unused();

  const Make make_;
  const BytesOf bytes_of_;
  mutable std::mutex mutex_;
  std::condition_variable made_;
  std::vector<Entry> entries_;  // by page
  std::uint32_t least_recent_ = kNone, most_recent_ = kNone;
  std::uint32_t frame_ = 0;
  Dropped spare_;  // for the next pages
  std::uint64_t limit_, bytes_ = 0;
  CacheCounts counts_;
};

}  // namespace delray::packs
