// Pictures of small scenes that are shared out over ranks.
#pragma once

#include <cstring>

#include "comm/threads.h"
#include "raytrace/distribution.h"
#include "raytrace/render.h"
#include "scenes/generate.h"

namespace delray::raytrace {

inline scenes::Scene completed(const char* name) {
  scenes::Scene scene = scenes::generate(name);
  scenes::complete(scene, scene.cameras[0]);
  return scene;
}

inline Result shared_out(const scenes::Scene& scene, const RenderOptions& options,
                         const Distribution& distribution, const ShareOptions& share, int ranks,
                         int threads) {
  Result result;
  comm::run_threads(ranks, threads, [&](comm::Communicator& communicator) {
    SharedScene mine = SharedScene::make(communicator, scene, share_options(distribution, share));
    Renderer renderer(mine, distribution);
    Result one = renderer.render(communicator, scene.cameras[0], options);
    if (communicator.rank() == 0) result = std::move(one);
  });
  return result;
}

inline std::size_t different(const Result& a, const Result& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.image.pixels(); ++i) {
    count += std::memcmp(&a.image.colour[i], &b.image.colour[i], sizeof(image::RgbaF)) != 0 ||
                     a.image.depth[i] != b.image.depth[i]
                 ? 1
                 : 0;
  }
  return count;
}

}  // namespace delray::raytrace
