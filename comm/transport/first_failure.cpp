// Records the first failure under a lock, with a flag beside it that is cheap to read, and decides
// which exceptions reach the caller as they were thrown.
#include "comm/transport/first_failure.h"

#include <stdexcept>
#include <utility>

#include "files/error.h"
#include "parallel/progress.h"

namespace delray::comm::internal {

std::string describe_pattern(int from_or_any, Tag tag_or_any) {
  return (from_or_any == kAnyRank ? "any rank" : "rank " + std::to_string(from_or_any)) +
         (tag_or_any == kAnyTag ? " with any tag" : " with tag " + std::to_string(tag_or_any));
}

void check_message(int to, int size, Tag tag) {
  if (to < 0 || to >= size || tag < 0) {
    throw std::invalid_argument("there is no rank " + std::to_string(to) + " of " +
                                std::to_string(size) + ", or no tag " + std::to_string(tag));
  }
}

std::string describe(const std::exception_ptr& exception) {
  try {
    std::rethrow_exception(exception);
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "an exception that is no std::exception";
  }
}

bool passes_through(const std::exception_ptr& exception) {
  try {
    std::rethrow_exception(exception);
  } catch (const files::FileError&) {
    return true;
  } catch (const parallel::Interrupted&) {
    return true;
  } catch (const std::invalid_argument&) {
    return true;
  } catch (const OutOfMemory&) {
    return true;
  } catch (const RankFailure&) {
    return true;
  } catch (...) {
    return false;
  }
}

bool FirstFailure::record(RankFailure&& failure) {
  const std::scoped_lock lock(mutex_);
  if (failure_) return false;
  failure_.emplace(std::move(failure));
  happened_.store(true, std::memory_order_release);
  return true;
}

bool FirstFailure::record(int rank, Phase phase, std::string why) {
  return record(RankFailure(rank, phase, std::move(why)));
}

bool FirstFailure::record(int rank, Phase phase, const std::exception_ptr& exception) {
  if (tells_of_no_memory(exception) && !passes_through(exception)) {
    const OutOfMemory told(rank, phase);
    return record(RankFailure(rank, phase, told.what(), std::make_exception_ptr(told)));
  }
  return record(RankFailure(rank, phase, describe(exception), exception));
}

void FirstFailure::rethrow_if_any() const {
  const std::scoped_lock lock(mutex_);
  if (!failure_) return;
  if (failure_->cause() && passes_through(failure_->cause())) {
    std::rethrow_exception(failure_->cause());
  }
  throw RankFailure(*failure_);
}

}  // namespace delray::comm::internal
