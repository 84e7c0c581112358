// Sums of keyed hashes.
#include "delaunay/verify/row_fingerprints.h"

#include <sys/random.h>
#include <xxhash.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>
#include <random>
#include <span>

#include "comm/collectives.h"

namespace delray::delaunay::internal {
namespace {

constexpr int kRangeBits = 12;  // sums stay in the cache; the points of a range fit memory

}  // namespace

RowFingerprints::RowFingerprints(comm::Communicator& communicator, std::uint64_t rows, int first,
                                 int coordinates)
    : rows_(rows),
      shift_(std::max(0, static_cast<int>(std::bit_width(rows)) - kRangeBits)),
      first_(first),
      coordinates_(coordinates) {
  if (::getrandom(secret_.data(), secret_.size(), 0) != static_cast<ssize_t>(secret_.size())) {
    std::random_device device;
    for (std::uint8_t& byte : secret_) byte = static_cast<std::uint8_t>(device());
  }
  const comm::Buffer shared = comm::broadcast(communicator, 0, comm::Buffer::of_value(secret_));
  std::memcpy(secret_.data(), shared.data(), secret_.size());
  mesh_.resize((rows >> shift_) + 1);
  points_.resize(mesh_.size());
}

void RowFingerprints::add(std::vector<Sum>& sums, const RowPoint& point) const {
  struct {
    std::uint64_t row;
    double place[3];
  } pair{point.row, {}};
  for (int k = 0; k < coordinates_; ++k) pair.place[k] = point.position[first_ + k] + 0.0;  // -0
  const XXH128_hash_t hash =
      XXH3_128bits_withSecret(&pair, sizeof pair, secret_.data(), secret_.size());
  Sum& sum = sums[point.row >> shift_];
  std::atomic_ref(sum.low).fetch_add(hash.low64, std::memory_order_relaxed);
  std::atomic_ref(sum.high).fetch_add(hash.high64, std::memory_order_relaxed);
}

void RowFingerprints::add_up(comm::Communicator& communicator) {
  for (std::vector<Sum>* const sums : {&mesh_, &points_}) {
    comm::all_reduce(communicator, std::span(*sums), [](const Sum& a, const Sum& b) {
      return Sum{a.low + b.low, a.high + b.high};
    });
  }
}

std::optional<RowFingerprints::Range> RowFingerprints::first_difference() const {
  for (std::size_t i = 0; i < mesh_.size(); ++i) {
    if (mesh_[i].low == points_[i].low && mesh_[i].high == points_[i].high) continue;
    const std::uint64_t first = static_cast<std::uint64_t>(i) << shift_;
    return Range{first, std::min(rows_, first + (std::uint64_t{1} << shift_))};
  }
  return std::nullopt;
}

bool RowMarks::mark(std::uint64_t row) {
  const std::uint64_t bit = std::uint64_t{1} << row % 64;
  return (std::atomic_ref(words_[row / 64]).fetch_or(bit, std::memory_order_relaxed) & bit) == 0;
}

std::optional<std::uint64_t> RowMarks::next(std::uint64_t row) const {
  std::size_t word = row / 64;
  if (word >= words_.size()) return std::nullopt;
  std::uint64_t bits = words_[word] >> row % 64 << row % 64;
  while (bits == 0) {
    if (++word == words_.size()) return std::nullopt;
    bits = words_[word];
  }
  return word * 64 + static_cast<std::uint64_t>(std::countr_zero(bits));
}

std::vector<std::uint64_t> RowMarks::words(std::uint64_t first, std::uint64_t last) const {
  if (first >= last) return {};
  std::vector<std::uint64_t> some(words_.begin() + static_cast<std::ptrdiff_t>(first / 64),
                                  words_.begin() + static_cast<std::ptrdiff_t>((last + 63) / 64));
  some.front() = some.front() >> first % 64 << first % 64;
  if (last % 64 != 0) some.back() &= (std::uint64_t{1} << last % 64) - 1;
  return some;
}

std::optional<std::uint64_t> RowMarks::merge(std::uint64_t first,
                                             std::span<const std::uint64_t> words) {
  std::optional<std::uint64_t> twice;
  for (std::size_t i = 0; i < words.size(); ++i) {
    std::uint64_t& mine = words_[first / 64 + i];
    if (const std::uint64_t both = mine & words[i]; both != 0 && !twice) {
      twice = (first / 64 + i) * 64 + static_cast<std::uint64_t>(std::countr_zero(both));
    }
    mine |= words[i];
  }
  return twice;
}

void RowMarks::keep(std::uint64_t first, std::uint64_t last) {
  const std::vector<std::uint64_t> kept = words(first, last);
  std::ranges::fill(words_, 0);
  merge(first, kept);
}

}  // namespace delray::delaunay::internal
