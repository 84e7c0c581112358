// Some ranks of a communicator as a communicator of their own, without a word between them.
#pragma once

#include <algorithm>
#include <exception>
#include <utility>
#include <vector>

#include "comm/communicator.h"

namespace delray::composite::internal {

// Ranks that were listed count from 0 in the order of the list; messages go through the
// communicator behind, under their own tags, so that nothing else may be under way between members
// under those tags. A rank that is not listed has rank() -1 and may ask for nothing else.
//
// REQUIRES: `all` outlives it; `ranks` are the same on every member, each once.
class SubCommunicator final : public comm::Communicator {
 public:
  SubCommunicator(comm::Communicator& all, std::vector<int> ranks)
      : all_(all), ranks_(std::move(ranks)) {
    rank_ = member_of(all.rank());
  }

  int rank() const override { return rank_; }
  int size() const override { return static_cast<int>(ranks_.size()); }
  int world_rank(int rank) const override { return all_.world_rank(in_all(rank)); }
  double seconds() const override { return all_.seconds(); }

  void send(int to, comm::Tag tag, comm::Buffer&& message) override {
    all_.send(in_all(to), tag, std::move(message));
  }
  void multicast(std::span<const int> to, comm::Tag tag, comm::Buffer&& message) override {
    std::vector<int> in_all_ranks;
    in_all_ranks.reserve(to.size());
    for (const int member : to) in_all_ranks.push_back(in_all(member));
    all_.multicast(in_all_ranks, tag, std::move(message));
  }
  comm::Buffer receive(int from_or_any, comm::Tag tag_or_any) override {
    return all_.receive(from_or_any == comm::kAnyRank ? from_or_any : in_all(from_or_any),
                        tag_or_any);
  }
  std::optional<comm::Envelope> probe(int from_or_any, comm::Tag tag_or_any,
                                      comm::Deadline deadline) override {
    auto envelope = all_.probe(from_or_any == comm::kAnyRank ? from_or_any : in_all(from_or_any),
                               tag_or_any, deadline);
    if (envelope) envelope->source = member_of(envelope->source);
    return envelope;
  }
  // Of the communicator behind: all of its ranks take part.
  std::unique_ptr<comm::Communicator> split(int color, int key) override {
    return all_.split(color, key);
  }

  void mark(comm::Phase phase, int round) override { all_.mark(phase, round); }
  void work(comm::Work kind, std::uint64_t amount) override { all_.work(kind, amount); }
  [[noreturn]] void abort(std::string why) override {
    all_.abort(std::move(why));
    std::terminate();  // not reached; not every compiler sees that
  }

 private:
  int in_all(int member) const { return ranks_[static_cast<std::size_t>(member)]; }
  int member_of(int rank) const {
    const auto at = std::find(ranks_.begin(), ranks_.end(), rank);
    return at == ranks_.end() ? -1 : static_cast<int>(at - ranks_.begin());
  }

  comm::Communicator& all_;
  std::vector<int> ranks_;
  int rank_ = -1;
};

}  // namespace delray::composite::internal
