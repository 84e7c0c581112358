#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "comm/bad_message.h"
#include "composite/deep.h"
#include "composite/dense.h"
#include "composite/layers/active.h"
#include "composite/layers/bounds.h"
#include "composite/layers/lz4.h"

namespace {

using namespace delray;

constexpr int kWidth = 70, kHeight = 90;  // a group of pixels and part of another

image::Image8 empty_picture() {
  image::Image8 picture(kWidth, kHeight);
  clear(picture);
  return picture;
}

std::unique_ptr<composite::Layer> layer_of(int kind, composite::Operator how) {
  switch (kind) {
    case 0:
      return composite::make_dense(empty_picture(), how);
    case 1:
      return composite::make_active(empty_picture(), how);
    case 2:
      return composite::make_bounds(empty_picture(), how);
    case 3:
      return composite::make_lz4(empty_picture(), how);
    default:
      return composite::make_deep(composite::DeepImage<image::RgbaF>(kWidth, kHeight));
  }
}

}  // namespace

// The first byte says what kind of layer receives the rest, and what it does with it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const auto how = (data[0] & 8) != 0 ? composite::Operator::over : composite::Operator::nearest;
  const auto layer = layer_of(data[0] % 8, how);
  const std::array<composite::PixelRange, 3> ranges = {
      {{0, kWidth * kHeight}, {100, 5000}, {64, 64 + kWidth}}};
  const composite::PixelRange range = ranges[data[0] / 32 % ranges.size()];
  const comm::Buffer message = comm::Buffer::of(std::as_bytes(std::span(data + 1, size - 1)));
  try {
    if ((data[0] & 16) != 0) {
      layer->merge(range, message, composite::Side::lower);
    } else {
      layer->replace(range, message);
    }
  } catch (const comm::BadMessage&) {
  }
  return 0;
}
