// Workers take tiles in ascending order; whoever completes the second half of a run of tiles goes
// on with the whole. What waits are rests of halves whose sisters are in the making, one for each
// level and worker.
#include "delaunay/tiles/settle_tiles.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <utility>
#include <vector>

#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

class TileTree {
 public:
  TileTree(const OtherTiles& all, const SettleOptions& options, const TileWork& work)
      : all_(all), options_(options), work_(work), leaf_of_(all.last - all.first) {
    build(all.first, all.last, kNoNode);
  }

  Region run() {
    const auto workers =
        std::min(static_cast<std::size_t>(std::max(options_.workers, 1)), leaf_of_.size());
    parallel::parallel_for(0, workers, 1, [&](std::size_t) {
      for (std::size_t i; !failed_ && (i = next_++) < leaf_of_.size();) {
        try {
          settle_tile(i);
        } catch (...) {
          failed_ = true;
          throw;
        }
      }
    });
    return put_together(std::move(result_));
  }

 private:
  static constexpr std::size_t kNoNode = ~std::size_t{0};
  using Rests = std::vector<Region>;
  struct Node {
    std::size_t first, last, parent;
    bool has_half = false;
    Rests half = {};  // of the half that came first
    std::size_t half_first = 0;
  };

  void build(std::size_t first, std::size_t last, std::size_t parent) {
    const std::size_t node = nodes_.size();
    nodes_.push_back({first, last, parent});
    if (last - first <= 1) {
      if (last > first) leaf_of_[first - all_.first] = node;
      return;
    }
    const std::size_t middle = middle_of(nodes_[node]);
    build(first, middle, node);
    build(middle, last, node);
  }
  static std::size_t middle_of(const Node& node) {
    return node.first + (node.last - node.first) / 2;
  }

  void settle_tile(std::size_t i) {
    const std::size_t tile = all_.first + i;
    Region rest;
    if (!restored(tile, rest)) {
      Settled settled = settle(work_.points(tile), {all_.boxes, tile, tile + 1},
                               options_.triangulate, {.is_tile = true, .finals = options_.finals});
      work_.take(tile, settled);
      rest = std::move(settled.rest);
    }
    Rests rests;
    rests.push_back(std::move(rest));
    deliver(leaf_of_[i], std::move(rests));
  }

  bool restored(std::size_t region, Region& rest) const {
    return work_.restore && work_.restore(region, rest);
  }

  // Hands the rests of a node to its parent; whoever brings the second half goes on.
  void deliver(std::size_t node, Rests rests) {
    for (;;) {
      const std::size_t parent = nodes_[node].parent;
      if (parent == kNoNode) {
        result_ = std::move(rests);
        return;
      }
      {
        const std::lock_guard lock(mutex_);
        Node& whole = nodes_[parent];
        if (!std::exchange(whole.has_half, true)) {
          whole.half = std::move(rests);
          whole.half_first = nodes_[node].first;
          return;
        }
        if (whole.half_first < nodes_[node].first) std::swap(whole.half, rests);
        std::ranges::move(whole.half, std::back_inserter(rests));
        whole.half = {};
      }
      node = parent;
      settle_node(nodes_[node], rests);
    }
  }

  // The root is left to the caller.
  void settle_node(const Node& node, Rests& rests) {
    if (node.parent == kNoNode) return;
    const std::size_t region = region_of(all_.boxes.size(), node.first, node.last);
    Region rest;
    if (!restored(region, rest)) {
      std::size_t sum = 0, largest = 0;
      for (const Region& each : rests) {
        sum += each.points.size();
        largest = std::max(largest, each.points.size());
      }
      if (sum < options_.put_together || sum < 2 * largest) return;
      if (options_.require) options_.require(sum);
      parallel::Progress part(options_.triangulate.progress);
      Settled settled = settle(put_together(std::move(rests)), {all_.boxes, node.first, node.last},
                               options_.again(part), {.finals = options_.finals});
      work_.take(region, settled);
      rest = std::move(settled.rest);
    }
    rests.clear();
    rests.push_back(std::move(rest));
  }

  static Region put_together(Rests rests) {
    Region all;
    for (Region& rest : rests) {
      append(all, rest);
      rest = {};
    }
    return all;
  }

  const OtherTiles& all_;
  const SettleOptions& options_;
  const TileWork& work_;
  std::vector<Node> nodes_;
  std::vector<std::size_t> leaf_of_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> failed_{false};
  std::mutex mutex_;
  Rests result_;
};

}  // namespace

Region settle_tiles(const OtherTiles& all, const SettleOptions& options, const TileWork& work) {
  return TileTree(all, options, work).run();
}

}  // namespace delray::delaunay
