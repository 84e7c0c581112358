// The members of a communicator whose ranks share this process's memory.
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "comm/transport/message_queue.h"

namespace delray::comm::internal {

struct Group {
  explicit Group(std::vector<int> members)
      : world_ranks(std::move(members)), queues(world_ranks.size()), requests_(queues.size()) {}

  // Both indexed by rank in this group. A queue is guarded by whatever guards its world rank.
  std::vector<int> world_ranks;
  std::vector<MessageQueue<Buffer>> queues;

  struct Membership {
    std::shared_ptr<Group> group;
    int rank = 0;
  };

  // Splitting: every rank posts, then all meet (a barrier), then every rank takes. The last one to
  // post does the work, O(n log n), so a result is never overwritten before it was taken.
  void post_split(int rank, int color, int key);
  Membership take_split(int rank);

 private:
  struct Request {
    int color = 0, key = 0;
    Membership result;
  };
  std::mutex mutex_;
  std::vector<Request> requests_;
  std::size_t posted_ = 0;
};

}  // namespace delray::comm::internal
