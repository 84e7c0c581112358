// Maps exceptions to exit codes, by their types.
#include "comm/exit_code.h"

#include <stdexcept>

#include "comm/failure.h"
#include "files/error.h"
#include "parallel/progress.h"

namespace delray::comm {

ExitCode exit_code_of(const std::exception_ptr& exception, ExitCode otherwise) {
  if (tells_of_no_memory(exception)) return kFailed;
  try {
    std::rethrow_exception(exception);
  } catch (const std::invalid_argument&) {  // UsageError, and names that are in no table
    return kUsage;
  } catch (const files::FileError& error) {
    return error.cause() == files::Cause::input ? kBadInput : kFailed;
  } catch (const parallel::Interrupted&) {
    return kInterrupted;
  } catch (const RankFailure&) {
    return kRankLost;
  } catch (...) {
    return otherwise;
  }
}

}  // namespace delray::comm
