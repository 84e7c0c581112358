// Words the two exceptions that name a rank, and recognizes exhausted memory in its several forms.
#include "comm/failure.h"

#include <cstdio>
#include <system_error>
#include <utility>

namespace delray::comm {

RankFailure::RankFailure(int rank, Phase phase, std::string why, std::exception_ptr cause)
    : std::runtime_error("rank " + std::to_string(rank) + " failed in phase " + name(phase) + ": " +
                         why),
      rank_(rank),
      phase_(phase),
      why_(std::move(why)),
      cause_(std::move(cause)) {}

OutOfMemory::OutOfMemory(int rank, Phase phase) noexcept : rank_(rank), phase_(phase) {
  std::snprintf(text_.data(), text_.size(), "out of memory: rank %d, in phase %s", rank,
                name(phase));
}

bool tells_of_no_memory(const std::exception_ptr& exception) {
  try {
    std::rethrow_exception(exception);
  } catch (const std::bad_alloc&) {
    return true;
  } catch (const std::length_error&) {
    return true;
  } catch (const std::system_error& error) {
    return error.code() == std::errc::resource_unavailable_try_again ||
           error.code() == std::errc::not_enough_memory;
  } catch (...) {
    return false;
  }
}

}  // namespace delray::comm
