// A pool of integrators that wait for their next task.
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "raytrace/integrator.h"

namespace delray::raytrace {

// Integrators that are at rest between the tasks of a frame: one for each thread, in the end.
// Any thread.
class IntegratorPool {
 public:
  IntegratorPool(const Integrator& integrator, const FrameContext& context)
      : integrator_(integrator), context_(context) {}

  int side() const { return integrator_.side; }

  std::unique_ptr<WavefrontIntegrator> take() {
    {
      const std::lock_guard lock(mutex_);
      if (!resting_.empty()) {
        std::unique_ptr<WavefrontIntegrator> integrator = std::move(resting_.back());
        resting_.pop_back();
        return integrator;
      }
    }
    return integrator_.make(context_);
  }
  void give(std::unique_ptr<WavefrontIntegrator> integrator) {
    const std::lock_guard lock(mutex_);
    resting_.push_back(std::move(integrator));
  }

 private:
  const Integrator& integrator_;
  const FrameContext& context_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<WavefrontIntegrator>> resting_;
};

}  // namespace delray::raytrace
