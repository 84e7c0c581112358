// How a run ends when one of its ranks fails.
#pragma once

#include <array>
#include <exception>
#include <new>
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

// A rank found no memory, or no room for one thread more: nobody's fault, and no lost rank. what()
// reads "out of memory: rank 2, in phase compose". Takes no memory itself.
class OutOfMemory : public std::bad_alloc {
 public:
  OutOfMemory(int rank, Phase phase) noexcept;

  int rank() const { return rank_; }
  Phase phase() const { return phase_; }
  const char* what() const noexcept override { return text_.data(); }

 private:
  int rank_;
  Phase phase_;
  std::array<char, 80> text_{};
};

// Whether an exception means that memory or threads have run out: std::bad_alloc, a container that
// cannot be that large, a thread that the system does not start.
bool tells_of_no_memory(const std::exception_ptr& exception);

// Unwinds the other ranks of a run in which one has failed: thrown by every call that sends or
// waits. Not a std::exception, so that handlers for errors let it pass.
struct RunEnded {};

}  // namespace delray::comm
