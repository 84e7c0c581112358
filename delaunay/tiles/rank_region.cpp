// The rule of the exchange of halos, for the region of one rank.
#include "delaunay/tiles/rank_region.h"

#include <algorithm>
#include <iterator>
#include <optional>

namespace delray::delaunay {

struct RankRegion::Mesh {
  std::optional<RegionMesh<2>> plane;
  std::optional<RegionMesh<3>> space;

  Mesh(const Region& region, const Options& options) {
    if (options.dim == 2) {
      plane.emplace(Region(region), options);
    } else {
      space.emplace(Region(region), options);
    }
  }
  template <class F>
  auto visit(const F& f) {
    return plane ? f(*plane) : f(*space);
  }
};

RankRegion::RankRegion(Region&& region, const OtherTiles& others, const SettleOptions& options,
                       const RankTiles& tiles)
    : region_(std::move(region)),
      others_(others),
      progress_(options.triangulate.progress),
      options_(options.triangulate),
      require_(options.require),
      finals_(options.finals),
      tiles_(tiles) {
  options_.threads *= std::max(options.workers, 1);
  if (!tiles_.is_one && options_.progress != nullptr) options_.progress = &progress_;
}
RankRegion::~RankRegion() = default;

void RankRegion::add_halo(std::span<const RowPoint> points) {
  for (const RowPoint& point : points) {
    if (!halo_rows_.insert(point.row).second) continue;
    region_.points.push_back(point);
    changed_ = true;
  }
}

std::vector<RankMessage> RankRegion::untold(const std::vector<TileMessage>& messages) {
  std::vector<RankMessage> all;
  for (const TileMessage& message : messages)
    all.push_back({tiles_.rank_of(message.tile), message.point});
  const auto key = [](const RankMessage& message) {
    return std::pair(message.rank, message.point.row);
  };
  std::ranges::sort(all, {}, key);
  const auto same = [&](const RankMessage& a, const RankMessage& b) { return key(a) == key(b); };
  all.erase(std::unique(all.begin(), all.end(), same), all.end());
  std::erase_if(all, [&](const RankMessage& message) {
    return std::ranges::binary_search(told_, key(message));
  });
  const auto before = static_cast<std::ptrdiff_t>(told_.size());
  std::ranges::transform(all, std::back_inserter(told_), key);
  std::ranges::inplace_merge(told_, told_.begin() + before);
  return all;
}

std::vector<RankMessage> RankRegion::look(Settled& settled) {
  if (region_.own == 0 || !changed_) return {};
  if (require_ && !(tiles_.is_one && !settled_)) require_(region_.points.size());
  if (!settled_) {
    settled = settle(std::move(region_), others_, options_,
                     {.is_tile = tiles_.is_one, .messages = true, .finals = finals_});
    settled_ = true;
    if (options_.progress != nullptr) options_.progress = &progress_;
    region_ = std::move(settled.rest);
    return untold(settled.messages);
  }
  mesh_ = std::make_unique<Mesh>(region_, options_);
  changed_ = false;
  const auto messages = mesh_->visit([&](auto& mesh) {
    settled.simplices = mesh.simplices();
    mesh.find_open(others_);
    return mesh.find_messages(others_);
  });
  return untold(messages);
}

Settled RankRegion::finish() {
  Settled settled;
  if (region_.own == 0) return settled;
  if (changed_) {
    mesh_ = std::make_unique<Mesh>(region_, options_);
    mesh_->visit([&](auto& mesh) { settled.simplices = mesh.simplices(); });
  }
  settled.finals = mesh_->visit([&](auto& mesh) { return mesh.take_own(finals_); });
  mesh_.reset();
  return settled;
}

}  // namespace delray::delaunay
