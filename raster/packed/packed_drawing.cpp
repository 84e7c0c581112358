// Draws batches of pages while the system reads those of the next ones (Correa, Klosowski and Silva
// 2002): before a page is asked for, and again before its batch is drawn, it is left out if what is
// drawn by then hides it. Who draws pages unpacks them (HeldDraws), so that they are in his cache.
//
// Shading comes when everything is drawn, and looks at what is seen only: it holds the pages of a
// tile, which the cache may have to read again; where all pages fit in memory they are held until
// the frame is finished. Degenerate: where nothing is in view nothing is read.
#include "raster/packed/packed_drawing.h"

#include <algorithm>
#include <utility>

namespace delray::raster {
namespace {

// Drawn at once: the first ones, of which others are behind; and at most. Between batches threads
// wait for each other.
constexpr std::size_t kBatchPages = 128, kMostBatchPages = 1024;
// For pages that nobody will ask for again: memory that was used before is in the caches, and has
// not to be got from the system.
constexpr std::uint64_t kPassingBytes = std::uint64_t{8} << 20;
// Asked for at once before they are drawn: so many that of pages at about the same distance some
// are neighbours in the file.
constexpr std::size_t kPagesAhead = 32 * kBatchPages;

}  // namespace

PackedDrawing::PackedDrawing(RankContext& rank, PackedScene& packed,
                             std::vector<PlacedPage>&& pages)
    : rank_(rank),
      packed_(packed),
      pages_(std::move(pages)),
      before_(packed.cache.counts()),
      holders_(pages_.size()),
      held_(pages_.size()) {
  const scenes::Scene& scene = rank.prepared.scene;
  constexpr std::uint64_t kMost = 1U << (32 - kClusterBits);
  if (pages_.size() * packs::kPageClusters >= kMost)
    throw std::length_error("one rank cannot rasterize more than 8 million pages at once");
  list_.holder = this;
  list_.clusters.resize(pages_.size() * packs::kPageClusters);
  list_.draws.reserve(pages_.size());
  std::uint64_t bytes = 0;  // of all pages in memory, about
  std::vector<bool> seen(packed.pack.pages().size());
  for (const PlacedPage& page : pages_) {
    const scenes::Instance& instance = scene.instances[page.instance];
    const scenes::Mesh& mesh = scene.meshes[instance.mesh];
    list_.draws.push_back({&mesh, &instance.transform, nullptr, nullptr, page.widening});
    list_.triangles += page.triangles;
    if (seen[page.page]) {  // of another instance
      pages_repeat_ = true;
    } else {
      bytes += page.bytes_in_memory;
    }
    seen[page.page] = true;
  }
  // Memory that was another page's before is mostly larger.
  constexpr std::uint64_t kSlack = 2;
  keeps_all_ = bytes * kSlack <= packed.cache.limit();
}

bool PackedDrawing::hides(const RegionDrawing& drawing, const PlacedPage& page) const {
  return drawing.hides(page.pixels, page.nearest);
}

void PackedDrawing::fill_clusters(std::uint32_t draw, const RasterPage& page) {
  const PlacedPage& placed = pages_[draw];
  // Of several levels any numbers will do that ascend and are the same on all ranks.
  constexpr std::uint64_t kPageTriangles = packs::kPageClusters * kClusterTriangles;
  const std::uint64_t primitive =
      rank_.options.error > 0
          ? (placed.instance * std::uint64_t{packed_.pack.pages().size()} + placed.page) *
                kPageTriangles
          : packed_.pack.first_primitives()[placed.instance] +
                packed_.pack.pages()[placed.page].first;
  const std::vector<MeshCluster>& parts = page.clusters().blocks.front()->clusters;
  for (std::uint32_t part = 0; part < parts.size(); ++part) {
    // Its draw is known, and looked up before it is held.
    Cluster& cluster = list_.clusters[std::size_t{draw} * packs::kPageClusters + part];
    cluster.first = parts[part].first;
    cluster.part = part;
    cluster.begin = 0;
    cluster.end = static_cast<std::uint16_t>(parts[part].count);
    cluster.primitive = primitive + parts[part].first;
    cluster.first_vertex = parts[part].vertex_of_place_0();
  }
}

void PackedDrawing::draw(RegionDrawing& drawing) {
  // Near to far.
  std::vector<std::pair<float, std::uint32_t>> order(pages_.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = {pages_[i].nearest, i};
  std::sort(order.begin(), order.end());
  TriangleCounts& counts = rank_.counts.triangles;
  PackCounts& pack = rank_.pack;
  pack.pages += pages_.size();
  std::vector<std::uint32_t> ahead, batch, clusters;
  packed_.cache.begin_frame();
  for (std::size_t at = 0, asked = 0; at < order.size();) {
    if (asked < at + kPagesAhead / 2) {
      ahead.clear();
      for (asked = std::max(asked, at); asked < std::min(at + kPagesAhead, order.size()); ++asked) {
        const PlacedPage& page = pages_[order[asked].second];
        if (!hides(drawing, page)) ahead.push_back(page.page);
      }
      std::ranges::sort(ahead);
      packed_.pack.will_need(packed_.cache.missing(ahead));
    }

    batch.clear();
    const std::size_t most = std::clamp(at / 2, kBatchPages, kMostBatchPages);
    for (; at < asked && batch.size() < most; ++at) {
      const PlacedPage& page = pages_[order[at].second];
      if (hides(drawing, page)) {
        counts.in += page.triangles;
        counts.hidden += page.triangles;
        counts.hidden_clusters += page.clusters;
        ++pack.pages_hidden;
        continue;
      }
      batch.push_back(order[at].second);
      pack.levels[std::min<std::size_t>(page.level, PackCounts::kLevels - 1)] += page.triangles;
    }
    // Neighbours in the file are so on the screen, too, and in the tiles that a thread draws into.
    std::ranges::sort(batch);
    clusters.clear();
    for (const std::uint32_t page : batch) {
      for (std::uint32_t part = 0; part < pages_[page].clusters; ++part) {
        clusters.push_back(page * packs::kPageClusters + part);
        list_.clusters[clusters.back()].draw = page;
      }
    }
    pack.clusters += clusters.size();
    drawing.draw_in_order(clusters);
  }
}

void PackedDrawing::need_not_keep() {
  if (packed_.one_frame && !pages_repeat_)
    packed_.cache.set_limit(std::min(kPassingBytes, packed_.cache.limit()));
}

void PackedDrawing::count() { rank_.pack.cache += packed_.cache.counts() - before_; }

void PackedDrawing::hold(std::span<const std::uint32_t> draws) {
  std::size_t held = 0;
  try {
    for (; held < draws.size(); ++held) hold(draws[held]);
  } catch (...) {
    release(draws.first(held));
    throw;
  }
}

void PackedDrawing::hold(std::uint32_t draw) {
  std::unique_lock lock(mutexes_[draw % mutexes_.size()]);
  if (holders_[draw] == 0) {
    lock.unlock();
    packs::PageCache::Held page = packed_.cache.get(pages_[draw].page);
    lock.lock();
    if (holders_[draw] == 0) fill(draw, std::move(page));
  }
  ++holders_[draw];
}

void PackedDrawing::fill(std::uint32_t draw, packs::PageCache::Held&& page) {
  const auto& made = static_cast<const RasterPage&>(*page);
  list_.draws[draw].mesh = &made.mesh();
  if (list_.draws[draw].clusters == nullptr) fill_clusters(draw, made);
  // Nothing is made of what is there.
  list_.draws[draw].clusters = const_cast<MeshClusters*>(&made.clusters());
  held_[draw] = std::move(page);
}

void PackedDrawing::release(std::span<const std::uint32_t> draws) {
  if (keeps_all_) return;
  for (const std::uint32_t draw : draws) {
    packs::PageCache::Held page;  // given back after the lock
    const std::lock_guard lock(mutexes_[draw % mutexes_.size()]);
    if (--holders_[draw] == 0) page = std::move(held_[draw]);
  }
}

}  // namespace delray::raster
