// Sort-middle: ranks transform, cull and, with gouraud, light the primitives that they have; the
// triangles that are left go to the ranks whose regions they touch, which draw them. Vertices
// travel as the mesh has them, since their places on the screen follow from these in fewer bytes.
//
// Each cluster of the whole scene has a number that ascends with its primitives, known from a sum
// over the ranks before. So what arrives may be drawn in any order, and equal depths still go to
// the lowest primitive. What touches its own rank's regions is drawn as it is, without travelling.
// Of the regions each rank draws the one that it has most of. Where nothing has changed since the
// last frame, what arrived for that is drawn again.
#include <algorithm>
#include <cstring>
#include <functional>
#include <map>
#include <numeric>
#include <stdexcept>

#include "comm/collectives.h"
#include "parallel/parallel_for.h"
#include "raster/distribute/cluster_messages.h"
#include "raster/distribute/frame_memory.h"
#include "raster/distribute/triangle_sorter.h"
#include "raster/pipeline/processor_seconds.h"

namespace delray::raster {
namespace {

constexpr comm::Tag kTagTriangles = 81;
// Sent as soon as there are so many bytes for a rank, where triangles are sent at once.
constexpr std::size_t kMessageBytes = std::size_t{1} << 16;
// Clusters whose geometry is done before arrivals are looked for.
constexpr std::size_t kBatchClusters = 256;
constexpr std::size_t kGrain = 8;  // clusters of a task
// Among more ranks each has little of what a region shows.
constexpr int kMostMatched = 64;

// Ranks 0 .. geometry - 1 have the primitives; those from first_rasterizer on draw.
struct Roles {
  int geometry = 0, first_rasterizer = 0;
};

Roles roles_of(const RankContext& rank) {
  const int n = rank.ranks();
  if (rank.options.groups == Groups::one || n == 1) return {n, 0};
  const int geometry = rank.options.geometry_ranks > 0 ? rank.options.geometry_ranks : n / 2;
  return {geometry, geometry};
}

// Gives the list's clusters the numbers that they have among those of all ranks, and makes room for
// the others. Returns the numbers. Collective.
std::vector<std::uint32_t> number_globally(RankContext& rank, DrawList& list) {
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

// Which rank draws which of the partition's regions: one after the other the rank that has most of
// what touches a region, of those that are left, so that little travels. Collective.
std::vector<int> match_regions(RankContext& rank, const loadbalance::Partition& partition,
                               std::span<const loadbalance::WeightedBox> boxes) {
  const int ranks = rank.ranks();
  std::vector<int> rank_of_owner(static_cast<std::size_t>(ranks));
  std::iota(rank_of_owner.begin(), rank_of_owner.end(), 0);
  // Measured costs are those of a rank's own region.
  if (ranks > kMostMatched || rank.options.costs == CostSource::measured) return rank_of_owner;
  const loadbalance::RegionIndex index(partition);
  std::vector<float> mine(rank_of_owner.size());
  std::vector<int> owners;
  for (const loadbalance::WeightedBox& box : boxes) {
    if (box.box.empty()) continue;
    index.owners_of(box.box, owners);
    for (const int owner : owners)
      mine[owner] += static_cast<float>(box.primitives) / static_cast<float>(owners.size());
  }
  struct Pair {
    float amount;
    int rank, owner;
  };
  std::vector<Pair> pairs;
  const std::vector<comm::Buffer> all =
      comm::all_gather(rank.communicator, comm::Buffer::of(std::span<const float>(mine)));
  for (int k = 0; k < ranks; ++k) {
    const auto amounts = all[k].as<float>();
    for (int owner = 0; owner < ranks; ++owner) pairs.push_back({amounts[owner], k, owner});
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.amount > b.amount; });
  std::vector<bool> has_region(rank_of_owner.size()), is_matched(rank_of_owner.size());
  for (const Pair& pair : pairs) {
    if (has_region[pair.rank] || is_matched[pair.owner]) continue;
    has_region[pair.rank] = is_matched[pair.owner] = true;
    rank_of_owner[pair.owner] = pair.rank;
  }
  return rank_of_owner;
}

// Triangles on their way between ranks.
class Redistributor {
 public:
  // Collective. `boxes` are around everything that this rank may send; ranks from first_rasterizer
  // on draw.
  Redistributor(RankContext& rank, const loadbalance::Partition& partition, int first_rasterizer,
                std::span<const loadbalance::WeightedBox> boxes, SortedMiddle& sorted,
                RegionDrawing& drawing)
      : rank_(rank),
        receivers_(receivers_of(rank, first_rasterizer)),
        seen_(partition_of_receivers(partition, receivers_, rank)),
        regions_(seen_),
        sorted_(sorted),
        drawing_(drawing) {
    // A message at least for each rank that may get something, so that it knows when all is there.
    std::vector<int> senders(static_cast<std::size_t>(rank.ranks())), owners;
    for (const loadbalance::WeightedBox& box : boxes) {
      regions_.owners_of(box.box, owners);
      for (const int owner : owners)
        if (owner != rank.number()) buckets_[owner];
    }
    for (const auto& [to, bucket] : buckets_) {
      if (to < rank.ranks()) senders[to] = 1;
      if (to == rank.ranks())
        for (const int receiver : receivers_) senders[receiver] = 1;
    }
    comm::all_reduce(rank.communicator, std::span(senders), std::plus<>());
    senders_left_ = senders[rank.number()];
  }

