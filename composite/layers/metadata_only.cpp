// Layers of the codecs active and bounds that hold masks in place of pixels, and of dense that hold
// nothing. Their messages tell the size that a real one would have, and carry the coverage where
// there is a mask; merging adds it. Degenerate: a message of nothing carries no coverage.
#include "composite/metadata_only.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "composite/layers/bounding_rectangle.h"
#include "composite/layers/metadata_only_layer.h"

namespace delray::composite {
namespace {

using internal::MetadataOnlyLayer;

class MetadataOnlyDenseLayer final : public MetadataOnlyLayer {
 public:
  MetadataOnlyDenseLayer(std::uint64_t pixels, std::size_t pixel_bytes, bool empty,
                         const LayerClock& clock)
      : MetadataOnlyLayer(pixel_bytes, clock), pixels_(pixels), empty_(empty) {}

  std::uint64_t pixels() const override { return pixels_; }
  comm::Buffer encode(PixelRange range) override {
    const std::size_t bytes = range.size() * pixel_bytes();
    charge_cut(range, bytes);
    return comm::Buffer::standing_for(bytes, {});
  }
  std::uint64_t merge(PixelRange range, const comm::Buffer&, Side) override {
    charge_merge(range);
    return range.size();
  }
  void replace(PixelRange range, const comm::Buffer&) override {
    charge_replace(range.size() * pixel_bytes());
  }
  std::uint64_t prune(PixelRange range, const comm::Buffer&) override {
    charge_merge(range);
    return range.size();
  }
  bool empty() const override { return empty_; }

 private:
  std::uint64_t pixels_;
  bool empty_;
};

// Knows which pixels are covered. A message holds how many pixels travel and which are covered, and
// nothing where none is.
class MetadataOnlyMaskLayer : public MetadataOnlyLayer {
 public:
  MetadataOnlyMaskLayer(ImageMasks&& image, std::size_t pixel_bytes, std::size_t bytes_of_nothing,
                        const LayerClock& clock)
      : MetadataOnlyLayer(pixel_bytes, clock),
        image_(std::move(image)),
        bytes_of_nothing_(bytes_of_nothing) {}

  std::uint64_t pixels() const override { return image_.covered.pixels(); }
  comm::Buffer encode(PixelRange range) override {
    // Most messages between thousands of ranks are of nothing.
    if (image_.covered.empty(range)) {
      charge_cut(range, bytes_of_nothing_);
      return comm::Buffer::standing_for(bytes_of_nothing_, {});
    }
    const Coverage coverage(
        range.size(), [&](std::uint64_t begin, std::uint64_t end, GroupMask& mask) {
          return image_.covered.read(range.begin + begin, range.begin + end, mask);
        });
    const Sizes sizes = sizes_of(range, coverage);
    comm::Buffer content(sizeof sizes + coverage.encoded_bytes());
    std::memcpy(content.data(), &sizes, sizeof sizes);
    coverage.encode(content.data() + sizeof sizes);
    charge_cut(range, sizes.bytes);
    return comm::Buffer::standing_for(sizes.bytes, std::move(content));
  }
  std::uint64_t merge(PixelRange range, const comm::Buffer& pixels, Side) override {
    charge_merge(range);
    for_each_group(range, pixels, [&](std::uint64_t begin, const GroupMask& mask) {
      image_.covered.add(begin, mask);
    });
    return sizes_in(pixels).pixels;
  }
  void replace(PixelRange range, const comm::Buffer& pixels) override {
    charge_replace(sizes_in(pixels).bytes);
    image_.covered.remove(range);
    for_each_group(range, pixels, [&](std::uint64_t begin, const GroupMask& mask) {
      image_.covered.add(begin, mask);
    });
  }
  // Takes away what any lower rank hides where this one has something: by the time that the rank
  // sends what is left, whoever hides it has come.
  std::uint64_t prune(PixelRange range, const comm::Buffer& pixels) override {
    charge_merge(range);
    for_each_group(range, pixels, [&](std::uint64_t begin, GroupMask& mask) {
      const std::uint64_t end = std::min(begin + kGroupPixels, range.end);
      GroupMask unhidden{};
      image_.unhidden.read(begin, end, unhidden);
      for (std::size_t i = 0; i < mask.size(); ++i) mask[i] &= ~unhidden[i];
      image_.covered.remove(begin, mask);
    });
    return sizes_in(pixels).pixels;
  }
  bool empty() const override { return image_.covered.empty(); }

