// Deep layers: all surfaces seen at a pixel travel, and whoever owns the pixel in the end blends
// them once, in one order, so that the picture does not depend on who composited what.
#pragma once

#include <cassert>
#include <cstring>
#include <memory>
#include <utility>

#include "comm/bad_message.h"
#include "composite/coverage.h"
#include "composite/deep_image.h"
#include "composite/layer.h"

namespace delray::composite {

// A message has the coverage of the range (see Coverage), then a u32 for each covered pixel, the
// number of its fragments, then the fragments as they are. Fragments, not pixels, count as
// composited: those that merge() compares. Which side a message comes from makes no difference.
//
// encode, merge and replace run in the caller's arena.
template <class Payload>
class DeepLayer final : public Layer {
 public:
  explicit DeepLayer(DeepImage<Payload>&& image) : image_(std::move(image)) {}

  DeepImage<Payload>& image() { return image_; }
  const DeepImage<Payload>& image() const { return image_; }

  std::uint64_t pixels() const override { return image_.lists.size(); }
  comm::Buffer encode(PixelRange range) override;
  std::uint64_t merge(PixelRange range, const comm::Buffer& pixels, Side from) override;
  void replace(PixelRange range, const comm::Buffer& pixels) override;
  bool empty() const override;

 private:
  struct Arrived;
  // Nothing of the other list is seen behind this one.
  static bool hides(std::span<const DeepFragment<Payload>> list,
                    std::span<const DeepFragment<Payload>> other) {
    return !list.empty() && is_opaque(list.back().payload) && in_front(list.back(), other.front());
  }
  // The fragments of `own` and `arrived` in order, up to the first opaque one.
  static void merge_lists(std::span<const DeepFragment<Payload>> own,
                          std::span<const DeepFragment<Payload>> arrived,
                          std::vector<DeepFragment<Payload>>& merged);
  struct Merged {
    std::uint64_t composited = 0, abandoned = 0;  // fragments: compared; whose memory is unused now
  };
  Merged merge_group(PixelRange range, const Arrived& arrived, std::size_t group,
                     std::size_t chunk);
  void abandon(std::uint64_t fragments);

  DeepImage<Payload> image_;
  std::uint64_t abandoned_ = 0;  // fragments in chunks that no pixel has
};

template <class Payload>
std::unique_ptr<Layer> make_deep(DeepImage<Payload>&& image) {
  return std::make_unique<DeepLayer<Payload>>(std::move(image));
}

// The image of a part that began as make_deep; only the part's ranges of it are final.
//
// REQUIRES: the part's layer is a DeepLayer<Payload>.
template <class Payload>
DeepImage<Payload> take_deep(OwnedPixels&& part) {
  return std::move(dynamic_cast<DeepLayer<Payload>&>(*part.layer).image());
}

extern template class DeepLayer<image::RgbaF>;

// ---

// The parts of a message that encode() wrote.
template <class Payload>
struct DeepLayer<Payload>::Arrived {
  Coverage coverage;
  const std::uint32_t* sizes;  // of the covered pixels
  const DeepFragment<Payload>* fragments;
  std::vector<std::uint64_t> before;  // fragments before each group

