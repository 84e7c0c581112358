// Cuts this rank's part of a scene into clusters and tells all ranks their boxes and sizes.
// Clusters assigned at random go by a hash of seed, rank and number. O(triangles of the part) and
// one message to all.
//
// Degenerate: a rank may own none.
#include "raytrace/shared_scene.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <utility>

#include "comm/collectives.h"
#include "parallel/parallel_for.h"
#include "raytrace/clusters/voxels.h"

namespace delray::raytrace {
namespace {

// Clusters for each rank, at least, and triangles of one, at least and at most: enough that a cache
// of a tenth of the scene holds many, and large enough that a ray meets few.
constexpr std::uint64_t kClusters = 64, kFewestTriangles = 64, kMostTriangles = 1 << 14;

// Bytes that a cluster takes with its acceleration structure, for each byte of its geometry, at
// most.
constexpr std::uint64_t kBytesWithStructure = 4;

std::uint32_t triangles_of_cluster(std::uint64_t all, int ranks) {
  const std::uint64_t share = all / (kClusters * static_cast<std::uint64_t>(ranks));
  return static_cast<std::uint32_t>(std::clamp(share, kFewestTriangles, kMostTriangles));
}

// At most, of a scene of so many.
std::uint32_t most_triangles(const ShareOptions& options, std::uint64_t all, int ranks) {
  if (options.most_triangles > 0) return options.most_triangles;
  if (options.cut_level < 0) return triangles_of_cluster(all, ranks);
  const std::uint64_t subtrees = std::uint64_t{1} << std::min(options.cut_level, 31);
  return static_cast<std::uint32_t>(
      std::clamp<std::uint64_t>((all + subtrees - 1) / subtrees, 1, ~std::uint32_t{0}));
}

// Of a scene of so many triangles within the box, this rank's clusters, from the triangles [begin,
// end) of the instances: as they were cut, or, of voxels, those that were dealt to it. Collective.
struct Triangles {
  std::uint64_t all, begin, end;
  std::uint32_t first;  // the first one's number in its mesh
};
std::vector<ClusterData> divide(comm::Communicator& communicator,
                                std::span<const GeometryInstance> instances,
                                const Triangles& triangles, const geometry::Box3& box,
                                const ShareOptions& options) {
  const std::uint32_t most = most_triangles(options, triangles.all, communicator.size());
  if (options.division == ShareOptions::Division::clusters)
    return cut_clusters(instances, triangles.begin, triangles.end, most, triangles.first);
  const VoxelGrid grid = voxel_grid(box, triangles.all, communicator.size());
  return deal_voxels(
      communicator,
      cut_voxels(instances, triangles.begin, triangles.end, grid, most, triangles.first), grid,
      options.seed);
}

// What every rank knows of a cluster.
struct Known {
  std::uint64_t packed_bytes = 0;
  std::uint32_t boxes = 0;
  std::uint32_t instanced = 0;
};

std::uint64_t scattered(std::uint64_t x) {  // the finaliser of SplitMix64
  x += 0x9E3779B97F4A7C15U;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9U;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBU;
  return x ^ (x >> 31);
}

// The rank that cluster i of n of a rank goes to, by chance.
int random_owner(const comm::Communicator& communicator, std::size_t i, std::uint64_t seed) {
  const std::uint64_t key =
      scattered(seed ^ scattered(i * 65537 + static_cast<std::uint64_t>(communicator.rank())));
  return static_cast<int>(key % static_cast<std::uint64_t>(communicator.size()));
}

// The same so that neighbours stay together, and each rank has clusters from both ends of the
// scene: seldom are both what most of the picture shows.
int neighbours_owner(const comm::Communicator& communicator, std::size_t i, std::size_t n) {
  const int rank = communicator.rank();
  return i < (n + 1) / 2 ? rank : communicator.size() - 1 - rank;
}

// Every rank's clusters to those who get them: owners[i] gets mine[i]. Collective.
std::vector<ClusterData> assigned(comm::Communicator& communicator, std::vector<ClusterData>&& mine,
                                  std::span<const int> owners) {
  std::vector<comm::Parcel> parcels;
  std::vector<ClusterData> result;
  for (std::size_t i = 0; i < mine.size(); ++i) {
    if (owners[i] == communicator.rank()) {
      result.push_back(std::move(mine[i]));
    } else {
      parcels.push_back({owners[i], pack(mine[i])});
      mine[i] = {};
    }
  }
  for (comm::Parcel& parcel : comm::exchange(communicator, std::move(parcels))) {
    result.push_back(unpack_cluster({parcel.message.data(), parcel.message.size()}));
    parcel.message = {};
  }
  return result;
}

// The lights of a scene, none of which is a surface. How strong they are beside each other goes by
// how large the whole scene is: for that its diagonal stands for it.
LightTable lights_around(const scenes::Scene& scene, const geometry::Box3& box,
                         const shading::Shader& shader) {
  scenes::Scene rest;
  rest.materials = scene.materials;
  rest.textures = scene.textures;
  rest.lights = scene.lights;
  rest.environment = scene.environment;
  rest.meshes.emplace_back();
  rest.instances.emplace_back();
  if (!box.empty()) rest.meshes[0].positions = {box.low, box.high};
  return LightTable(rest, shader);
}

}  // namespace

SharedScene SharedScene::make(comm::Communicator& communicator, const scenes::Scene& scene,
                              const ShareOptions& options) {
  return make(communicator, scene, shading::make_shader(scene), options);
}

SharedScene SharedScene::make(comm::Communicator& communicator, const scenes::Scene& scene,
                              shading::Shader shader, const ShareOptions& options) {
  std::vector<ClusterData> mine;
  {
    const std::vector<GeometryInstance> instances =
        make_instances(scene, shader, options.build.share_meshes);
    const std::uint64_t all = stored_triangles(instances);
    const auto ranks = static_cast<std::uint64_t>(communicator.size());
    const auto rank = static_cast<std::uint64_t>(communicator.rank());
    mine = divide(communicator, instances, {all, all * rank / ranks, all * (rank + 1) / ranks, 0},
                  scenes::bounds(scene), options);
  }
  LightTable lights(scene, shader);
  return SharedScene(communicator, std::move(shader), std::move(lights), std::move(mine), options);
}

SharedScene SharedScene::make(comm::Communicator& communicator, scenes::ScenePart&& part,
                              const ShareOptions& options) {
  shading::Shader shader = shading::make_shader(part.scene);
  const geometry::Box3 box = comm::all_reduce_value(communicator, scenes::bounds(part.scene),
                                                    [](geometry::Box3 a, const geometry::Box3& b) {
                                                      a.include(b);
                                                      return a;
                                                    });
  std::vector<ClusterData> mine;
  {
    const std::vector<GeometryInstance> instances =
        make_instances(part.scene, shader, options.build.share_meshes);
    mine =
        divide(communicator, instances,
               {part.triangles, 0, stored_triangles(instances), part.first_triangle}, box, options);
  }
  LightTable lights = lights_around(part.scene, box, shader);
  return SharedScene(communicator, std::move(shader), std::move(lights), std::move(mine), options);
}

SharedScene::SharedScene(comm::Communicator& communicator, shading::Shader shader,
                         LightTable lights, std::vector<ClusterData>&& mine,
                         const ShareOptions& options)
    : shader_(std::move(shader)),
      alphas_(least_alphas(shader_)),
      lights_(std::move(lights)),
      build_(options.build),
      device_(build_),
      compresses_(options.compresses) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<int> owners;
  const bool is_dealt = options.division != ShareOptions::Division::clusters;
  for (std::size_t i = 0; i < mine.size() && !is_dealt; ++i) {
    owners.push_back(options.assignment == ShareOptions::Assignment::random
                         ? random_owner(communicator, i, options.seed)
                         : neighbours_owner(communicator, i, mine.size()));
  }
  if (!is_dealt) mine = assigned(communicator, std::move(mine), owners);

