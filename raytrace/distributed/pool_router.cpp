// A pool of rays that all ranks share, each of which has the whole scene: a rank that has nothing
// left to do asks another one for rays that wait to be intersected (as Heirich and Arvo 1997
// describe stealing; Badouel et al. 1990 have one pool). It gets half of what waits there, and
// sends back what they hit: their own rank goes on with them, so that pictures stay the same.
//
// It asks the rank that had most when it was heard of last, after a request in vain later and
// later. Ranks whose own tasks are done say so when they are asked, and are not asked again: once
// all others have, the end can be found.
#include <algorithm>
#include <deque>
#include <vector>

#include "raytrace/distributed/ray_router.h"

namespace delray::raytrace {
namespace {

// Turns with nothing to do between two requests in vain, at most.
constexpr int kLongestPause = 8;
// At once: as long as they take, whoever asked has something to do, and nobody else can have them.
constexpr std::size_t kMostTasks = 16;

constexpr std::uint32_t kDone = 1;  // of no_rays, for a cluster: its sender will never have any

class PoolRouter final : public RayRouter {
 public:
  explicit PoolRouter(const RoutingContext& context)
      : context_(context), is_done_(static_cast<std::size_t>(context.messenger.ranks())) {}

  Progression start() const override { return {}; }

  // At home to who asked last, there back again.
  void choose_next(const Line&, Progression& way) const override {
    way.next = kMiss;
    if (way.hops > 0) return;
    const int ranks = context_.messenger.ranks();
    way.hops = static_cast<std::uint32_t>((taker_ - context_.messenger.rank() + ranks) % ranks);
    way.next = kOnward;
  }

  void receive(int from, const MessageHeader& header, std::span<const std::byte>) override {
    if (header.kind == MessageKind::request_rays) {
      takers_.push_back(from);
      return;
    }
    asked_ = false;
    if (header.cluster == kDone) {
      is_done_[static_cast<std::size_t>(from)] = true;
    } else {
      to_wait_ = pause_ = std::min(2 * pause_ + 1, kLongestPause);
    }
  }

  bool has_plans() const override { return asked_ || rank_to_ask() != context_.messenger.rank(); }

  void got_rays(int) override {
    asked_ = false;
    to_wait_ = pause_ = 0;
  }

  std::size_t give_tasks() override {
    const std::size_t half = std::min(context_.waiting.pending_tasks / 2, kMostTasks);
    if (takers_.empty() || half == 0) return 0;
    taker_ = takers_.front();
    takers_.pop_front();
    gave_ = true;
    return half;
  }

  void take_turn(bool idle) override {
    context_.messenger.set_load(context_.waiting.pending_tasks);
    // Rays that meet no box need not travel: there may be nothing for who asked.
    if (gave_ && context_.waiting.to_intersect[static_cast<std::size_t>(taker_)].empty())
      send(taker_, MessageKind::no_rays);
    gave_ = false;
    if (context_.waiting.pending_tasks < 2) {
      for (const int taker : takers_) send(taker, MessageKind::no_rays);
      takers_.clear();
    }
    if (!idle || asked_ || to_wait_-- > 0) return;
    const int rank = rank_to_ask();
    if (rank == context_.messenger.rank()) return;
    asked_ = true;
    send(rank, MessageKind::request_rays);
  }

 private:
  void send(int to, MessageKind kind) {
    MessageHeader header;
    header.kind = kind;
    header.cluster = kind == MessageKind::no_rays && context_.waiting.is_done ? kDone : 0;
    context_.messenger.send(to, with_header(header, {}));
  }

  // The most loaded of those that may be asked, of equal ones the next; this rank where there is
  // none.
  int rank_to_ask() const {
    const int rank = context_.messenger.rank(), ranks = context_.messenger.ranks();
    int best = rank;
    for (int step = 1; step < ranks; ++step) {
      const int other = (rank + step) % ranks;
      if (is_done_[static_cast<std::size_t>(other)]) continue;
      const bool has_more = context_.messenger.load_of(other) > context_.messenger.load_of(best);
      if (best == rank || has_more) best = other;
    }
    return best;
  }

  RoutingContext context_;
  std::deque<int> takers_;       // who asked, in order
  int taker_ = 0;                // who gets rays of tasks that are given
  bool asked_ = false;           // and no reply has come
  bool gave_ = false;            // tasks to taker_, in this turn
  int to_wait_ = 0, pause_ = 0;  // turns until the next request, and after the last one
  std::vector<bool> is_done_;    // by rank, as it told
};

}  // namespace

std::unique_ptr<RayRouter> make_pool_router(const RoutingContext& context) {
  return std::make_unique<PoolRouter>(context);
}

}  // namespace delray::raytrace
