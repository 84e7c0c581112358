// Marks the vertices that the triangles use in a set of bits, whose sums give them new numbers.
#include "scenes/parts/read_run.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <vector>

#include "parallel/grow.h"
#include "parallel/parallel_for.h"

namespace delray::scenes::internal {
namespace {

constexpr std::size_t kRunGrain = 1 << 14;  // triangles: tens of microseconds

// A set of numbers from `begin` on, and how many of them are smaller than one.
class NumberSet {
 public:
  // Of the corners of triangles.
  explicit NumberSet(std::span<const glm::uvec3> triangles) {
    struct Range {
      std::uint32_t low = kNone, high = 0;
    };
    const Range range = parallel::parallel_reduce(
        0, triangles.size(), kRunGrain, Range{},
        [&](std::size_t first, std::size_t last) {
          Range r;
          for (const glm::uvec3& t : triangles.subspan(first, last - first)) {
            r.low = std::min({r.low, t.x, t.y, t.z});
            r.high = std::max({r.high, t.x, t.y, t.z});
          }
          return r;
        },
        [](const Range& a, const Range& b) {
          return Range{std::min(a.low, b.low), std::max(a.high, b.high)};
        });
    if (triangles.empty()) return;
    begin_ = range.low / kBits * kBits;
    words_.resize((range.high - begin_) / kBits + 1);
    parallel::parallel_for(0, triangles.size(), kRunGrain, [&](std::size_t t) {
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t i = triangles[t][k] - begin_;
        const std::uint64_t bit = std::uint64_t{1} << i % kBits;
        std::atomic_ref<std::uint64_t> word(words_[i / kBits]);
        // Most vertices have been marked by another triangle.
        if ((word.load(std::memory_order_relaxed) & bit) == 0)
          word.fetch_or(bit, std::memory_order_relaxed);
      }
    });
    before_.resize(words_.size() + 1, 0);
    for (std::size_t w = 0; w < words_.size(); ++w) {
      before_[w + 1] = before_[w] + static_cast<std::uint32_t>(std::popcount(words_[w]));
    }
  }

  static constexpr std::uint32_t kBits = 64;
  std::uint64_t size() const { return before_.empty() ? 0 : before_.back(); }
  std::uint64_t words() const { return words_.size(); }
  // The number of those before `i`, which is one.
  std::uint32_t rank(std::uint32_t i) const {
    const std::uint32_t at = i - begin_;
    const std::uint64_t below = words_[at / kBits] & ((std::uint64_t{1} << at % kBits) - 1);
    return before_[at / kBits] + static_cast<std::uint32_t>(std::popcount(below));
  }
  // Calls f(i) for those of words [first, last), ascending.
  template <class F>
  void for_each(std::size_t first, std::size_t last, F&& f) const {
    for (std::size_t w = first; w < last; ++w) {
      for (std::uint64_t left = words_[w]; left != 0; left &= left - 1) {
        f(begin_ + static_cast<std::uint32_t>(w * kBits) +
          static_cast<std::uint32_t>(std::countr_zero(left)));
      }
    }
  }

 private:
  std::uint32_t begin_ = 0;
  std::vector<std::uint64_t> words_;
  std::vector<std::uint32_t> before_;  // how many there are before a word
};

}  // namespace

bool read_run(const Source& source, const TriangleFile& file, std::uint64_t begin,
              std::uint64_t end, Mesh& mesh) {
  constexpr std::size_t kWordsPerBlock = 1 << 8;  // vertices of a block: some hundred kilobytes
  source.require_memory((end - begin) * sizeof(glm::uvec3));
  parallel::grow(mesh.triangles, end - begin);
  if (!file.read_triangles(begin, mesh.triangles)) return false;
  const NumberSet used(mesh.triangles);
  const Mesh first = file.read_vertices(0, std::min<std::uint64_t>(1, file.vertices()));
  for_each_attribute(first, mesh, [&](const auto& has, auto& values) {
    source.require_memory(has.empty() ? 0 : used.size() * sizeof(values[0]));
    if (!has.empty()) parallel::grow(values, used.size());
  });
  parallel::parallel_blocks(
      0, used.words(), kWordsPerBlock, [&](std::size_t word, std::size_t end_word) {
        std::uint32_t low = kNone, high = 0;
        used.for_each(word, end_word, [&](std::uint32_t i) {
          low = std::min(low, i);
          high = i;
        });
        if (low == kNone) return;
        const Mesh block = file.read_vertices(low, std::uint64_t{high} + 1);
        for_each_attribute(block, mesh, [&](const auto& from, auto& to) {
          if (from.empty()) return;
          std::uint32_t next = used.rank(low);
          used.for_each(word, end_word, [&](std::uint32_t i) { to[next++] = from[i - low]; });
        });
      });
  parallel::parallel_for(0, mesh.triangles.size(), kRunGrain, [&](std::size_t t) {
    glm::uvec3& v = mesh.triangles[t];
    v = {used.rank(v.x), used.rank(v.y), used.rank(v.z)};
  });
  return true;
}

}  // namespace delray::scenes::internal