  // What there is to know of this rank's clusters, then their boxes.
  std::vector<Known> known;
  std::vector<geometry::Box3> boxes;
  for (const ClusterData& cluster : mine) {
    const std::vector<geometry::Box3> more = boxes_of(cluster);
    const bool instanced = std::any_of(cluster.instances.begin(), cluster.instances.end(),
                                       [](const GeometryInstance& p) { return p.instanced; });
    known.push_back(
        {cluster.bytes(), static_cast<std::uint32_t>(more.size()), instanced ? 1U : 0U});
    boxes.insert(boxes.end(), more.begin(), more.end());
  }
  const std::uint64_t count = known.size();
  comm::Buffer message(sizeof(count) + known.size() * sizeof(Known) +
                       boxes.size() * sizeof(geometry::Box3));
  std::memcpy(message.data(), &count, sizeof(count));
  if (!known.empty())
    std::memcpy(message.data() + sizeof(count), known.data(), known.size() * sizeof(Known));
  if (!boxes.empty()) {
    std::memcpy(message.data() + sizeof(count) + known.size() * sizeof(Known), boxes.data(),
                boxes.size() * sizeof(geometry::Box3));
  }

  std::vector<ClusterBox> all_boxes;
  std::uint32_t first_mine = 0;
  const std::vector<comm::Buffer> messages = comm::all_gather(communicator, std::move(message));
  for (int rank = 0; rank < communicator.size(); ++rank) {
    const std::byte* at = messages[rank].data();
    std::uint64_t clusters = 0;
    std::memcpy(&clusters, at, sizeof(clusters));
    at += sizeof(clusters);
    const std::byte* box_at = at + clusters * sizeof(Known);
    if (rank == communicator.rank()) first_mine = static_cast<std::uint32_t>(owners_.size());
    for (std::uint64_t i = 0; i < clusters; ++i) {
      Known each;
      std::memcpy(&each, at + i * sizeof(Known), sizeof(Known));
      const auto number = static_cast<std::uint32_t>(owners_.size());
      for (std::uint32_t b = 0; b < each.boxes; ++b, box_at += sizeof(geometry::Box3)) {
        ClusterBox& box = all_boxes.emplace_back();
        std::memcpy(&box.box, box_at, sizeof(geometry::Box3));
        box.cluster = number;
      }
      owners_.push_back(rank);
      packed_bytes_.push_back(each.packed_bytes);
      has_instances_ = has_instances_ || each.instanced != 0;
    }
  }
  set_boxes(std::move(all_boxes));

