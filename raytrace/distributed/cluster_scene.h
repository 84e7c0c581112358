// Clusters that are at hand as one scene, which a ray is intersected with at once.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "raytrace/clusters/cluster.h"
#include "raytrace/integrators/intersect.h"
#include "raytrace/scene/embree_scene.h"

namespace delray::raytrace {

// Any number of threads.
class ClusterScene {
 public:
  // Builds in the caller's arena. O(n log n) of their triangles.
  ClusterScene(std::vector<std::shared_ptr<const Cluster>> clusters, const BuildOptions& options,
               const EmbreeDevice& device);
  ClusterScene(const ClusterScene&) = delete;
  ClusterScene& operator=(const ClusterScene&) = delete;

  // From now on it consists of these. O(n log n) of the triangles of those that come, with
  // BuildOptions::changing, else of all. REQUIRES: no rays meanwhile.
  void change(std::vector<std::shared_ptr<const Cluster>> clusters);

  LocalScene local(const shading::Shader& shader) const {
    return {embree_, instances_, shader, numbers_, large_};
  }
  // Of the acceleration structure; clusters have their own.
  std::uint64_t bytes() const { return embree_.memory(); }

 private:
  struct Part {
    std::shared_ptr<const Cluster> cluster;
    std::vector<std::uint32_t> instances;  // where they are in instances_
  };
  void add(std::shared_ptr<const Cluster> cluster);

  std::vector<Part> parts_;
  std::vector<GeometryInstance> instances_;  // of all parts; of those that were taken away null
  std::vector<GeometryNumbers> numbers_;     // element i: of instance i
  std::vector<std::uint32_t> free_;          // elements that are null
  EmbreeScene embree_;
  bool large_ = false;
};

}  // namespace delray::raytrace
