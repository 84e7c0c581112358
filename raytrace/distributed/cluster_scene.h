// Clusters that are at hand as one scene, which a ray is intersected with at once.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "raytrace/distributed/cluster.h"
#include "raytrace/integrators/intersect.h"
#include "raytrace/scene/embree_scene.h"

namespace delray::raytrace {

// Immutable; any number of threads.
class ClusterScene {
 public:
  // Builds in the caller's arena. O(n log n) of their triangles.
  ClusterScene(std::vector<std::shared_ptr<const Cluster>> clusters, const BuildOptions& options,
               const EmbreeDevice& device);
  ClusterScene(const ClusterScene&) = delete;
  ClusterScene& operator=(const ClusterScene&) = delete;

  LocalScene local(const shading::Shader& shader) const {
    return {*embree_, instances_, shader, numbers_, large_};
  }
  // Of the acceleration structure; clusters have their own.
  std::uint64_t bytes() const { return embree_->memory(); }
  std::uint64_t triangles() const { return triangles_; }

 private:
  std::vector<std::shared_ptr<const Cluster>> clusters_;
  std::vector<GeometryInstance> instances_;
  std::vector<GeometryNumbers> numbers_;
  std::unique_ptr<EmbreeScene> embree_;
  std::uint64_t triangles_ = 0;
  bool large_ = false;
};

}  // namespace delray::raytrace
