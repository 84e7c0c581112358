// What of a shared scene is at hand: the rank's own clusters, and those of other ranks in a cache
// that drops what was not used for longest.
//
// Every rank knows all boxes. Its own clusters are one scene, which clusters of the cache join when
// that pays; all others are in a tree, by which rays find what they have not been tested against.
//
// Degenerate: a cluster that is larger than the cache stays until another one comes.
#include <algorithm>
#include <cstring>
#include <iterator>
#include <map>
#include <utility>

#include "comm/bad_message.h"
#include "comm/collectives.h"
#include "parallel/processor_time.h"
#include "raytrace/distributed/kept_clusters.h"
#include "raytrace/shared_scene.h"

namespace delray::raytrace {
namespace {

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

}  // namespace

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
