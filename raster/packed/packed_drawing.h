// Pages of a pack as a list that is drawn while it is read.
#pragma once

#include <array>
#include <mutex>
#include <span>
#include <vector>

#include "raster/distribute/rank_context.h"
#include "raster/distribute/regions.h"
#include "raster/packed/visible_pages.h"

namespace delray::raster {

// A draw for each page, whose mesh is in memory while it is drawn and, unless all pages stay, again
// while tiles that show it are shaded. One frame of one rank.
class PackedDrawing final : public MeshHolder {
 public:
  // `pages` are what the rank draws, ascending; the same rank and scene as of visible_pages().
  PackedDrawing(RankContext& rank, PackedScene& packed, std::vector<PlacedPage>&& pages);

  // Refers to this. Clusters are numbered in the order of primitives, before anything is read.
  const DrawList& list() const { return list_; }

  // Draws all pages but those that are hidden by then, near ones first. To be called
  // once. Throws FileError.
  void draw(RegionDrawing& drawing);
  // Adds what the frame took from the cache to the rank's counts, once it is finished.
  void count();

  void hold(std::span<const std::uint32_t> draws) override;
  void release(std::span<const std::uint32_t> draws) override;
  bool keeps_all() const override { return keeps_all_; }
  void need_not_keep() override;

 private:
  bool hides(const RegionDrawing& drawing, const PlacedPage& page) const;
  void hold(std::uint32_t draw);
  // With the draw's mutex: `page` is its page, whose clusters are listed.
  void fill(std::uint32_t draw, packs::PageCache::Held&& page);
  void fill_clusters(std::uint32_t draw, const RasterPage& page);

  RankContext& rank_;
  PackedScene& packed_;
  const std::vector<PlacedPage> pages_;
  const packs::CacheCounts before_;
  DrawList list_;
  bool keeps_all_ = false;
  bool pages_repeat_ = false;  // a page may be drawn for each of several instances
  // Of every so many draws one.
  std::array<std::mutex, 64> mutexes_;
  // By draw.
  std::vector<std::uint32_t> holders_;
  std::vector<packs::PageCache::Held> held_;
};

}  // namespace delray::raster