  Arrived(PixelRange range, const comm::Buffer& message)
      : coverage(range.size(), {message.data(), message.size()}), before(coverage.groups() + 1) {
    const std::byte* const after = message.data() + coverage.encoded_bytes();
    const std::size_t rest = message.size() - coverage.encoded_bytes();
    const std::size_t bytes_of_sizes = coverage.covered() * sizeof(std::uint32_t);
    comm::check_message(rest >= bytes_of_sizes);
    sizes = reinterpret_cast<const std::uint32_t*>(after);
    fragments = reinterpret_cast<const DeepFragment<Payload>*>(after + coverage.covered() *
                                                                           sizeof(std::uint32_t));
    parallel::parallel_for(0, coverage.groups(), 1, [&](std::size_t i) {
      const Coverage::Group at = coverage.group(i);
      for (std::uint64_t k = 0; k < at.covered; ++k) {
        comm::check_message(sizes[at.covered_before + k] > 0);
        before[i + 1] += sizes[at.covered_before + k];
      }
    });
    for (std::size_t i = 1; i < before.size(); ++i) before[i] += before[i - 1];
    comm::check_message(rest == bytes_of_sizes + before.back() * sizeof(DeepFragment<Payload>));
  }
};

template <class Payload>
comm::Buffer DeepLayer<Payload>::encode(PixelRange range) {
  assert(range.begin <= range.end && range.end <= pixels());
  std::vector<std::uint64_t> before((range.size() + kGroupPixels - 1) / kGroupPixels + 1);
  const auto find = [&](std::uint64_t begin, std::uint64_t end, GroupMask& mask) {
    std::uint64_t covered = 0, fragments = 0;
    for (std::uint64_t first = begin; first < end; first += 64) {
      std::uint64_t bits = 0;
      for (std::uint64_t i = first; i < std::min(first + 64, end); ++i) {
        const std::uint32_t size = image_.lists[range.begin + i].size;
        const std::uint64_t bit = size > 0 ? 1 : 0;
        fragments += size;
        covered += bit;
        bits |= bit << (i - first);
      }
      mask[(first - begin) / 64] = bits;
    }
    before[begin / kGroupPixels + 1] = fragments;
    return covered;
  };
  const Coverage coverage(range.size(), find);
  for (std::size_t i = 1; i < before.size(); ++i) before[i] += before[i - 1];

  const std::size_t bytes = coverage.encoded_bytes() + coverage.covered() * sizeof(std::uint32_t);
  comm::Buffer buffer(bytes + before.back() * sizeof(DeepFragment<Payload>));
  auto* sizes = reinterpret_cast<std::uint32_t*>(coverage.encode(buffer.data()));
  auto* fragments = reinterpret_cast<DeepFragment<Payload>*>(buffer.data() + bytes);
  parallel::parallel_for(0, coverage.groups(), 1, [&](std::size_t i) {
    std::uint32_t* size = sizes + coverage.group(i).covered_before;
    DeepFragment<Payload>* next = fragments + before[i];
    for_each_covered(coverage, i, [&](std::uint64_t pixel, std::uint64_t /*k*/) {
      const auto list = image_.at(range.begin + pixel);
      *size++ = static_cast<std::uint32_t>(list.size());
      next = std::copy(list.begin(), list.end(), next);
    });
  });
  return buffer;
}

template <class Payload>
void DeepLayer<Payload>::merge_lists(std::span<const DeepFragment<Payload>> own,
                                     std::span<const DeepFragment<Payload>> arrived,
                                     std::vector<DeepFragment<Payload>>& merged) {
  merged.clear();
  auto a = own.begin(), b = arrived.begin();
  while (a != own.end() || b != arrived.end()) {
    const bool from_own = b == arrived.end() || (a != own.end() && !in_front(*b, *a));
    merged.push_back(from_own ? *a++ : *b++);
    if (is_opaque(merged.back().payload)) return;
  }
}

// Fragments stay where they are as long as there are no more of them than before; otherwise the
// pixel's list moves to the group's own chunk.
template <class Payload>
auto DeepLayer<Payload>::merge_group(PixelRange range, const Arrived& arrived, std::size_t group,
                                     std::size_t chunk) -> Merged {
  Merged counts;
  std::vector<DeepFragment<Payload>> merged;
  std::vector<DeepFragment<Payload>>& grown = image_.chunks[chunk];
  const std::uint32_t* size = arrived.sizes + arrived.coverage.group(group).covered_before;
  const DeepFragment<Payload>* next = arrived.fragments + arrived.before[group];
  for_each_covered(arrived.coverage, group, [&](std::uint64_t pixel, std::uint64_t /*k*/) {
    typename DeepImage<Payload>::List& list = image_.lists[range.begin + pixel];
    const std::span<const DeepFragment<Payload>> own = image_.at(range.begin + pixel);
    const std::span<const DeepFragment<Payload>> other(next, *size++);
    next += other.size();
    counts.composited += own.size() + other.size();
    if (hides(own, other)) return;
    std::span<const DeepFragment<Payload>> result = other;
    if (!own.empty() && !hides(other, own)) {
      merge_lists(own, other, merged);
      result = merged;
    }
    if (result.size() <= own.size()) {
      counts.abandoned += own.size() - result.size();
      std::copy(result.begin(), result.end(), image_.chunks[list.chunk].begin() + list.first);
    } else {
      counts.abandoned += own.size();
      list.chunk = static_cast<std::uint32_t>(chunk);
      list.first = static_cast<std::uint32_t>(grown.size());
      grown.insert(grown.end(), result.begin(), result.end());
    }
    list.size = static_cast<std::uint32_t>(result.size());
  });
  return counts;
}

// So that memory is in proportion to what pixels have, however often lists have moved.
template <class Payload>
void DeepLayer<Payload>::abandon(std::uint64_t fragments) {
  abandoned_ += fragments;
  std::uint64_t all = 0;
  for (const auto& chunk : image_.chunks) all += chunk.size();
  if (abandoned_ <= all / 2) return;
  image_.compact();
  abandoned_ = 0;
}

template <class Payload>
std::uint64_t DeepLayer<Payload>::merge(PixelRange range, const comm::Buffer& pixels,
                                        Side /*from*/) {
  assert(range.begin <= range.end && range.end <= this->pixels());
  const Arrived arrived(range, pixels);
  const std::size_t groups = arrived.coverage.groups(), first_chunk = image_.chunks.size();
  image_.chunks.resize(first_chunk + groups);
  std::vector<Merged> merged(groups);
  parallel::parallel_for(0, groups, 1, [&](std::size_t i) {
    merged[i] = merge_group(range, arrived, i, first_chunk + i);
  });
  Merged sum;
  for (const Merged& of_group : merged) {
    sum.composited += of_group.composited;
    sum.abandoned += of_group.abandoned;
  }
  abandon(sum.abandoned);
  return sum.composited;
}

template <class Payload>
void DeepLayer<Payload>::replace(PixelRange range, const comm::Buffer& pixels) {
  assert(range.begin <= range.end && range.end <= this->pixels());
  const Arrived arrived(range, pixels);
  std::uint64_t forgotten = 0;
  for (std::uint64_t i = range.begin; i < range.end; ++i) forgotten += image_.lists[i].size;
  image_.clear(range.begin, range.end);
  abandon(forgotten);
  const std::size_t groups = arrived.coverage.groups(), first_chunk = image_.chunks.size();
  image_.chunks.resize(first_chunk + groups);
  parallel::parallel_for(0, groups, 1, [&](std::size_t i) {
    image_.chunks[first_chunk + i].assign(arrived.fragments + arrived.before[i],
                                          arrived.fragments + arrived.before[i + 1]);
    const std::uint32_t* sizes = arrived.sizes + arrived.coverage.group(i).covered_before;
    std::uint32_t first = 0;
    for_each_covered(arrived.coverage, i, [&](std::uint64_t pixel, std::uint64_t k) {
      image_.lists[range.begin + pixel] = {static_cast<std::uint32_t>(first_chunk + i), first,
                                           sizes[k]};
      first += sizes[k];
    });
  });
}

template <class Payload>
bool DeepLayer<Payload>::empty() const {
  const auto lists = image_.lists.span();
  return std::all_of(lists.begin(), lists.end(), [](const auto& list) { return list.size == 0; });
}

}  // namespace delray::composite
