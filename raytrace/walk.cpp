#include "raytrace/walk.h"

#include <cassert>

#include "image/image.h"
#include "raytrace/internal/primary_rays.h"

namespace delray::raytrace {
namespace {

void clear(SampleBlock& block) {
  for (int i = 0; i < kPacketRays; ++i) {
    block.colour.x[i] = block.colour.y[i] = block.colour.z[i] = 0.0F;
    block.alpha[i] = 1.0F;
    block.depth[i] = image::kEmptyDepth;
  }
}

}  // namespace

void Walk::start(const Task& task) {
  assert(task.pixels.x0 % kBlockSide == 0 && task.pixels.y0 % kBlockSide == 0);
  task_ = task;
  rays_ = {};
  wave_.clear();
  next_.clear();
  samples_.resize(static_cast<std::size_t>(task.blocks()) * static_cast<std::size_t>(task.samples));
  for (SampleBlock& block : samples_) clear(block);
  rays_.primary += ask_primary_rays(setting_, task, next_.rays);
  begin();
  std::swap(wave_, next_);
}

void Walk::go_on() {
  next_.clear();
  look();
  std::swap(wave_, next_);
}

}  // namespace delray::raytrace
