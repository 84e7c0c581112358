// Mesa's software rasterizer llvmpipe, through OSMesa (MIT), in a process of its own: it reads its
// number of threads from the environment, once.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/camera.h"
#include "scenes/scene.h"

namespace delray::bench {

class Llvmpipe {
 public:
  // Forks; the child keeps all meshes in vertex and index buffers, with a colour for each vertex,
  // and draws one instance after the other, lit at the vertices by one directional light, without
  // culling. Of spots (Shape::Kind::point) the vertices are GL_POINTS, squares of that size in
  // pixels. Errors: std::runtime_error where there is no such rasterizer.
  Llvmpipe(const scenes::Scene& scene, const scenes::View& view, int threads);
  ~Llvmpipe();
  Llvmpipe(const Llvmpipe&) = delete;
  Llvmpipe& operator=(const Llvmpipe&) = delete;

  // Seconds from clearing to the finished picture.
  double render();
  // Of the last one: whether something was drawn at each pixel, top row first.
  std::vector<std::uint8_t> coverage();

 private:
  std::size_t pixels_;
  int to_child_ = -1, from_child_ = -1;
  int child_ = -1;
};

}  // namespace delray::bench
