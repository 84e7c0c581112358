// Integrators at rest.
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "raytrace/integrator.h"

namespace delray::raytrace {

// Walks that are at rest between the tasks of a frame: one for each thread, in the end. Any thread.
class Walks {
 public:
  Walks(const Integrator& integrator, const Setting& setting)
      : integrator_(integrator), setting_(setting) {}

  int side() const { return integrator_.side; }

  std::unique_ptr<Walk> take() {
    {
      const std::lock_guard lock(mutex_);
      if (!resting_.empty()) {
        std::unique_ptr<Walk> walk = std::move(resting_.back());
        resting_.pop_back();
        return walk;
      }
    }
    return integrator_.make(setting_);
  }
  void give(std::unique_ptr<Walk> walk) {
    const std::lock_guard lock(mutex_);
    resting_.push_back(std::move(walk));
  }

 private:
  const Integrator& integrator_;
  const Setting& setting_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Walk>> resting_;
};

}  // namespace delray::raytrace
