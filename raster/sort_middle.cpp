// Sort-middle: ranks transform, cull and, with gouraud, light the primitives that they have; the
// triangles that are left go to the ranks whose regions they touch, which draw them.
//
// Each cluster of the whole scene has a number that ascends with its primitives, known from a sum
// over the ranks before. So what arrives may be drawn in any order, and equal depths still go to
// the lowest primitive. What touches its own rank's regions is drawn as it is, without travelling.
#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <stdexcept>

#include "comm/collectives.h"
#include "loadbalance/region_index.h"
#include "parallel/parallel_for.h"
#include "raster/internal/cull.h"
#include "raster/internal/frame_memory.h"
#include "raster/internal/gather_regions.h"
#include "raster/internal/processor_seconds.h"
#include "raster/internal/rank.h"
#include "raster/internal/samples.h"
#include "raster/internal/set_up.h"
#include "raster/internal/transformed_clusters.h"

namespace delray::raster {
namespace {

constexpr comm::Tag kTagTriangles = 81;
// Sent as soon as there are so many bytes for a rank, where triangles are sent at once.
constexpr std::size_t kMessageBytes = std::size_t{1} << 16;
// Clusters whose geometry is done before arrivals are looked for.
constexpr std::size_t kBatchClusters = 256;
constexpr std::size_t kGrain = 8;  // clusters of a task

// Ranks 0 .. geometry - 1 have the primitives; those from first_rasterizer on draw.
struct Roles {
  int geometry = 0, first_rasterizer = 0;
};

Roles roles_of(const Rank& rank) {
  const int n = rank.ranks();
  if (rank.options.groups == Groups::one || n == 1) return {n, 0};
  const int geometry = rank.options.geometry_ranks > 0 ? rank.options.geometry_ranks : n / 2;
  return {geometry, geometry};
}

// Gives the list's clusters the numbers that they have among those of all ranks, and makes room for
// the others. Returns the numbers. Collective.
std::vector<std::uint32_t> number_globally(Rank& rank, DrawList& list) {
  const std::uint64_t mine = list.clusters.size() * std::uint64_t{kNumbersPerCluster};
  std::uint64_t before = mine;
  comm::exclusive_scan(rank.communicator, std::span(&before, 1), std::uint64_t{0}, std::plus<>());
  const std::uint64_t all = comm::all_reduce_value(rank.communicator, mine, std::plus<>());
  if (all >= (1U << (32 - kClusterBits)))
    throw std::length_error("sort-middle cannot rasterize more than 16 million clusters");
  std::vector<Cluster> clusters(all);
  std::vector<std::uint32_t> numbers;
  numbers.reserve(list.clusters.size());
  for (const Cluster& cluster : list.clusters) {
    numbers.push_back(static_cast<std::uint32_t>(before));
    clusters[before] = cluster;
    before += kNumbersPerCluster;
  }
  list.clusters = std::move(clusters);
  return numbers;
}

// What becomes of a few clusters.
struct Sorted {
  struct Parcel {
    int to;
    std::uint64_t triangles = 0;
    std::vector<std::byte> bytes = {};
  };
  std::vector<Parcel> parcels;
  std::vector<std::uint32_t> staying;  // clusters that touch the rank's own regions
  std::uint64_t culled = 0;            // triangles of clusters that do not stay

  Parcel& parcel_to(int rank) {
    const auto found = std::find_if(parcels.begin(), parcels.end(),
                                    [&](const Parcel& parcel) { return parcel.to == rank; });
    return found != parcels.end() ? *found : parcels.emplace_back(Parcel{rank});
  }
};

// Finds out who draws what. One per thread and task.
class Sorter {
 public:
  Sorter(const Rank& rank, const RegionDrawing& drawing, const loadbalance::RegionIndex& regions)
      : rank_(rank), drawing_(drawing), regions_(regions) {}

