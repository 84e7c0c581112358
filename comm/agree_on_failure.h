// How all ranks learn that one of them cannot go on, and end alike.
#pragma once

#include <exception>
#include <optional>
#include <type_traits>
#include <utility>

#include "comm/communicator.h"

namespace delray::comm {

// Base of every exception that agree_on_failure throws: all ranks have thrown the same, so nobody
// waits for anybody and the run ends in good order.
struct AgreedFailure {
  virtual ~AgreedFailure() = default;
};
template <class Exception>
struct Agreed final : Exception, AgreedFailure {
  using Exception::Exception;
  explicit Agreed(Exception exception) : Exception(std::move(exception)) {}
};

// Collective: does nothing when every rank passes null. Otherwise every rank throws what the lowest
// rank with an exception passed: a FileError, Interrupted or std::invalid_argument as such,
// std::bad_alloc as OutOfMemory, any other as RankFailure, the last two with that rank's number and
// `phase`. One all_reduce of a number where nothing failed.
void agree_on_failure(Communicator& communicator, const std::exception_ptr& mine,
                      Phase phase = Phase::other);

// Collective: f() where no rank's f throws a std::exception; else agree_on_failure. f must not
// communicate: a rank whose f has thrown would be waited for.
template <class F>
auto all_or_none(Communicator& communicator, Phase phase, F&& f) {
  std::exception_ptr failure;
  if constexpr (std::is_void_v<decltype(f())>) {
    try {
      f();
    } catch (const std::exception&) {
      failure = std::current_exception();
    }
    agree_on_failure(communicator, failure, phase);
  } else {
    std::optional<decltype(f())> result;
    try {
      result.emplace(f());
    } catch (const std::exception&) {
      failure = std::current_exception();
    }
    agree_on_failure(communicator, failure, phase);
    return *std::move(result);
  }
}

}  // namespace delray::comm
