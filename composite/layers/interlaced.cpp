// Maps ranges of the order that schemes see to pieces of the image, and cuts and merges piece by
// piece (Moreland, Kendall, Peterka and Huang 2011).
//
// Each set gets several pieces, fewer where they would be small. A range finds its pieces by
// binary search. Degenerate: in small images a set has one piece, which is the order that there
// was.
#include "composite/layers/interlaced.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "composite/layers/bundle.h"
#include "composite/schemes/range.h"

namespace delray::composite {
namespace {

// Pieces of one rank's pixels; as tiles.cpp.
constexpr std::uint64_t kPiecesOfSet = 8;
constexpr std::uint64_t kFewestPixelsOfPiece = 4096;

class InterlacedLayer final : public Layer {
 public:
  InterlacedLayer(std::unique_ptr<Layer> layer, int parts, int samples_per_pixel)
      : layer_(std::move(layer)) {
    const PixelRange all{0, layer_->pixels()};
    const int of_set = static_cast<int>(std::clamp<std::uint64_t>(
        all.size() / static_cast<std::uint64_t>(parts) / kFewestPixelsOfPiece, 1, kPiecesOfSet));
    std::uint64_t begin = 0;
    for (int set = 0; set < parts; ++set) {
      for (int i = 0; i < of_set; ++i) {
        const PixelRange real =
            internal::piece_of(all, i * parts + set, of_set * parts, samples_per_pixel);
        if (real.size() > 0) pieces_.push_back({begin, real});
        begin += real.size();
      }
    }
  }

  std::uint64_t pixels() const override { return layer_->pixels(); }
  bool empty() const override { return layer_->empty(); }

  comm::Buffer encode(PixelRange range) override {
    std::vector<comm::Buffer> messages;
    for_each_piece(range, [&](PixelRange real) { messages.push_back(layer_->encode(real)); });
    return bundle(messages);
  }
  std::uint64_t merge(PixelRange range, const comm::Buffer& pixels, Side from) override {
    std::uint64_t composited = 0;
    for_each_message(range, pixels, [&](PixelRange real, const comm::Buffer& message) {
      composited += layer_->merge(real, message, from);
    });
    return composited;
  }
  void replace(PixelRange range, const comm::Buffer& pixels) override {
    for_each_message(range, pixels, [&](PixelRange real, const comm::Buffer& message) {
      layer_->replace(real, message);
    });
  }
  std::uint64_t prune(PixelRange range, const comm::Buffer& pixels) override {
    std::uint64_t compared = 0;
    for_each_message(range, pixels, [&](PixelRange real, const comm::Buffer& message) {
      compared += layer_->prune(real, message);
    });
    return compared;
  }

  OwnedPixels deinterlaced(const std::vector<PixelRange>& ranges) && {
    OwnedPixels part;
    for (const PixelRange& range : ranges) {
      for_each_piece(range, [&](PixelRange real) { part.ranges.push_back(real); });
    }
    part.layer = std::move(layer_);
    return part;
  }

 private:
  struct Piece {
    std::uint64_t begin;  // where it lies in the order that schemes see
    PixelRange real;
  };

  template <class F>
  void for_each_piece(PixelRange range, F&& f) const {
    auto piece = std::partition_point(pieces_.begin(), pieces_.end(), [&](const Piece& at) {
      return at.begin + at.real.size() <= range.begin;
    });
    for (; piece != pieces_.end() && piece->begin < range.end; ++piece) {
      const PixelRange seen =
          internal::overlap(range, {piece->begin, piece->begin + piece->real.size()});
      const std::uint64_t begin = piece->real.begin + (seen.begin - piece->begin);
      f(PixelRange{begin, begin + seen.size()});
    }
  }
  template <class F>
  void for_each_message(PixelRange range, const comm::Buffer& pixels, F&& f) const {
    Unbundling messages(pixels);
    for_each_piece(range, [&](PixelRange real) { f(real, messages.next()); });
    messages.check_end();
  }

  std::unique_ptr<Layer> layer_;
  std::vector<Piece> pieces_;  // ascending
};

}  // namespace

std::unique_ptr<Layer> interlace(std::unique_ptr<Layer> layer, int parts, int samples_per_pixel) {
  return std::make_unique<InterlacedLayer>(std::move(layer), parts, samples_per_pixel);
}

OwnedPixels deinterlace(OwnedPixels&& part) {
  return std::move(dynamic_cast<InterlacedLayer&>(*part.layer)).deinterlaced(part.ranges);
}

}  // namespace delray::composite