  void sort(std::uint32_t number, Sorted& sorted) {
    const Cluster& cluster = drawing_.frame().list.clusters[number];
    const PreparedDraw& draw = drawing_.draws()[cluster.draw];
    const ClusterBlock& block = drawing_.frame().list.block_of(cluster);
    const MeshCluster& mesh_cluster = block.clusters[cluster.part];
    const ClusterBounds bounds = bound(rank_.screen, draw, mesh_cluster.box);
    find_owners(bounds.pixels);
    if (bounds.outside || owners_.empty() ||
        shows_hidden_side_only(rank_.screen, draw, mesh_cluster, bounds)) {
      sorted.culled += cluster.end - cluster.begin;
      return;
    }
    if (owners_.size() == 1 && owners_[0] == rank_.number()) {
      sorted.staying.push_back(number);
      return;
    }
    transform(draw.to_view, rank_.screen, draw.draw->mesh->positions,
              block.vertices_of(mesh_cluster), vertices());
    const bool stays = find_receivers(draw, block, cluster);
    if (stays)
      sorted.staying.push_back(number);
    else
      sorted.culled += cluster.end - cluster.begin - places_.size();
    pack(draw, number, sorted);
  }

 private:
  static ScreenVertices& vertices() {
    static thread_local ScreenVertices of_thread;
    return of_thread;
  }
  static ClusterPacker& packer() {
    static thread_local ClusterPacker of_thread;
    return of_thread;
  }

  void find_owners(const geometry::Rect& samples) {
    regions_.owners_of(pixels_of(samples, rank_.options.supersampling), owners_);
  }

  // Whether anything is for this rank itself. What others get is in places_ and receivers_.
  bool find_receivers(const PreparedDraw& draw, const ClusterBlock& block, const Cluster& cluster) {
    bool stays = false;
    places_.clear();
    receivers_.clear();
    const bool one_owner = owners_.size() == 1;
    for (std::uint32_t place = cluster.begin; place < cluster.end; ++place) {
      geometry::Rect box{std::numeric_limits<int>::max(), std::numeric_limits<int>::max(), 0, 0};
      const Fate fate = set_up(
          rank_.screen, draw, vertices(), corners_at(block, block.clusters[cluster.part], place),
          cluster.first + place, 0, [&](const ScreenTriangle&, const geometry::Rect& pixels) {
            box = {std::min(box.x0, pixels.x0), std::min(box.y0, pixels.y0),
                   std::max(box.x1, pixels.x1), std::max(box.y1, pixels.y1)};
          });
      if (fate == Fate::culled) continue;
      if (!one_owner) find_owners(box);
      bool travels = false;
      for (const int owner : owners_) {
        if (owner == rank_.number()) {
          stays = true;
          continue;
        }
        travels = true;
        receivers_.emplace_back(owner, static_cast<std::uint8_t>(places_.size()));
      }
      if (travels) places_.push_back(static_cast<std::uint8_t>(place));
    }
    return stays;
  }

  void pack(const PreparedDraw& draw, std::uint32_t number, Sorted& sorted) {
    if (places_.empty()) return;
    packer().set(drawing_.frame(), draw, number, places_);
    std::sort(receivers_.begin(), receivers_.end());
    for (std::size_t first = 0, last; first < receivers_.size(); first = last) {
      which_.clear();
      for (last = first;
           last < receivers_.size() && receivers_[last].first == receivers_[first].first; ++last)
        which_.push_back(receivers_[last].second);
      Sorted::Parcel& parcel = sorted.parcel_to(receivers_[first].first);
      parcel.triangles += which_.size();
      packer().pack(which_, parcel.bytes);
    }
  }

  const Rank& rank_;
  const RegionDrawing& drawing_;
  const loadbalance::RegionIndex& regions_;
  std::vector<int> owners_;
  std::vector<std::uint8_t> places_, which_;
  std::vector<std::pair<int, std::uint8_t>> receivers_;  // and index into places_
};

// Triangles on their way between ranks.
class Redistributor {
 public:
  // Collective. `boxes` are around everything that this rank may send.
  Redistributor(Rank& rank, const loadbalance::Partition& partition,
                std::span<const loadbalance::WeightedBox> boxes, DrawList& list,
                RegionDrawing& drawing)
      : rank_(rank), regions_(partition), list_(list), drawing_(drawing) {
    // A message at least for each rank that may get something, so that it knows when all is there.
    std::vector<int> senders(static_cast<std::size_t>(rank.ranks())), owners;
    for (const loadbalance::WeightedBox& box : boxes) {
      regions_.owners_of(box.box, owners);
      for (const int owner : owners)
        if (owner != rank.number()) buckets_[owner];
    }
    for (const auto& [to, bucket] : buckets_) senders[to] = 1;
    comm::all_reduce(rank.communicator, std::span(senders), std::plus<>());
    senders_left_ = senders[rank.number()];
  }

