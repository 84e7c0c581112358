// How a run ends when one of its ranks fails.
#pragma once

#include <exception>
#include <stdexcept>
#include <string>

#include "comm/communicator.h"

namespace delray::comm {

// A rank threw, called abort, or waits for what can never come. what() reads
// "rank 2 failed in phase compose: <why>".
class RankFailure : public std::runtime_error {
 public:
  RankFailure(int rank, Phase phase, std::string why, std::exception_ptr cause = nullptr);

  int rank() const { return rank_; }
  Phase phase() const { return phase_; }
  const std::string& why() const { return why_; }
  // What the rank threw; null after abort, a deadlock or a time-out.
  const std::exception_ptr& cause() const { return cause_; }

 private:
  int rank_;
  Phase phase_;
  std::string why_;
  std::exception_ptr cause_;
};

// Unwinds the other ranks of a run in which one has failed: thrown by every call that sends or
// waits. Not a std::exception, so that handlers for errors let it pass.
struct RunEnded {};

}  // namespace delray::comm
