// Pictures by some ranks, and parts of them.
#pragma once

#include <utility>

#include "comm/threads.h"
#include "raster/render.h"

namespace delray::raster {

inline Picture rendered(const scenes::Scene& scene, const scenes::Camera& camera,
                        const RenderOptions& options, int ranks = 1) {
  Picture picture;
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    Result mine = render(communicator, scene, camera, options);
    if (communicator.rank() == 0) picture = std::move(mine.picture);
  });
  return picture;
}

inline Picture part_of(const Picture& picture, const geometry::Rect& window) {
  return std::visit(
      [&](const auto& whole) -> Picture {
        std::decay_t<decltype(whole)> part(window.width(), window.height());
        for (int y = 0; y < part.height; ++y) {
          for (int x = 0; x < part.width; ++x) {
            const auto from =
                static_cast<std::size_t>((y + window.y0) * whole.width + x + window.x0);
            const auto to = static_cast<std::size_t>(y * part.width + x);
            part.colour[to] = whole.colour[from];
            part.depth[to] = whole.depth[from];
          }
        }
        return part;
      },
      picture);
}

}  // namespace delray::raster
