// Contexts: made, chosen, copied, destroyed.
//
// The interface has one context that is current in the process. It is the only variable of this
// library, beside the error code, that no context holds.
#include "icet/context.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <numeric>
#include <utility>

#include "icet/communicators.h"
#include "icet/error.h"

namespace delray::icet {
namespace {

std::atomic<Context*>& current_context() {
  static std::atomic<Context*> context{nullptr};
  return context;
}

void check_not_drawing(const Context& context) {
  if (context.frame.is_drawing) {
    throw Error(ICET_INVALID_OPERATION,
                "a frame is being drawn: a callback changes nothing of it, and draws no other");
  }
}

}  // namespace

Settings::Settings() {
  for (const IceTEnum feature :
       {ICET_FLOATING_VIEWPORT, ICET_COMPOSITE_ONE_BUFFER, ICET_INTERLACE_IMAGES,
        ICET_COLLECT_IMAGES, ICET_GL_DISPLAY, ICET_GL_DISPLAY_INFLATE_WITH_HARDWARE}) {
    enable(feature, true);
  }
}

void Settings::enable(IceTEnum feature, bool on) {
  const std::uint64_t bit = std::uint64_t{1} << (feature - ICET_STATE_ENABLE_START);
  enabled = on ? enabled | bit : enabled & ~bit;
}

geometry::Rect display_of(const Settings& settings) {
  if (settings.tiles.empty()) return {};
  geometry::Rect all = settings.tiles.front().place;
  for (const Tile& tile : settings.tiles) {
    all = {std::min(all.x0, tile.place.x0), std::min(all.y0, tile.place.y0),
           std::max(all.x1, tile.place.x1), std::max(all.y1, tile.place.y1)};
  }
  return all;
}

int tile_of(const Settings& settings, int rank) {
  const auto found = std::find_if(settings.tiles.begin(), settings.tiles.end(),
                                  [&](const Tile& tile) { return tile.display == rank; });
  return found == settings.tiles.end() ? -1 : static_cast<int>(found - settings.tiles.begin());
}

Context* current_or_none() noexcept { return current_context(); }

Context& current() {
  Context* const context = current_or_none();
  if (context == nullptr) throw Error(ICET_INVALID_OPERATION, "there is no current context");
  return *context;
}

Context& current_not_drawing() {
  Context& context = current();
  check_not_drawing(context);
  return context;
}

}  // namespace delray::icet

IceTContextStruct::IceTContextStruct(std::unique_ptr<delray::comm::Communicator> all)
    : ranks(std::move(all)), order(static_cast<std::size_t>(ranks->size())) {
  std::iota(order.begin(), order.end(), 0);
  replication = {ranks->rank()};
}

extern "C" {

IceTDouble icetWallTime(void) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

IceTContext icetCreateContext(IceTCommunicator communicator) {
  return delray::icet::guarded([&]() -> IceTContext {
    auto made = std::make_unique<IceTContextStruct>(delray::icet::make_ranks(communicator));
    delray::icet::current_context() = made.get();
    return made.release();
  });
}

void icetDestroyContext(IceTContext context) {
  IceTContext expected = context;
  delray::icet::current_context().compare_exchange_strong(expected, nullptr);
  if (context == nullptr) return;
  delray::icet::guarded([&] { delray::icet::end_ranks(std::move(context->ranks)); });
  delete context;
}

IceTContext icetGetContext(void) { return delray::icet::current_or_none(); }

void icetSetContext(IceTContext context) { delray::icet::current_context() = context; }

void icetCopyState(IceTContext to, const IceTContext from) {
  delray::icet::guarded([&] {
    if (to == nullptr || from == nullptr) {
      throw delray::icet::Error(ICET_INVALID_VALUE, "there is no such context");
    }
    delray::icet::check_not_drawing(*to);
    delray::icet::check_not_drawing(*from);
    to->settings = from->settings;
    to->frame = from->frame;
  });
}

}  // extern "C"
