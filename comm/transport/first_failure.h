// The failure that a run reports: the first one, whatever follows from it.
#pragma once

#include <atomic>
#include <exception>
#include <mutex>
#include <optional>
#include <string>

#include "comm/failure.h"

namespace delray::comm::internal {

// "rank 3 with tag 7", "any rank with any tag".
std::string describe_pattern(int from_or_any, Tag tag_or_any);

// Throws std::invalid_argument unless a message may go to rank `to` of `size` with this tag.
void check_message(int to, int size, Tag tag);

// exception.what(), or a stand-in for what is no std::exception.
std::string describe(const std::exception_ptr& exception);

// True for bad input, failing devices, interruption, arguments that cannot be and memory that is
// not there: they are no rank's fault, and callers get them as they were thrown.
bool passes_through(const std::exception_ptr& exception);

class FirstFailure {
 public:
  // Both return true for the first failure and ignore all others.
  bool record(int rank, Phase phase, std::string why);
  bool record(int rank, Phase phase, const std::exception_ptr& exception);

  // Cheap enough to ask before every message.
  bool happened() const { return happened_.load(std::memory_order_acquire); }
  void rethrow_if_any() const;

 private:
  bool record(RankFailure&& failure);

  mutable std::mutex mutex_;
  std::optional<RankFailure> failure_;
  std::atomic<bool> happened_{false};
};

}  // namespace delray::comm::internal
