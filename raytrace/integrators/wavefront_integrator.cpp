// Primary rays and random numbers of a task, whatever the integrator.
#include "raytrace/integrators/wavefront_integrator.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <utility>

#include "image/image.h"
#include "raytrace/integrators/waiting_rays.h"
#include "raytrace/sampling/samples.h"
#include "raytrace/sampling/warp.h"

namespace delray::raytrace {
namespace {

void clear(SampleBlock& block) {
  for (int i = 0; i < kPacketRays; ++i) {
    block.colour.x[i] = block.colour.y[i] = block.colour.z[i] = 0.0F;
    block.alpha[i] = 1.0F;
    block.depth[i] = image::kEmptyDepth;
  }
}

// Lanes of the block at (x, y) that are pixels of the task.
shading::LaneMask inside(const geometry::Rect& pixels, int x, int y) {
  if (x + kBlockSide <= pixels.x1 && y + kBlockSide <= pixels.y1) return shading::kAllLanes;
  shading::LaneMask mask = 0;
  for (int i = 0; i < kPacketRays; ++i) {
    mask |= pixels.contains(x + i % kBlockSide, y + i / kBlockSide) ? 1U << i : 0U;
  }
  return mask;
}

// Of those lanes the ones that are to be traced.
shading::LaneMask chosen(const FrameContext& context, shading::LaneMask lanes, int x, int y) {
  if (context.traced.empty()) return lanes;
  shading::LaneMask mask = 0;
  for (shading::LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const auto row = static_cast<std::size_t>(y + i / kBlockSide);
    const std::size_t pixel = row * static_cast<std::size_t>(context.view.width) +
                              static_cast<std::size_t>(x + i % kBlockSide);
    mask |= context.traced[pixel] != 0 ? 1U << i : 0U;
  }
  return mask;
}

// Dimensions of the sampler.
enum : std::uint32_t { kPosition, kLens, kFirstFree };

}  // namespace

void WavefrontIntegrator::enqueue_primary_rays() {
  const bool lens = context_.view.lens_radius > 0.0F;
  const bool jittered =
      (positions_ == Positions::random || context_.scattered) && context_.samples > 1;
  PrimaryPlaces places;
  std::size_t block = 0;
  const geometry::Rect& pixels = task_.pixels;
  for (int s = task_.first_sample; s < task_.first_sample + task_.samples; ++s) {
    places.set(sample_position(s, context_.samples));
    if (!jittered) steps_.set(context_.view, pixels, places);
    block = 0;
    for (int y = pixels.y0; y < pixels.y1; y += kBlockSide) {
      for (int x = pixels.x0; x < pixels.x1; x += kBlockSide, ++block) {
        const auto sample = static_cast<std::uint32_t>(s);
        const auto number = static_cast<std::uint32_t>(block);
        for (int i = 0; jittered && i < kPacketRays; ++i) {
          places.set_position(i, sobol_pair(keys(number).key(i), sample, kPosition));
        }
        for (int i = 0; lens && i < kPacketRays; ++i) {
          places.set_lens(i, disc_point(sobol_pair(keys(number).key(i), sample, kLens)));
        }
        const geometry::Rect here{x, y, x + kBlockSide, y + kBlockSide};
        if (jittered) steps_.set(context_.view, here, places);
        const auto column = static_cast<std::size_t>(jittered ? 0 : (x - pixels.x0) / kBlockSide);
        const auto row = static_cast<std::size_t>(jittered ? 0 : (y - pixels.y0) / kBlockSide);
        const shading::LaneMask mask = chosen(context_, inside(pixels, x, y), x, y);
        const bool again = primaries_.rays.size() < primaries_filled_;
        RayGroup& group = primaries_.rays.add();
        set_primary_rays(context_.view,
                         {x, y, places, steps_.right[column], steps_.up[row], mask, again}, group);
        group.misses = mask == 0 || geometry::intersection(context_.filled, here).empty();
        rays_.primary += static_cast<std::uint64_t>(std::popcount(mask));
      }
    }
  }
  primaries_filled_ = std::max(primaries_filled_, primaries_.rays.size());
}

const PixelKeys& WavefrontIntegrator::keys(std::uint32_t block) {
  if (!has_keys_[block]) {
    has_keys_[block] = true;
    const int columns = task_.columns(), number = static_cast<int>(block);
    pixel_keys(context_.options.seed, task_.pixels.x0 + number % columns * kBlockSide,
               task_.pixels.y0 + number / columns * kBlockSide, keys_[block]);
  }
  return keys_[block];
}

Sampler WavefrontIntegrator::sampler(std::uint32_t pixel) {
  const auto pixels = static_cast<std::uint32_t>(keys_.size()) * kPacketRays;
  const std::uint32_t first = pixel % pixels;
  return {keys(first / kPacketRays).key(static_cast<int>(first % kPacketRays)),
          static_cast<std::uint32_t>(task_.first_sample) + pixel / pixels, kFirstFree};
}

void WavefrontIntegrator::draw(const std::uint32_t* pixels, shading::LaneMask lanes,
                               SampleLanes& samples) {
  const auto count = static_cast<std::uint32_t>(keys_.size()) * kPacketRays;
  for (shading::LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    std::uint32_t pixel = pixels[i];
    auto sample = static_cast<std::uint32_t>(task_.first_sample);
    for (; pixel >= count; pixel -= count) ++sample;  // tasks have few samples
    const PixelKeys& of_block = keys(pixel / kPacketRays);
    const std::uint32_t lane = pixel % kPacketRays;
    samples.set(i, of_block.low[lane], of_block.high[lane], sample, kFirstFree);
  }
}

void WavefrontIntegrator::clear_for(const Task& task) {
  assert(task.pixels.x0 % kBlockSide == 0 && task.pixels.y0 % kBlockSide == 0);
  task_ = task;
  rays_ = {};
  keep_primaries(batch_);
  batch_.clear();
  next_.clear();
  samples_.resize(static_cast<std::size_t>(task.blocks()) * static_cast<std::size_t>(task.samples));
  for (SampleBlock& block : samples_) clear(block);
  keys_.resize(static_cast<std::size_t>(task_.blocks()));
  has_keys_.assign(keys_.size(), false);
}

void WavefrontIntegrator::start(const Task& task) {
  clear_for(task);
  primaries_.clear();
  enqueue_primary_rays();
  std::swap(next_, primaries_);
  begin();
  std::swap(batch_, next_);
  has_primaries_ = true;
}

void WavefrontIntegrator::advance() {
  next_.clear();
  shade();
  std::swap(batch_, next_);
  keep_primaries(next_);
}

// Nothing but primary rays is put into their groups: `batch` has them, if batch_ had them before.
void WavefrontIntegrator::keep_primaries(RayBatch& batch) {
  if (!std::exchange(has_primaries_, false)) return;
  std::swap(batch, primaries_);
}

std::vector<std::uint32_t> WavefrontIntegrator::waiting() {
  std::vector<std::uint32_t> by_block(samples_.size(), 0);
  count_waiting(by_block);
  return by_block;
}

void WavefrontIntegrator::release(std::span<const std::uint8_t> moved, RayWriter& to) {
  for (std::size_t b = 0; b < samples_.size(); ++b) {
    to.value(moved[b]);
    if (moved[b] != 0) to.value(samples_[b]);
  }
  const RayCounts counts = write_waiting(moved, to);
  to.value(counts);
  rays_ -= counts;
}

std::vector<std::uint8_t> WavefrontIntegrator::resume(const Task& task, RayReader& from) {
  clear_for(task);
  begin();
  std::vector<std::uint8_t> moved(samples_.size());
  for (std::size_t b = 0; b < samples_.size(); ++b) {
    from.value(moved[b]);
    if (moved[b] != 0) from.value(samples_[b]);
  }
  read_waiting(from);
  from.value(rays_);
  return moved;
}

}  // namespace delray::raytrace