  bool all_arrived() const { return senders_left_ == 0; }

  // Does the geometry of clusters of the list. Parallel. Appends those that stay here to `here`.
  void sort(std::span<const std::uint32_t> clusters, std::vector<std::uint32_t>& here) {
    std::vector<Sorted> sorted((clusters.size() + kGrain - 1) / kGrain);
    ProcessorSeconds seconds;
    parallel::parallel_for(0, sorted.size(), 1, [&](std::size_t i) {
      seconds.measure([&] {
        Sorter sorter(rank_, drawing_, regions_);
        const std::size_t first = i * kGrain;
        for (const std::uint32_t number :
             clusters.subspan(first, std::min(kGrain, clusters.size() - first)))
          sorter.sort(number, sorted[i]);
      });
    });
    seconds_ += seconds.seconds();
    for (Sorted& part : sorted) {
      here.insert(here.end(), part.staying.begin(), part.staying.end());
      culled_ += part.culled;
      for (Sorted::Parcel& parcel : part.parcels) {
        Bucket& bucket = buckets_.at(parcel.to);
        bucket.bytes += parcel.bytes.size();
        bucket.parts.push_back(std::move(parcel.bytes));
        rank_.triangles_travelled += parcel.triangles;
      }
    }
  }

  // Adds what sorting took to the rank's counts, which are of drawing until then: that alone
  // depends on how the screen is cut.
  void count_geometry() {
    rank_.counts.phases.transform += seconds_;
    rank_.counts.triangles.in += culled_;
    rank_.counts.triangles.culled += culled_;
  }

  void send_full() {
    for (auto& [to, bucket] : buckets_)
      if (bucket.bytes >= kMessageBytes) send(to, bucket, false);
  }
  void send_rest() {
    for (auto& [to, bucket] : buckets_) send(to, bucket, true);
  }

  // Takes what has arrived, after waiting for something if asked to. Appends the numbers of its
  // clusters to `here`.
  void receive(bool wait, std::vector<std::uint32_t>& here) {
    comm::Communicator& communicator = rank_.communicator;
    while (!all_arrived()) {
      const auto envelope = communicator.probe(
          comm::kAnyRank, kTagTriangles, wait ? comm::Deadline::never() : comm::Deadline::now());
      if (!envelope) return;
      wait = false;
      const comm::Buffer message = communicator.receive(envelope->source, kTagTriangles);
      const auto bytes = message.as<std::byte>();
      std::uint32_t is_last = 0;
      std::memcpy(&is_last, bytes.data(), sizeof(is_last));
      senders_left_ -= static_cast<int>(is_last);
      unpack_clusters(bytes.subspan(sizeof(is_last)), arrived_, list_, here);
    }
  }

 private:
  struct Bucket {
    std::size_t bytes = 0;
    std::vector<std::vector<std::byte>> parts;
  };

  void send(int to, Bucket& bucket, bool is_last) {
    const std::uint32_t flag = is_last ? 1 : 0;
    comm::Buffer message(sizeof(flag) + bucket.bytes);
    std::byte* end = message.data();
    std::memcpy(end, &flag, sizeof(flag));
    end += sizeof(flag);
    for (const std::vector<std::byte>& part : bucket.parts)
      end = std::copy(part.begin(), part.end(), end);
    bucket = {};
    rank_.communicator.send(to, kTagTriangles, std::move(message));
  }