 protected:
  struct Sizes {
    std::uint64_t bytes = 0, pixels = 0;  // of the message that it stands for, and pixels in it
  };
  virtual Sizes sizes_of(PixelRange range, const Coverage& coverage) const = 0;
  const PixelMask& covered() const { return image_.covered; }

 private:
  Sizes sizes_in(const comm::Buffer& pixels) const {
    Sizes sizes{bytes_of_nothing_, 0};
    if (!pixels.empty()) std::memcpy(&sizes, pixels.data(), sizeof sizes);
    return sizes;
  }

  // Calls f(first pixel, mask) for the groups that a message covers.
  template <class F>
  static void for_each_group(PixelRange range, const comm::Buffer& pixels, F&& f) {
    if (pixels.empty()) return;
    const Coverage coverage(range.size(),
                            std::span(pixels.data(), pixels.size()).subspan(sizeof(Sizes)));
    for (std::size_t i = 0; i < coverage.groups(); ++i) {
      const Coverage::Group at = coverage.group(i);
      if (at.covered == 0) continue;
      GroupMask mask = at.is_full() ? first_bits(at.end - at.begin) : coverage.mask(i);
      f(range.begin + at.begin, mask);
    }
  }

  static GroupMask first_bits(std::uint64_t count) {
    GroupMask mask{};
    for (std::uint64_t i = 0; i * 64 < count; ++i) {
      mask[i] =
          count - i * 64 >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << (count - i * 64)) - 1;
    }
    return mask;
  }

  ImageMasks image_;
  std::size_t bytes_of_nothing_;  // of a message of pixels none of which is covered
};

class MetadataOnlyActiveLayer final : public MetadataOnlyMaskLayer {
 public:
  MetadataOnlyActiveLayer(ImageMasks&& image, std::size_t pixel_bytes, const LayerClock& clock)
      : MetadataOnlyMaskLayer(std::move(image), pixel_bytes, sizeof(std::uint64_t), clock) {}

 private:
  Sizes sizes_of(PixelRange, const Coverage& coverage) const override {
    return {coverage.encoded_bytes() + coverage.covered() * pixel_bytes(), coverage.covered()};
  }
};

class MetadataOnlyBoundsLayer final : public MetadataOnlyMaskLayer {
 public:
  MetadataOnlyBoundsLayer(ImageMasks&& image, std::uint64_t width, std::size_t pixel_bytes,
                          const LayerClock& clock)
      : MetadataOnlyMaskLayer(std::move(image), pixel_bytes, sizeof(internal::Bounds), clock),
        width_(width) {}

 private:
  Sizes sizes_of(PixelRange range, const Coverage&) const override {
    const internal::Bounds bounds = internal::bounds_of(
        range, width_, [&](std::uint64_t begin, std::uint64_t end, GroupMask& mask) {
          return covered().read(begin, end, mask);
        });
    const std::uint64_t inside = internal::pixels_in(bounds, width_, range);
    return {sizeof bounds + inside * pixel_bytes(), inside};
  }

  std::uint64_t width_;
};

}  // namespace

std::optional<MetadataOnly> metadata_only_of(std::string_view codec) {
  if (codec == "dense") return MetadataOnly::dense;
  if (codec == "bounds") return MetadataOnly::bounds;
  if (codec == "active") return MetadataOnly::active;
  if (codec == "deep") return MetadataOnly::deep;
  return std::nullopt;
}

std::unique_ptr<Layer> make_metadata_only_dense(std::uint64_t pixels, std::size_t pixel_bytes,
                                                bool empty, const LayerClock& clock) {
  return std::make_unique<MetadataOnlyDenseLayer>(pixels, pixel_bytes, empty, clock);
}

std::unique_ptr<Layer> make_metadata_only_active(ImageMasks&& image, std::size_t pixel_bytes,
                                                 const LayerClock& clock) {
  return std::make_unique<MetadataOnlyActiveLayer>(std::move(image), pixel_bytes, clock);
}

std::unique_ptr<Layer> make_metadata_only_bounds(ImageMasks&& image, std::uint64_t width,
                                                 std::size_t pixel_bytes, const LayerClock& clock) {
  return std::make_unique<MetadataOnlyBoundsLayer>(std::move(image), width, pixel_bytes, clock);
}

}  // namespace delray::composite
