// Cuts this rank's part of a scene into clusters, tells all ranks their boxes and sizes, and keeps
// clusters of other ranks in a cache that drops what was not used for longest.
//
// Every rank knows all boxes. Its own clusters are one scene, which clusters of the cache join when
// that pays; all others are in a tree, by which rays find what they have not been tested against.
// Clusters assigned at random go by a hash of seed, rank and number. O(triangles of the part) and
// one message to all.
//
// Degenerate: a cluster that is larger than the cache stays until another one comes; a rank may own
// none.
#include "raytrace/shared_scene.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <iterator>
#include <map>
#include <utility>

#include "comm/bad_message.h"
#include "comm/collectives.h"
#include "parallel/parallel_for.h"
#include "parallel/processor_time.h"
#include "raytrace/distributed/kept_clusters.h"

namespace delray::raytrace {
namespace {

// Clusters for each rank, at least, and triangles of one, at least and at most: enough that a cache
// of a tenth of the scene holds many, and large enough that a ray meets few.
constexpr std::uint64_t kClusters = 64, kFewestTriangles = 64, kMostTriangles = 1 << 14;

// Bytes that a cluster takes with its acceleration structure, for each byte of its geometry, at
// most.
constexpr std::uint64_t kBytesWithStructure = 4;

// Seconds that a byte takes in a message, beside the processor's.
constexpr double kSecondsPerByte = 1e-9;

// A ray there and back, about.
constexpr double kRayBytes = 200;

// A new measurement counts so much.
constexpr double kNew = 0.25;

// What became of rays that wanted a cluster from one frame to the next. Resident clusters are
// forgotten slowly, as rays that meet them are not counted.
constexpr double kStillWanted = 0.5, kStillWantedAtHand = 0.9;

// Of the cache, for clusters that come and go: one part in so many.
constexpr std::uint64_t kShareOfOthers = 4;

// A cluster takes another one's place if it is so many times as much wanted.
constexpr double kMuchMoreWanted = 2.0;

double processor_seconds() {
  return 1e-9 * static_cast<double>(parallel::quick_processor_nanoseconds());
}

std::uint32_t triangles_of_cluster(std::uint64_t all, int ranks) {
  const std::uint64_t share = all / (kClusters * static_cast<std::uint64_t>(ranks));
  return static_cast<std::uint32_t>(std::clamp(share, kFewestTriangles, kMostTriangles));
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
    const std::uint32_t most = options.most_triangles > 0
                                   ? options.most_triangles
                                   : triangles_of_cluster(all, communicator.size());
    mine = cut_clusters(instances, all * rank / ranks, all * (rank + 1) / ranks, most);
  }
  LightTable lights(scene, shader);
  return SharedScene(communicator, std::move(shader), std::move(lights), std::move(mine), options);
}

SharedScene SharedScene::make(comm::Communicator& communicator, scenes::ScenePart&& part,
                              const ShareOptions& options) {
  shading::Shader shader = shading::make_shader(part.scene);
  geometry::Box3 box = scenes::bounds(part.scene);
  std::vector<ClusterData> mine;
  {
    const std::vector<GeometryInstance> instances =
        make_instances(part.scene, shader, options.build.share_meshes);
    const std::uint32_t most = options.most_triangles > 0
                                   ? options.most_triangles
                                   : triangles_of_cluster(part.triangles, communicator.size());
    mine = cut_clusters(instances, 0, stored_triangles(instances), most, part.first_triangle);
  }
  box = comm::all_reduce_value(communicator, box, [](geometry::Box3 a, const geometry::Box3& b) {
    a.include(b);
    return a;
  });
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
      device_(build_) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<int> owners;
  for (std::size_t i = 0; i < mine.size(); ++i) {
    owners.push_back(options.assignment == ShareOptions::Assignment::random
                         ? random_owner(communicator, i, options.seed)
                         : neighbours_owner(communicator, i, mine.size()));
  }
  mine = assigned(communicator, std::move(mine), owners);

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

std::uint64_t SharedScene::bytes() const {
  std::uint64_t sum = resident_->bytes() + elsewhere_.bytes() + everywhere_.bytes() + given_bytes_;
  for (const auto& [number, cluster] : owned_) sum += cluster->bytes();
  for (const auto& [number, cached] : cached_) {
    sum += cached.cluster->bytes() + (cached.scene != nullptr ? cached.scene->bytes() : 0);
  }
  return sum;
}

std::shared_ptr<const ClusterScene> SharedScene::alone(
    const std::shared_ptr<const Cluster>& cluster) const {
  // Built in a fraction of the time: it may be dropped soon. Hits are the same.
  BuildOptions quickly = build_;
  quickly.quality = BuildOptions::Quality::low;
  quickly.changing = false;
  return std::make_shared<const ClusterScene>(std::vector{cluster}, quickly, device_);
}

// Between frames.
void SharedScene::gather(Joined joined) {
  std::vector<std::uint8_t> joining(owners_.size());
  for (const auto& [number, cached] : cached_) joining[number] = joins(number, joined) ? 1 : 0;
  make_resident(joining);
  joined_ = joined;
}

// Of the cache, what is not kept.
void SharedScene::give_up_resident() {
  std::vector<std::uint8_t> staying(is_resident_);
  for (const std::uint32_t cluster : uses_) staying[cluster] = 0;
  make_resident(staying);
  joined_ = Joined::kept;
}

void SharedScene::make_resident(const std::vector<std::uint8_t>& joins) {
  // In the order of their numbers, so that a scene is the same in every run.
  std::map<std::uint32_t, std::shared_ptr<const Cluster>> clusters(owned_.begin(), owned_.end());
  for (auto& [number, cached] : cached_) {
    if (joins[number] == 0) continue;
    clusters.emplace(number, cached.cluster);
    cached.scene = nullptr;
  }
  std::fill(is_resident_.begin(), is_resident_.end(), std::uint8_t{0});
  std::vector<std::shared_ptr<const Cluster>> resident;
  for (auto& [number, cluster] : clusters) {
    is_resident_[number] = 1;
    resident.push_back(std::move(cluster));
  }
  if (build_.changing) {
    resident_->change(std::move(resident));
  } else {
    // What has changed twice will do so again. Rays take a little longer in such a scene.
    build_.changing = ++builds_ > 2;
    resident_ = nullptr;  // before there is another one: memory
    resident_ = std::make_unique<ClusterScene>(std::move(resident), build_, device_);
  }
  std::vector<ClusterBox> elsewhere;
  std::copy_if(boxes_.begin(), boxes_.end(), std::back_inserter(elsewhere),
               [&](const ClusterBox& box) { return is_resident_[box.cluster] == 0; });
  elsewhere_ = ClusterTree(std::move(elsewhere));
  given_bytes_ = 0;
  tests_ = 0;
  note_bytes();
}

// Of clusters in the cache that would become resident.
std::uint64_t SharedScene::missing_triangles(Joined joined) const {
  std::uint64_t triangles = 0;
  for (const auto& [number, cached] : cached_)
    if (joins(number, joined) && !is_resident(number)) triangles += cached.cluster->triangles();
  return triangles;
}

// Where rays may travel instead: of clusters of the cache those which take more room than they are
// worth, beside others that are worth fetching. Returns whether one of them was resident.
bool SharedScene::drop_least_wanted() {
  struct Candidate {
    double wanted_per_byte;
    std::uint32_t cluster;
    std::uint64_t bytes;
    bool operator<(const Candidate& b) const {
      return wanted_per_byte != b.wanted_per_byte ? wanted_per_byte < b.wanted_per_byte
                                                  : cluster < b.cluster;
    }
  };
  std::vector<Candidate> here, elsewhere;
  for (std::uint32_t i = 0; i < wanted_.size(); ++i) {
    if (owned_.contains(i)) continue;
    const auto at = cached_.find(i);
    const bool is_here = at != cached_.end();
    const std::uint64_t bytes = is_here ? at->second.bytes : bytes_in_cache(i);
    const double cost = costs_.cluster_byte * static_cast<double>(packed_bytes_[i]);
    if (!is_here && wanted_[i] * costs_.ray < cost) continue;
    (is_here ? here : elsewhere).push_back({wanted_[i] / static_cast<double>(bytes), i, bytes});
  }
  std::sort(here.begin(), here.end());
  std::sort(elsewhere.rbegin(), elsewhere.rend());
  std::uint64_t room = cache_limit_ - std::min(cache_limit_, cached_bytes_);
  auto least = here.begin();
  bool any_resident = false;
  for (const Candidate& wanted : elsewhere) {
    for (; room < wanted.bytes && least != here.end() &&
           wanted.wanted_per_byte > kMuchMoreWanted * least->wanted_per_byte;
         ++least) {
      any_resident = any_resident || is_resident(least->cluster);
      drop(least->cluster);
      room += least->bytes;
    }
    if (room < wanted.bytes) break;
    room -= wanted.bytes;
  }
  evicted_before_ = evicted_;
  return any_resident;
}

void SharedScene::note_travel(std::uint64_t rays, double seconds) {
  if (rays == 0) return;
  const double per_ray = seconds / static_cast<double>(rays) + kRayBytes * kSecondsPerByte;
  costs_.ray += kNew * (per_ray - costs_.ray);
}

void SharedScene::begin_frame(bool chooses) {
  const bool settled = evicted_ == std::exchange(evicted_before_, evicted_);
  for (std::uint32_t i = 0; i < wanted_.size(); ++i)
    wanted_[i] *= is_resident(i) ? kStillWantedAtHand : kStillWanted;
  const bool dropped = chooses && drop_least_wanted();
  if (!chooses && !settled) keep_what_rays_met();
  std::uint64_t owned_triangles = 0;
  bool took_over = false;
  for (const auto& [number, cluster] : owned_) {
    owned_triangles += cluster->triangles();
    took_over = took_over || !is_resident(number);
  }
  const Joined joined = settled ? Joined::all : Joined::kept;
  const std::uint64_t missing = missing_triangles(joined);
  const std::uint64_t cost = missing + (build_.changing ? 0 : owned_triangles);
  // Most of what is seen comes in the first frame.
  const bool at_once = has_room_for_all_ && (build_.changing || 4 * missing >= owned_triangles);
  const bool gathers = missing > 0 && (at_once || tests_ * triangles_per_test_ >= cost);
  const bool holds_too_much = given_bytes_ > (build_.changing ? 0 : bytes() / 8);
  if (took_over || gathers || holds_too_much || dropped) gather(gathers ? joined : joined_);
}

std::shared_ptr<const ClusterScene> SharedScene::find(std::uint32_t cluster) {
  const auto at = cached_.find(cluster);
  if (at == cached_.end()) return nullptr;
  Cached& cached = at->second;
  if (is_kept_[cluster] == 0) uses_.splice(uses_.begin(), uses_, cached.use);
  if (cached.scene == nullptr) cached.scene = alone(cached.cluster);
  return cached.scene;
}

std::shared_ptr<const ClusterScene> SharedScene::put(std::uint32_t cluster, ClusterData&& data) {
  const double begin = processor_seconds();
  auto ready = std::make_shared<const Cluster>(std::move(data), shader_, alphas_);
  auto scene = alone(ready);
  const std::uint64_t bytes = ready->bytes() + scene->bytes();
  expected_bytes_ -= std::min(expected_bytes_, bytes_in_cache(cluster));
  const auto packed = static_cast<double>(packed_bytes_[cluster]);
  costs_.cluster_byte +=
      kNew * ((processor_seconds() - begin) / packed + kSecondsPerByte - costs_.cluster_byte);
  bytes_with_structure_ = std::max(bytes_with_structure_, static_cast<double>(bytes) / packed);
  cached_bytes_ += bytes;
  const auto use = is_kept_[cluster] != 0 ? uses_.end() : uses_.insert(uses_.begin(), cluster);
  cached_.emplace(cluster, Cached{std::move(ready), scene, bytes, use});
  drop_old();
  note_bytes();
  return scene;
}

void SharedScene::give_away(std::uint32_t cluster) {
  const auto own = owned_.find(cluster);
  if (is_resident(cluster)) given_bytes_ += own->second->bytes();
  owned_.erase(own);
}

void SharedScene::take_over(std::uint32_t cluster, ClusterData&& data) {
  owned_.emplace(cluster, std::make_shared<const Cluster>(std::move(data), shader_, alphas_));
  taken_over_.push_back(cluster);
  note_bytes();
}

void SharedScene::learn_owners(comm::Communicator& communicator) {
  const std::span<const std::uint32_t> mine = taken_over_;
  const std::vector<comm::Buffer> messages =
      comm::all_gather(communicator, comm::Buffer::of(std::as_bytes(mine)));
  for (int rank = 0; rank < communicator.size(); ++rank) {
    const comm::Buffer& message = messages[static_cast<std::size_t>(rank)];
    comm::check_message(message.size() % sizeof(std::uint32_t) == 0);
    for (std::size_t at = 0; at < message.size(); at += sizeof(std::uint32_t)) {
      std::uint32_t cluster = 0;
      std::memcpy(&cluster, message.data() + at, sizeof cluster);
      comm::check_message(cluster < owners_.size());
      owners_[cluster] = rank;
    }
  }
  taken_over_.clear();
}

// Most of the cache is for clusters that most rays met, until the next frame.
void SharedScene::keep_what_rays_met() {
  std::vector<MetCluster> met;
  std::uint64_t largest = 0;
  for (std::uint32_t i = 0; i < wanted_.size(); ++i) {
    if (owned_.contains(i) || wanted_[i] <= 0.0) continue;
    const auto at = cached_.find(i);
    const std::uint64_t bytes = at != cached_.end() ? at->second.bytes : bytes_in_cache(i);
    largest = std::max(largest, bytes);
    met.push_back({i, wanted_[i], bytes, is_kept_[i] != 0});
  }
  const std::uint64_t for_others = std::max(largest, cache_limit_ / kShareOfOthers);
  is_kept_.assign(is_kept_.size(), 0);
  for (const std::uint32_t cluster :
       choose_kept(std::move(met), cache_limit_ - std::min(cache_limit_, for_others)))
    is_kept_[cluster] = 1;
  for (auto& [number, cached] : cached_) {
    const bool listed = cached.use != uses_.end();
    if (is_kept_[number] != 0 && listed) {
      uses_.erase(cached.use);
      cached.use = uses_.end();
    } else if (is_kept_[number] == 0 && !listed) {
      cached.use = uses_.insert(uses_.end(), number);
    }
  }
}

void SharedScene::drop_old() {
  while (cached_bytes_ > cache_limit_ && uses_.size() > 1) {
    if (is_resident(uses_.back())) {
      // Memory comes back only when the scene is made without them, which should not happen often.
      if (joined_ == Joined::all)
        triangles_per_test_ = std::max<std::uint64_t>(1, triangles_per_test_ / 2);
      give_up_resident();
    }
    drop(uses_.back());
  }
}

void SharedScene::drop(std::uint32_t cluster) {
  const auto at = cached_.find(cluster);
  cached_bytes_ -= at->second.bytes;
  if (at->second.use != uses_.end()) uses_.erase(at->second.use);
  cached_.erase(at);
  ++evicted_;
}

void SharedScene::note_bytes() { most_bytes_ = std::max(most_bytes_, bytes()); }

}  // namespace delray::raytrace
