// Cuts ranges at the ends of parts. Degenerate: what replaces the pixels of a part that is there by
// those of one that is missing elsewhere is an empty layer's message.
#include "composite/joined.h"

#include <algorithm>
#include <utility>

#include "composite/layers/bundle.h"

namespace delray::composite {

JoinedLayer::JoinedLayer(std::vector<Part> parts, int layers, MakeEmpty make_empty)
    : parts_(std::move(parts)), begins_(1), format_(layers), make_empty_(std::move(make_empty)) {
  for (const Part& part : parts_) begins_.push_back(begins_.back() + part.pixels);
}

Layer& JoinedLayer::existing(std::size_t part) {
  if (parts_[part].layer == nullptr) parts_[part].layer = make_empty_(part);
  return *parts_[part].layer;
}

// Calls f(part, pixels in the part, message of them) for what encode(range) gave.
template <class F>
void JoinedLayer::for_each_message(PixelRange range, const comm::Buffer& pixels, F&& f) {
  Unbundling messages(pixels);
  bool is_bundle = true;
  for_each_piece(range, [&](std::size_t part, PixelRange piece) {
    is_bundle = piece.size() < range.size();
    is_bundle ? f(part, piece, messages.next()) : f(part, piece, pixels);
  });
  if (is_bundle) messages.check_end();
}

comm::Buffer JoinedLayer::encode(PixelRange range) {
  std::vector<comm::Buffer> messages;
  for_each_piece(range, [&](std::size_t part, PixelRange piece) {
    messages.push_back(layer(part) == nullptr ? comm::Buffer() : layer(part)->encode(piece));
  });
  if (messages.empty()) return {};
  return messages.size() == 1 ? std::move(messages.front()) : bundle(messages);
}

std::uint64_t JoinedLayer::merge(PixelRange range, const comm::Buffer& pixels, Side from) {
  std::uint64_t composited = 0;
  for_each_message(range, pixels,
                   [&](std::size_t part, PixelRange piece, const comm::Buffer& message) {
                     if (message.empty()) return;
                     composited += existing(part).merge(piece, message, from);
                   });
  return composited;
}

void JoinedLayer::replace(PixelRange range, const comm::Buffer& pixels) {
  for_each_message(range, pixels,
                   [&](std::size_t part, PixelRange piece, const comm::Buffer& message) {
                     if (!message.empty()) return existing(part).replace(piece, message);
                     if (layer(part) == nullptr) return;
                     layer(part)->replace(piece, make_empty_(part)->encode(piece));
                   });
}

std::uint64_t JoinedLayer::prune(PixelRange range, const comm::Buffer& pixels) {
  std::uint64_t compared = 0;
  for_each_message(range, pixels,
                   [&](std::size_t part, PixelRange piece, const comm::Buffer& message) {
                     if (message.empty() || layer(part) == nullptr) return;
                     compared += layer(part)->prune(piece, message);
                   });
  return compared;
}

bool JoinedLayer::empty() const {
  return std::all_of(parts_.begin(), parts_.end(),
                     [](const Part& part) { return part.layer == nullptr || part.layer->empty(); });
}

}  // namespace delray::composite