  // Whether this rank neither gets nor sends anything.
  bool nothing_travels() const { return buckets_.empty() && all_arrived(); }
  bool all_arrived() const { return senders_left_ == 0; }

  // Does the geometry of clusters of the list. Parallel. Appends those that stay here to `here`.
  void sort(std::span<const std::uint32_t> clusters, std::vector<std::uint32_t>& here) {
    std::vector<SortedClusters> sorted((clusters.size() + kGrain - 1) / kGrain);
    ProcessorSeconds seconds;
    parallel::parallel_for(0, sorted.size(), 1, [&](std::size_t i) {
      seconds.measure([&] {
        TriangleSorter sorter(rank_, drawing_, regions_);
        const std::size_t first = i * kGrain;
        for (const std::uint32_t number :
             clusters.subspan(first, std::min(kGrain, clusters.size() - first)))
          sorter.sort(number, sorted[i]);
      });
    });
    seconds_ += seconds.seconds();
    for (SortedClusters& part : sorted) {
      here.insert(here.end(), part.staying.begin(), part.staying.end());
      culled_ += part.culled;
      for (SortedClusters::Parcel& parcel : part.parcels) {
        Bucket& bucket = buckets_.at(parcel.to);
        bucket.bytes += parcel.clusters.bytes.size();
        bucket.parts.push_back(std::move(parcel.clusters.bytes));
        rank_.triangles_travelled += parcel.clusters.triangles;
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
      unpack_clusters(bytes.subspan(sizeof(is_last)), sorted_.arrived, sorted_.list, here);
    }
  }

 private:
  // Of a broadcast: all ranks that draw, but this one. Otherwise none.
  static std::vector<int> receivers_of(const RankContext& rank, int first_rasterizer) {
    std::vector<int> receivers;
    if (rank.options.redistribution != Redistribution::broadcast) return receivers;
    for (int k = first_rasterizer; k < rank.ranks(); ++k)
      if (k != rank.number()) receivers.push_back(k);
    return receivers;
  }
  // Of a broadcast: others' regions are those of one more rank, which stands for all of them.
  static loadbalance::Partition partition_of_receivers(const loadbalance::Partition& partition,
                                                       const std::vector<int>& receivers,
                                                       const RankContext& rank) {
    loadbalance::Partition seen = partition;
    if (receivers.empty()) return seen;
    for (loadbalance::Region& region : seen.regions)
      if (region.owner != rank.number()) region.owner = rank.ranks();
    return seen;
  }

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
    if (to == rank_.ranks())
      rank_.communicator.multicast(receivers_, kTagTriangles, std::move(message));
    else
      rank_.communicator.send(to, kTagTriangles, std::move(message));
  }

