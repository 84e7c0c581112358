// A scene whose geometry is shared out over ranks; materials, textures, lights and environment are
// on all of them.
#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <unordered_map>
#include <vector>

#include "comm/communicator.h"
#include "raytrace/distributed/cluster_scene.h"
#include "raytrace/distributed/cluster_tree.h"
#include "raytrace/distributed/packed_clusters.h"
#include "raytrace/sampling/light_table.h"
#include "scenes/generate.h"
#include "scenes/scene.h"
#include "shading/shader.h"

namespace delray::raytrace {

// How a scene is distributed.
struct ShareOptions {
  // Which ranks clusters go to: neighbours to one, two runs of them from both ends of the scene, so
  // that a ray changes rank seldom, or random ones, so that every rank has some of what the picture
  // shows (Jevans 1989). Voxels are always dealt at random.
  enum class Assignment : std::uint8_t { neighbours, random } assignment = Assignment::neighbours;
  std::uint64_t seed = 1;  // of random
  // What clusters are: parts of equally many triangles, of a hierarchy, whose upper part every rank
  // has (Caspary and Scherson 1989), or equal voxels of space with what reaches into them (Jevans
  // 1989).
  enum class Division : std::uint8_t { clusters, voxels } division = Division::clusters;
  // Whether clusters that are fetched travel compressed (Wald et al. 2001).
  bool compresses = false;
  // The height at which Caspary's hierarchy is cut: about 2^level subtrees are left below;
  // negative: by the number of triangles. Not with most_triangles.
  int cut_level = -1;
  // Bytes that other ranks' clusters may take on this one, with their acceleration structures, but
  // for one cluster that is always kept; 0: a tenth of what all ranks have together.
  std::uint64_t cache_bytes = 0;
  std::uint32_t most_triangles = 0;  // of a cluster; 0: by the number of triangles
  BuildOptions build;
};

// What it takes to bring rays and clusters together, in seconds of processor time and of messages:
// for a ray to another rank and back, and for each byte of a cluster that is fetched, with building
// its acceleration structure. Measured from frame to frame; first as on a usual machine.
struct TravelCosts {
  double ray = 4e-7, cluster_byte = 4e-9;
};

// What a rank has of the geometry, all ranks know of each other, and clusters that came from
// others. One per rank; parallel only where it says so.
class SharedScene {
 public:
  // Collective. Every rank cuts an equal part of the triangles, in their order in the scene, into
  // clusters; `scene` has to be complete on every rank, and may be destroyed afterwards.
  static SharedScene make(comm::Communicator& communicator, const scenes::Scene& scene,
                          const ShareOptions& options);
  // Of a scene whose shader was taken from it, or is at hand.
  static SharedScene make(comm::Communicator& communicator, const scenes::Scene& scene,
                          shading::Shader shader, const ShareOptions& options);
  // Collective. Of a part that no other rank has; all parts together are the whole scene, and no
  // rank ever has more than its own. Nothing in a part may glow.
  static SharedScene make(comm::Communicator& communicator, scenes::ScenePart&& part,
                          const ShareOptions& options);
  // Of a pack whose surfaces do not glow: every rank reads clusters from the file when rays want
  // them, and none travels. `scene` is what the pack has besides triangles, with the lights, `box`
  // the extent of the whole. Refers to pack and scene. For distributions that fetch clusters and
  // send no rays. Not collective; frames may throw files::FileError.
  static SharedScene of_pack(const packs::PackReader& pack, const scenes::Scene& scene,
                             const geometry::Box3& box, const ShareOptions& options);
  // Collective. The clusters are this rank's part, shader and lights are those of the whole scene.
  SharedScene(comm::Communicator& communicator, shading::Shader shader, LightTable lights,
              std::vector<ClusterData>&& mine, const ShareOptions& options);