  Rank& rank_;
  const loadbalance::RegionIndex regions_;
  DrawList& list_;
  RegionDrawing& drawing_;
  std::map<int, Bucket> buckets_;  // by receiver
  std::deque<ArrivedMesh> arrived_;
  int senders_left_ = 0;
  double seconds_ = 0;
  std::uint64_t culled_ = 0;
};

// Everything that touches the rank's regions, once it is there.
void draw_at_end(Rank& rank, std::span<const std::uint32_t> own, Redistributor& redistributor,
                 RegionDrawing& drawing) {
  std::vector<std::uint32_t> here;
  rank.communicator.mark(comm::Phase::transform, 0);
  redistributor.sort(own, here);
  rank.communicator.mark(comm::Phase::redistribute, 0);
  timed(rank.communicator, rank.counts.phases.redistribute, [&] {
    redistributor.send_rest();
    while (!redistributor.all_arrived()) redistributor.receive(true, here);
    return true;
  });
  rank.communicator.mark(comm::Phase::rasterize, 0);
  drawing.draw(here);
}

// Whatever is there, while geometry goes on here or elsewhere.
void draw_at_once(Rank& rank, std::span<const std::uint32_t> own, Redistributor& redistributor,
                  RegionDrawing& drawing) {
  comm::Communicator& communicator = rank.communicator;
  std::vector<std::uint32_t> here;
  int round = 0;
  const auto exchange = [&](bool geometry_done) {
    communicator.mark(comm::Phase::redistribute, round);
    timed(communicator, rank.counts.phases.redistribute, [&] {
      if (!geometry_done) redistributor.send_full();
      redistributor.receive(geometry_done && here.empty(), here);
      return true;
    });
    communicator.mark(comm::Phase::rasterize, round++);
    if (!here.empty()) drawing.draw(here);
    here.clear();
  };
  const std::vector<std::uint32_t> order = drawing.nearest_first(own);
  for (std::span<const std::uint32_t> rest = order; !rest.empty();) {
    const auto batch = rest.first(std::min(kBatchClusters, rest.size()));
    rest = rest.subspan(batch.size());
    communicator.mark(comm::Phase::transform, round);
    redistributor.sort(batch, here);
    if (!rest.empty()) exchange(false);
  }
  communicator.mark(comm::Phase::redistribute, round);
  redistributor.send_rest();
  do exchange(true);
  while (!redistributor.all_arrived());
}

template <class Colour>
Picture render(Rank& rank) {
  comm::Communicator& communicator = rank.communicator;
  communicator.mark(comm::Phase::transform, 0);
  const Roles roles = roles_of(rank);
  const auto [begin, end] = rank.own_primitives(roles.geometry);
  const int drawing_ranks = rank.ranks() - roles.first_rasterizer;
  const std::vector<Piece> pieces = pieces_of(rank.scene, rank.first_primitives, begin, end);
  ScreenPartition& screen = rank.memory.screen;
  const std::vector<loadbalance::WeightedBox> boxes =
      screen.boxes_of(rank, groups_of(pieces, ScreenPartition::group_triangles(
                                                  rank.first_primitives.back(),
                                                  drawing_ranks * rank.options.regions_per_rank)));
  DrawList list = make_draw_list(pieces, &rank.clusters);

  communicator.mark(comm::Phase::redistribute, 0);
  const double before_cut = communicator.seconds();
  const std::vector<std::uint32_t> own = number_globally(rank, list);
  loadbalance::Partition partition = screen.cut(rank, boxes, drawing_ranks, roles.first_rasterizer);
  for (loadbalance::Region& region : partition.regions) region.owner += roles.first_rasterizer;
  rank.counts.phases.redistribute += communicator.seconds() - before_cut;
  std::vector<geometry::Rect> regions;
  for (const loadbalance::Region& region : partition.regions)
    if (region.owner == rank.number()) regions.push_back(region.rect);
  RegionDrawing drawing = rank.begin(list, regions);
  Redistributor redistributor(rank, partition, boxes, list, drawing);
  if (rank.options.redistribution == Redistribution::at_end)
    draw_at_end(rank, own, redistributor, drawing);
  else
    draw_at_once(rank, own, redistributor, drawing);

  image::BasicImage<Colour> image;
  if (rank.number() == 0 || !regions.empty())
    image = rank.take_image<Colour>(rank.options.width, rank.options.height);
  rank.end_pixels(drawing, image);
  screen.measure(rank);
  redistributor.count_geometry();

  communicator.mark(comm::Phase::gather, 0);
  const double before = communicator.seconds();
  gather_regions(communicator, partition, image);
  rank.counts.phases.gather += communicator.seconds() - before;
  if (rank.number() != 0) return image::BasicImage<Colour>();
  return image;
}

}  // namespace

Picture sort_middle(Rank& rank) {
  return rank.options.float_pixels ? render<image::RgbaF>(rank) : render<image::Rgba8>(rank);
}

}  // namespace delray::raster
