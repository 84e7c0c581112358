// Clusters that are read from a pack when rays want them.
#pragma once

#include <cstdint>
#include <vector>

#include "packs/pack_reader.h"
#include "raytrace/clusters/cluster.h"
#include "raytrace/distributed/cluster_tree.h"

namespace delray::raytrace {

// The finest pages of a pack in runs of some, each of which is a cluster for all instances of its
// mesh. Immutable; any thread may read.
class PackedClusters {
 public:
  // `scene` is what the pack has besides triangles (packs::PackReader::scene), with radii of points
  // in units. O(pages * instances of their meshes). Refers to pack and scene.
  PackedClusters(const packs::PackReader& pack, const scenes::Scene& scene,
                 const shading::Shader& shader, bool share_meshes);

  std::uint32_t size() const { return static_cast<std::uint32_t>(runs_.size()); }
  // Around the pages of each cluster as they are placed, or around instances of an instanced one.
  const std::vector<ClusterBox>& boxes() const { return boxes_; }
  bool is_instanced(std::uint32_t cluster) const;
  // Of the cluster in memory, about.
  std::uint64_t bytes(std::uint32_t cluster) const;
  // Of its pages in the file.
  std::uint64_t bytes_in_file(std::uint32_t cluster) const;
  // As cut_clusters() of the scene that was packed would have it. Throws files::FileError.
  ClusterData read(std::uint32_t cluster, const shading::Shader& shader) const;

 private:
  struct Run {
    std::uint32_t mesh = 0, first = 0, count = 0;  // pages
  };
  scenes::Mesh mesh_of(const Run& run) const;

  const packs::PackReader& pack_;
  const scenes::Scene& scene_;
  const bool share_meshes_;
  std::vector<GeometryInstance> instances_;         // of the scene, without geometry
  std::vector<std::vector<std::uint32_t>> placed_;  // by mesh: its instances
  std::vector<Run> runs_;
  std::vector<ClusterBox> boxes_;
};

}  // namespace delray::raytrace
