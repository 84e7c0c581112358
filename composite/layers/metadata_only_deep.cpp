// A deep layer that holds in place of fragments where surfaces lie. Its messages tell the size that
// a real one would have, and carry the lists.
#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "composite/layers/metadata_only_layer.h"

namespace delray::composite {
namespace {

using Pixel = DeepShape::Pixel;
using Surface = DeepShape::Surface;

// A message holds the surfaces of the range.
class MetadataOnlyDeepLayer final : public internal::MetadataOnlyLayer {
 public:
  MetadataOnlyDeepLayer(DeepShape&& image, std::size_t fragment_bytes, const LayerClock& clock)
      : MetadataOnlyLayer(fragment_bytes, clock), image_(std::move(image)) {}

  std::uint64_t pixels() const override { return image_.pixels(); }
  comm::Buffer encode(PixelRange range) override {
    std::vector<Pixel> pixels;
    std::vector<Surface> surfaces;
    image_.read(range, pixels, surfaces);
    const Coverage coverage(
        range.size(), [&](std::uint64_t begin, std::uint64_t end, GroupMask& mask) {
          const auto before = [](const Pixel& pixel, std::uint64_t index) {
            return pixel.index < index;
          };
          const auto first = std::lower_bound(pixels.begin(), pixels.end(), begin, before);
          const auto last = std::lower_bound(first, pixels.end(), end, before);
          for (auto at = first; at != last; ++at)
            mask[(at->index - begin) / 64] |= std::uint64_t{1} << (at->index - begin) % 64;
          return static_cast<std::uint64_t>(last - first);
        });
    const Header header{coverage.encoded_bytes() + pixels.size() * sizeof(std::uint32_t) +
                            surfaces.size() * pixel_bytes(),
                        pixels.size(), surfaces.size()};
    comm::Buffer content(sizeof header + pixels.size() * sizeof(Pixel) +
                         surfaces.size() * sizeof(Surface));
    std::byte* to = content.data();
    std::memcpy(to, &header, sizeof header);
    to += sizeof header;
    std::copy(pixels.begin(), pixels.end(), reinterpret_cast<Pixel*>(to));
    to += pixels.size() * sizeof(Pixel);
    std::copy(surfaces.begin(), surfaces.end(), reinterpret_cast<Surface*>(to));
    charge_cut(range, header.bytes);
    return comm::Buffer::standing_for(header.bytes, std::move(content));
  }
  std::uint64_t merge(PixelRange range, const comm::Buffer& pixels, Side) override {
    charge_merge(range);
    return image_.merge(range, lists_in(pixels));
  }
  void replace(PixelRange range, const comm::Buffer& pixels) override {
    charge_replace(header_of(pixels).bytes);
    image_.remove(range);
    image_.merge(range, lists_in(pixels));
  }
  bool empty() const override { return image_.empty(); }

 private:
  struct Header {
    std::uint64_t bytes = 0;  // of the message that it stands for
    std::uint64_t pixels = 0, surfaces = 0;
  };
  static Header header_of(const comm::Buffer& message) {
    Header header;
    std::memcpy(&header, message.data(), sizeof header);
    return header;
  }
  static DeepShape::Lists lists_in(const comm::Buffer& message) {
    const Header header = header_of(message);
    const auto* const pixels = reinterpret_cast<const Pixel*>(message.data() + sizeof header);
    const auto* const surfaces = reinterpret_cast<const Surface*>(pixels + header.pixels);
    return {{pixels, header.pixels}, {surfaces, header.surfaces}};
  }

  DeepShape image_;
};

}  // namespace

std::unique_ptr<Layer> make_metadata_only_deep(DeepShape image, std::size_t fragment_bytes,
                                               const LayerClock& clock) {
  return std::make_unique<MetadataOnlyDeepLayer>(std::move(image), fragment_bytes, clock);
}

}  // namespace delray::composite