  RankContext& rank_;
  const std::vector<int> receivers_;
  const loadbalance::Partition seen_;
  const loadbalance::RegionIndex regions_;
  SortedMiddle& sorted_;
  RegionDrawing& drawing_;
  std::map<int, Bucket> buckets_;  // by receiver; the number of ranks stands for receivers_
  int senders_left_ = 0;
  double seconds_ = 0;
  std::uint64_t culled_ = 0;
};

// Everything that touches the rank's regions, once it is there.
void draw_at_end(RankContext& rank, std::span<const std::uint32_t> own,
                 Redistributor& redistributor, RegionDrawing& drawing,
                 std::vector<std::uint32_t>& here) {
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
void draw_at_once(RankContext& rank, std::span<const std::uint32_t> own,
                  Redistributor& redistributor, RegionDrawing& drawing,
                  std::vector<std::uint32_t>& drawn) {
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
    drawn.insert(drawn.end(), here.begin(), here.end());
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
Picture finish(RankContext& rank, const loadbalance::Partition& partition,
               std::span<const geometry::Rect> regions, RegionDrawing& drawing) {
  image::BasicImage<Colour> image;
  if (rank.number() == 0 || !regions.empty())
    image = rank.take_image<Colour>(rank.options.width, rank.options.height);
  rank.end_pixels(drawing, image);
  rank.memory.screen.measure(rank);
  return rank.gather(partition, std::move(image));
}

template <class Colour>
Picture render(RankContext& rank) {
  comm::Communicator& communicator = rank.communicator;
  communicator.mark(comm::Phase::transform, 0);
  const Roles roles = roles_of(rank);
  const auto [begin, end] = rank.own_primitives(roles.geometry);
  const int drawing_ranks = rank.ranks() - roles.first_rasterizer;
  ScreenPartition& screen = rank.memory.screen;
  const CostedGroups& costed = screen.groups(
      rank, {begin, end,
             ScreenPartition::group_triangles(rank.prepared.primitives,
                                              drawing_ranks * rank.options.regions_per_rank)});

  communicator.mark(comm::Phase::redistribute, 0);
  const double before_cut = communicator.seconds();
  loadbalance::Partition partition = screen.cut(rank, drawing_ranks, roles.first_rasterizer);
  SortedMiddle& sorted = rank.memory.sorted_middle;
  const bool is_unchanged = sorted.version == screen.version();
  if (!is_unchanged) {
    sorted = {};
    if (drawing_ranks == rank.ranks() && !rank.options.owners_draw)
      sorted.rank_of_owner = match_regions(rank, partition, costed.boxes);
  }
  rank.rank_of_owner = sorted.rank_of_owner;
  for (loadbalance::Region& region : partition.regions) {
    region.owner = sorted.rank_of_owner.empty() ? region.owner + roles.first_rasterizer
                                                : sorted.rank_of_owner[region.owner];
  }
  std::vector<geometry::Rect> regions;
  for (const loadbalance::Region& region : partition.regions)
    if (region.owner == rank.number()) regions.push_back(region.rect);
  if (is_unchanged) {
    // The triangles that arrived for the last frame would arrive for this one, too.
    rank.counts.phases.redistribute += communicator.seconds() - before_cut;
    communicator.mark(comm::Phase::rasterize, 0);
    RegionDrawing drawing = rank.begin(sorted.list, regions);
    drawing.draw(sorted.drawn);
    return finish<Colour>(rank, partition, regions, drawing);
  }
  sorted.list =
      make_draw_list(pieces_of(rank.prepared.scene, rank.prepared.first_primitives, begin, end),
                     &rank.prepared.clusters);
  const std::vector<std::uint32_t> own = number_globally(rank, sorted.list);
  rank.counts.phases.redistribute += communicator.seconds() - before_cut;
  RegionDrawing drawing = rank.begin(sorted.list, regions);
  Redistributor redistributor(rank, partition, roles.first_rasterizer, costed.boxes, sorted,
                              drawing);
  if (redistributor.nothing_travels()) {
    communicator.mark(comm::Phase::rasterize, 0);
    drawing.draw(own);
    sorted.drawn = own;
  } else if (rank.options.redistribution != Redistribution::immediate) {
    draw_at_end(rank, own, redistributor, drawing, sorted.drawn);
  } else {
    draw_at_once(rank, own, redistributor, drawing, sorted.drawn);
  }
  sorted.version = screen.version();
  Picture picture = finish<Colour>(rank, partition, regions, drawing);
  redistributor.count_geometry();
  return picture;
}

}  // namespace

Picture sort_middle(RankContext& rank) {
  rank.composites = false;
  return rank.options.float_pixels ? render<image::RgbaF>(rank) : render<image::Rgba8>(rank);
}

}  // namespace delray::raster
