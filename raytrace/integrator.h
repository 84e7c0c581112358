// What is done with the rays of a pixel: the table of integrators.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string_view>

#include "image/image.h"
#include "raytrace/ray.h"
#include "raytrace/tracer.h"
#include "scenes/camera.h"

namespace delray::raytrace {

struct TraceOptions {
  int depth = 8;  // how often light may be mirrored or refracted on its way to the camera
  enum class Background : std::uint8_t {
    environment,  // where nothing is hit the environment shows, alpha 1
    transparent,  // where nothing is hit colour and alpha are 0
  } background = Background::environment;
};

// Rays sent. A ray that goes on behind a see-through layer counts again.
struct RayCounts {
  std::uint64_t primary = 0, shadow = 0, secondary = 0;
  RayCounts& operator+=(const RayCounts& b) {
    primary += b.primary;
    shadow += b.shadow;
    secondary += b.secondary;
    return *this;
  }
  bool operator==(const RayCounts&) const = default;
};

inline constexpr int kBlockSide = 4;

// One sample for each pixel of a block: pixel i is (x + i % 4, y + i / 4), its sample at `offset`
// from the pixel's top left corner.
struct Block {
  int x = 0, y = 0;
  glm::vec2 offset{0.5F};
  ActiveRays active;  // pixels outside the frame take no part
};

// Of active rays; others are left as they are. Depth is the distance along the view axis of the
// first layer that is not fully transparent, kEmptyDepth where there is none.
struct BlockResult {
  image::RgbaF colour[kPacketRays];
  float depth[kPacketRays];
};

struct Integrator {
  const char* name;
  const char* description;
  void (*trace)(const Tracer& tracer, const scenes::View& view, const TraceOptions& options,
                const Block& block, BlockResult& result, RayCounts& counts);
};

std::span<const Integrator> integrators();

// Throws std::invalid_argument naming the legal ones.
const Integrator& integrator(std::string_view name);

}  // namespace delray::raytrace