  const shading::Shader& shader() const { return shader_; }
  const LightTable& lights() const { return lights_; }
  geometry::Box3 bounds() const { return bounds_; }
  std::uint32_t clusters() const { return static_cast<std::uint32_t>(owners_.size()); }
  // A rank, or kFile.
  static constexpr int kFile = -1;
  int owner(std::uint32_t cluster) const { return owners_[cluster]; }
  // The pack that clusters are read from, where no rank owns any; otherwise null.
  const PackedClusters* file() const { return file_.get(); }
  std::uint64_t packed_bytes(std::uint32_t cluster) const { return packed_bytes_[cluster]; }
  bool compresses() const { return compresses_; }
  // Whether any instance of the whole scene is an Embree instance, or can be seen through.
  bool has_instances() const { return has_instances_; }

  // Parallel. To be called before a frame: gathers clusters that this rank owns by now into the
  // resident scene, and those of the cache while it has room for all that is used: at once where it
  // has room for the whole scene, else when rays have spent as much on them one by one as building
  // will take.
  // Where clusters had to be dropped in the last frame, those that most rays met stay until the
  // next one, and become resident in the same way. With `chooses` clusters that are worth less than
  // others, which rays were sent for lately, leave the cache before.
  void begin_frame(bool chooses = false);
  // Most of what is at hand, as one scene.
  const ClusterScene& resident() const { return *resident_; }
  bool is_resident(std::uint32_t cluster) const { return is_resident_[cluster] != 0; }
  // The boxes of all that is not resident.
  const ClusterTree& elsewhere() const { return elsewhere_; }
  // All boxes.
  const ClusterTree& everywhere() const { return everywhere_; }

  // Parallel. A cluster that is at hand, but not resident; null where it is not. A use of what came
  // from another rank keeps it longest.
  std::shared_ptr<const ClusterScene> find(std::uint32_t cluster);
  // What `find` found has been intersected with so many rays.
  void note_tests(std::uint64_t rays) { tests_ += rays; }
  // Parallel. Makes what came from another rank ready for rays, and drops what was not used for
  // longest, and is not kept, while there is too much.
  std::shared_ptr<const ClusterScene> put(std::uint32_t cluster, ClusterData&& data);
  // Rays have been sent to the owner of a cluster instead of fetching it.
  void note_wanted(std::uint32_t cluster, std::uint64_t rays) {
    wanted_[cluster] += static_cast<double>(rays);
  }
  // Such rays, those of each frame counted half as much in the next one.
  double wanted(std::uint32_t cluster) const { return wanted_[cluster]; }
  // Whether the cluster will fit into the cache beside those that are there or expected.
  bool has_room_for(std::uint32_t cluster) const {
    return cached_bytes_ + expected_bytes_ + bytes_in_cache(cluster) <= cache_limit_;
  }
  // It has been asked for; `put` follows.
  void expect(std::uint32_t cluster) { expected_bytes_ += bytes_in_cache(cluster); }
  const TravelCosts& travel_costs() const { return costs_; }
  // So many rays took so long to be sent and answered, here and elsewhere.
  void note_travel(std::uint64_t rays, double seconds);

  // Owned clusters that change rank for good. One that was resident stays so until the next frame,
  // when one that was taken over becomes resident.
  void give_away(std::uint32_t cluster);
  void take_over(std::uint32_t cluster, ClusterData&& data);
  // Collective, between frames. Until then owner() is who had a cluster before.
  void learn_owners(comm::Communicator& communicator);
  bool owns(std::uint32_t cluster) const { return owned_.contains(cluster); }
  const std::unordered_map<std::uint32_t, std::shared_ptr<const Cluster>>& owned() const {
    return owned_;
  }

  // Of the upper part of the hierarchy, which every rank has.
  std::uint64_t tree_bytes() const {
    return elsewhere_.bytes() + everywhere_.bytes() + boxes_.capacity() * sizeof(ClusterBox);
  }
  // Bytes of geometry, acceleration structures and the tree: now, and the most there ever were.
  std::uint64_t bytes() const;
  std::uint64_t most_bytes() const { return most_bytes_; }
  std::uint64_t cache_bytes() const { return cache_limit_; }
  std::uint64_t cached_bytes() const { return cached_bytes_; }
  // Whether the cache is large enough for all clusters of other ranks.
  bool has_room_for_all() const { return has_room_for_all_; }
  std::uint64_t evicted() const { return evicted_; }
  double build_seconds() const { return build_seconds_; }
  std::string embree_version() const { return device_.version(); }
  std::string embree_isa() const { return device_.isa(); }
  std::uint64_t degenerate() const { return degenerate_; }

