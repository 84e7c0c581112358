// The exit codes of a program, alike for one process and for each of many.
#pragma once

#include <exception>

namespace delray::comm {

enum ExitCode {
  kDone = 0,
  kFailed = 1,       // while running: disk full, device, out of memory
  kUsage = 2,        // wrong usage
  kBadInput = 3,     // a file is not what it should be
  kNotVerified = 4,  // verification failed
  kRankLost = 5,     // a rank was lost or timed out
  kInterrupted = 130,
};

// The exit code that an exception becomes; `otherwise` for those that nothing is known of. A rank
// that throws one of these is lost, a program without ranks has failed.
ExitCode exit_code_of(const std::exception_ptr& exception, ExitCode otherwise = kFailed);

}  // namespace delray::comm