  std::vector<std::shared_ptr<const Cluster>> ready(mine.size());
  std::vector<std::uint64_t> degenerate(mine.size());
  parallel::parallel_for(0, mine.size(), 1, [&](std::size_t i) {
    ready[i] = std::make_shared<const Cluster>(std::move(mine[i]), shader_, alphas_);
    degenerate[i] = count_degenerate(ready[i]->instances());
  });
  for (std::size_t i = 0; i < ready.size(); ++i) {
    degenerate_ += degenerate[i];
    owned_.emplace(first_mine + static_cast<std::uint32_t>(i), std::move(ready[i]));
  }
  std::uint64_t bytes_of_others = 0;
  for (std::size_t i = 0; i < owners_.size(); ++i)
    bytes_of_others += owners_[i] == communicator.rank() ? 0 : packed_bytes_[i];
  has_room_for_all_ = options.cache_bytes >= kBytesWithStructure * bytes_of_others;
  gather(Joined::none);
  const std::uint64_t all_bytes = comm::all_reduce_value(communicator, bytes(), std::plus<>());
  cache_limit_ = options.cache_bytes > 0 ? options.cache_bytes : all_bytes / 10;
  degenerate_ = comm::all_reduce_value(communicator, degenerate_, std::plus<>());
  note_bytes();
  build_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

SharedScene::SharedScene(std::unique_ptr<const PackedClusters> file, shading::Shader shader,
                         LightTable lights, const ShareOptions& options)
    : file_(std::move(file)),
      shader_(std::move(shader)),
      alphas_(least_alphas(shader_)),
      lights_(std::move(lights)),
      build_(options.build),
      device_(build_) {
  std::uint64_t all = 0;
  for (std::uint32_t i = 0; i < file_->size(); ++i) {
    packed_bytes_.push_back(file_->bytes(i));
    all += packed_bytes_.back();
    has_instances_ = has_instances_ || file_->is_instanced(i);
  }
  owners_.assign(file_->size(), kFile);
  set_boxes(std::vector<ClusterBox>(file_->boxes()));
  has_room_for_all_ = options.cache_bytes >= kBytesWithStructure * all;
  cache_limit_ = options.cache_bytes > 0 ? options.cache_bytes : kBytesWithStructure * all / 10;
  gather(Joined::none);
}

SharedScene SharedScene::of_pack(const packs::PackReader& pack, const scenes::Scene& scene,
                                 const geometry::Box3& box, const ShareOptions& options) {
  shading::Shader shader = shading::make_shader(scene);
  LightTable lights = lights_around(scene, box, shader);
  auto file =
      std::make_unique<const PackedClusters>(pack, scene, shader, options.build.share_meshes);
  return SharedScene(std::move(file), std::move(shader), std::move(lights), options);
}

void SharedScene::set_boxes(std::vector<ClusterBox>&& boxes) {
  for (const ClusterBox& box : boxes) bounds_.include(box.box);
  boxes_ = std::move(boxes);
  everywhere_ = ClusterTree(boxes_);
  is_resident_.assign(owners_.size(), 0);
  is_kept_.assign(owners_.size(), 0);
  wanted_.assign(owners_.size(), 0.0);
}

}  // namespace delray::raytrace