 private:
  SharedScene(std::unique_ptr<const PackedClusters> file, shading::Shader shader, LightTable lights,
              const ShareOptions& options);
  void set_boxes(std::vector<ClusterBox>&& boxes);
  void note_bytes();
  void drop_old();
  // Clusters of the cache that are resident beside those that this rank owns. Within a frame none
  // may join: rays that have been intersected with what is resident would pass it by.
  enum class Joined : std::uint8_t { none, kept, all };
  void gather(Joined joined);
  void give_up_resident();
  void make_resident(const std::vector<std::uint8_t>& joins);  // by cluster of the cache
  void keep_what_rays_met();
  bool joins(std::uint32_t cluster, Joined joined) const {
    return joined == Joined::all || (joined == Joined::kept && is_kept_[cluster] != 0);
  }
  std::uint64_t missing_triangles(Joined joined) const;
  bool drop_least_wanted();
  void drop(std::uint32_t cluster);
  // An estimate, before it is there.
  std::uint64_t bytes_in_cache(std::uint32_t cluster) const {
    return static_cast<std::uint64_t>(bytes_with_structure_ *
                                      static_cast<double>(packed_bytes_[cluster]));
  }
  std::shared_ptr<const ClusterScene> alone(const std::shared_ptr<const Cluster>& cluster) const;

  struct Cached {
    std::shared_ptr<const Cluster> cluster;
    std::shared_ptr<const ClusterScene> scene;  // null while it is resident
    std::uint64_t bytes = 0;                    // with its own structure, whether it has one or not
    std::list<std::uint32_t>::iterator use;     // of those that are not kept
  };
  std::unique_ptr<const PackedClusters> file_;
  shading::Shader shader_;
  std::vector<LeastAlpha> alphas_;  // of its textures
  LightTable lights_;
  BuildOptions build_;
  EmbreeDevice device_;            // of what comes later
  std::vector<ClusterBox> boxes_;  // of all clusters
  geometry::Box3 bounds_;
  std::unique_ptr<ClusterScene> resident_;
  std::vector<std::uint8_t> is_resident_;  // by cluster
  ClusterTree elsewhere_, everywhere_;
  std::vector<int> owners_;                  // by cluster
  std::vector<std::uint64_t> packed_bytes_;  // by cluster
  std::unordered_map<std::uint32_t, std::shared_ptr<const Cluster>> owned_;
  std::unordered_map<std::uint32_t, Cached> cached_;
  std::list<std::uint32_t> uses_;  // clusters that may be dropped, what was used last at the front
  std::uint64_t cached_bytes_ = 0, most_bytes_ = 0, cache_limit_ = 0, evicted_ = 0;
  std::vector<std::uint32_t> taken_over_;  // clusters, whose owners others do not know yet
  std::uint64_t given_bytes_ = 0;          // of clusters that are resident, but not owned any more
  Joined joined_ = Joined::none;
  std::vector<std::uint8_t> is_kept_;  // by cluster: stays in the cache until the next frame
  bool has_room_for_all_ = false;
  int builds_ = 0;  // of a resident scene as a whole
  // Rays against single clusters since the resident scene changed, how many triangles are worth
  // one, and what had been evicted when the last frame began.
  std::uint64_t tests_ = 0, triangles_per_test_ = 4, evicted_before_ = 0;
  // By cluster: see wanted(), and rays that have been intersected with it alone.
  std::vector<double> wanted_;
  std::uint64_t expected_bytes_ = 0;
  double bytes_with_structure_ = 3.0;  // of clusters in the cache, for each byte of their geometry
  TravelCosts costs_;
  bool has_instances_ = false, compresses_ = false;
  double build_seconds_ = 0.0;
  std::uint64_t degenerate_ = 0;
};

}  // namespace delray::raytrace
