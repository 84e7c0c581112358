// Agreement on a failure: an all-reduce finds the lowest rank that has an exception, and only then
// is that exception encoded by its kind and text, broadcast and thrown by every rank. O(log n)
// rounds.
#include "comm/agree_on_failure.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>

#include "comm/collectives.h"
#include "comm/failure.h"
#include "comm/transport/first_failure.h"
#include "files/error.h"
#include "parallel/progress.h"

namespace delray::comm {
namespace {

enum class Kind : std::uint8_t { file, interrupted, argument, memory, other };

// An exception in a form that can travel.
struct Report {
  Kind kind = Kind::other;
  files::Cause cause = files::Cause::input;
  std::string file, place, what;
};

struct ReportHeader {
  Kind kind;
  files::Cause cause;
  std::uint64_t file_size, place_size, what_size;
};

Report report_of(const std::exception_ptr& exception) {
  try {
    std::rethrow_exception(exception);
  } catch (const files::FileError& error) {
    // what() repeats file and place in front, and the constructor will put them there again.
    const std::string prefix =
        error.file() + (error.place().empty() ? "" : ": " + error.place()) + ": ";
    std::string what = error.what();
    if (what.starts_with(prefix)) what.erase(0, prefix.size());
    return {Kind::file, error.cause(), error.file(), error.place(), what};
  } catch (const parallel::Interrupted&) {
    return {Kind::interrupted, {}, {}, {}, {}};
  } catch (const std::invalid_argument& error) {
    return {Kind::argument, {}, {}, {}, error.what()};
  } catch (const RankFailure& failure) {
    return {Kind::other, {}, {}, {}, failure.why()};
  } catch (...) {
    if (tells_of_no_memory(exception)) return {Kind::memory, {}, {}, {}, {}};
    return {Kind::other, {}, {}, {}, internal::describe(exception)};
  }
}

Buffer encode(const Report& report) {
  const ReportHeader header{report.kind, report.cause, report.file.size(), report.place.size(),
                            report.what.size()};
  const std::string text = report.file + report.place + report.what;
  Buffer encoded(sizeof header + text.size());
  std::memcpy(encoded.data(), &header, sizeof header);
  if (!text.empty()) std::memcpy(encoded.data() + sizeof header, text.data(), text.size());
  return encoded;
}

Report decode(const Buffer& encoded) {
  ReportHeader header;
  std::memcpy(&header, encoded.data(), sizeof header);
  std::string_view text(reinterpret_cast<const char*>(encoded.data()) + sizeof header,
                        encoded.size() - sizeof header);
  const auto take = [&text](std::size_t size) {
    const std::string taken(text.substr(0, size));
    text.remove_prefix(size);
    return taken;
  };
  Report report;
  report.kind = header.kind;
  report.cause = header.cause;
  report.file = take(header.file_size);
  report.place = take(header.place_size);
  report.what = take(header.what_size);
  return report;
}

}  // namespace

void agree_on_failure(Communicator& communicator, const std::exception_ptr& mine, Phase phase) {
  const int none = communicator.size();
  const int failed = all_reduce_value(communicator, mine ? communicator.rank() : none,
                                      [](int a, int b) { return std::min(a, b); });
  if (failed == none) return;
  const bool is_mine = failed == communicator.rank();
  const Report report =
      decode(broadcast(communicator, failed, is_mine ? encode(report_of(mine)) : Buffer()));
  switch (report.kind) {
    case Kind::file:
      throw Agreed<files::FileError>(report.cause, report.file, report.place, report.what);
    case Kind::interrupted:
      throw Agreed<parallel::Interrupted>();
    case Kind::argument:
      throw Agreed<std::invalid_argument>(report.what);
    case Kind::memory:
      throw Agreed<OutOfMemory>(communicator.world_rank(failed), phase);
    case Kind::other:
      throw Agreed<RankFailure>(communicator.world_rank(failed), phase, report.what);
  }
}

}  // namespace delray::comm
