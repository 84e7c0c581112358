// Hashes the pixels in memory order as one piece; depth is not part of them.
#include "image/hash.h"

#include <fmt/format.h>
#include <xxhash.h>

namespace delray::image {

namespace {

std::string text_of(const XXH128_hash_t& value) {
  return fmt::format("{:016x}{:016x}", value.high64, value.low64);
}

}  // namespace

std::string hash(const Image8& image) {
  return text_of(XXH3_128bits(image.colour.data(), image.pixels() * sizeof(Rgba8)));
}

struct PictureHash::State {
  XXH3_state_t* const xxh = XXH3_createState();
  State() { XXH3_128bits_reset(xxh); }
  ~State() { XXH3_freeState(xxh); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
};

PictureHash::PictureHash() : state_(std::make_unique<State>()) {}
PictureHash::~PictureHash() = default;

void PictureHash::append(const Image8& rows) {
  XXH3_128bits_update(state_->xxh, rows.colour.data(), rows.pixels() * sizeof(Rgba8));
}

std::string PictureHash::text() const { return text_of(XXH3_128bits_digest(state_->xxh)); }

}  // namespace delray::image
