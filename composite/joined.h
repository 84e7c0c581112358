// Several layers, one behind the other, as one: the tiles of a display are composited at once.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "composite/layer.h"

namespace delray::composite {

// Pixels are those of the first part, then those of the second ... A part may be missing on a rank
// that has nothing there: it costs nothing until something arrives for it.
//
// The message of a range that lies in one part is that of the part, or has no bytes where the part
// is missing; that of others is those of the pieces one after the other, each after a u64 that
// tells its size and padded to a multiple of 8 bytes.
//
// REQUIRES: parts have equal sizes on all ranks.
class JoinedLayer final : public Layer {
 public:
  struct Part {
    std::uint64_t pixels = 0;
    std::unique_ptr<Layer> layer;  // null: nothing in it
  };
  // An empty layer of part i, which is of the same type and format as those that are there.
  using MakeEmpty = std::function<std::unique_ptr<Layer>(std::size_t part)>;

  // `layers` is the format of all parts, wherever they are.
  JoinedLayer(std::vector<Part> parts, int layers, MakeEmpty make_empty);

  std::uint64_t pixels() const override { return begins_.back(); }
  int format() const override { return format_; }
  comm::Buffer encode(PixelRange range) override;
  std::uint64_t merge(PixelRange range, const comm::Buffer& pixels, Side from) override;
  void replace(PixelRange range, const comm::Buffer& pixels) override;
  std::uint64_t prune(PixelRange range, const comm::Buffer& pixels) override;
  bool empty() const override;

  std::size_t parts() const { return parts_.size(); }
  // Of all pixels those of part i.
  PixelRange range_of(std::size_t part) const { return {begins_[part], begins_[part + 1]}; }
  // Null where the part is missing.
  Layer* layer(std::size_t part) { return parts_[part].layer.get(); }
  std::unique_ptr<Layer> take_layer(std::size_t part) { return std::move(parts_[part].layer); }
  // Makes one where the part is missing.
  Layer& existing(std::size_t part);
  // Calls f(part, pixels of the part) for each part that has some of a range.
  template <class F>
  void for_each_piece(PixelRange range, F&& f) const {
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const std::uint64_t begin = std::max(range.begin, begins_[i]);
      const std::uint64_t end = std::min(range.end, begins_[i + 1]);
      if (begin < end) f(i, PixelRange{begin - begins_[i], end - begins_[i]});
    }
  }

 private:
  template <class F>
  void for_each_message(PixelRange range, const comm::Buffer& pixels, F&& f);

  std::vector<Part> parts_;
  std::vector<std::uint64_t> begins_;  // one more than there are parts
  int format_;
  MakeEmpty make_empty_;
};

}  // namespace delray::composite
