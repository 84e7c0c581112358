// Some ranks of a communicator as a communicator of their own, without a word between them.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "comm/forwarding.h"

namespace delray::composite::internal {

// Ranks that were listed count from 0 in the order of the list; messages go through the
// communicator behind, under their own tags, so that nothing else may be under way between members
// under those tags. Splitting is of the communicator behind: all of its ranks take part. A rank
// that is not listed has rank() -1 and may ask for nothing else.
//
// REQUIRES: `all` outlives it; `ranks` are the same on every member, each once.
class SubCommunicator final : public comm::ForwardingCommunicator {
 public:
  SubCommunicator(comm::Communicator& all, std::vector<int> ranks)
      : comm::ForwardingCommunicator(all), ranks_(std::move(ranks)) {
    rank_ = member_of(all.rank());
  }

  int rank() const override { return rank_; }
  int size() const override { return static_cast<int>(ranks_.size()); }
  int world_rank(int rank) const override { return inner().world_rank(in_all(rank)); }

  void send(int to, comm::Tag tag, comm::Buffer&& message) override {
    inner().send(in_all(to), tag, std::move(message));
  }
  void multicast(std::span<const int> to, comm::Tag tag, comm::Buffer&& message) override {
    std::vector<int> in_all_ranks;
    in_all_ranks.reserve(to.size());
    for (const int member : to) in_all_ranks.push_back(in_all(member));
    inner().multicast(in_all_ranks, tag, std::move(message));
  }
  comm::Buffer receive(int from_or_any, comm::Tag tag_or_any) override {
    return inner().receive(from_or_any == comm::kAnyRank ? from_or_any : in_all(from_or_any),
                           tag_or_any);
  }
  std::optional<comm::Envelope> probe(int from_or_any, comm::Tag tag_or_any,
                                      comm::Deadline deadline) override {
    auto envelope = inner().probe(from_or_any == comm::kAnyRank ? from_or_any : in_all(from_or_any),
                                  tag_or_any, deadline);
    if (envelope) envelope->source = member_of(envelope->source);
    return envelope;
  }

 private:
  int in_all(int member) const { return ranks_[static_cast<std::size_t>(member)]; }
  int member_of(int rank) const {
    const auto at = std::find(ranks_.begin(), ranks_.end(), rank);
    return at == ranks_.end() ? -1 : static_cast<int>(at - ranks_.begin());
  }

  std::vector<int> ranks_;
  int rank_ = -1;
};

}  // namespace delray::composite::internal
