// Starts and ends a program under MPI: detects launchers by their environment variables, ends
// all ranks with the exit code of a failure, and reports the phase when the process is told to end.
#include "comm/mpi.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "comm/agree_on_failure.h"
#include "comm/exit_code.h"
#include "comm/failure.h"
#include "comm/mpi/mpi_end.h"
#include "comm/mpi/mpi_header.h"
#include "comm/mpi/open_mpi_choices.h"
#include "comm/transport/first_failure.h"
#include "files/error.h"
#include "files/printable.h"
#include "parallel/progress.h"

namespace delray::comm {
namespace internal {
namespace {
std::atomic<Phase> current_phase{Phase::other};
}  // namespace

void note_phase(Phase phase) { current_phase.store(phase, std::memory_order_relaxed); }
Phase noted_phase() { return current_phase.load(std::memory_order_relaxed); }

void end_all_ranks(MPI_Comm communicator, int rank, Phase phase, const std::string& why,
                   int exit_code) {
  const std::string what = RankFailure(rank, phase, why).what();
  const std::string line = "error: " + files::printable(what) + "\n";
  // One call, so that lines of several ranks do not mix.
  std::fwrite(line.data(), 1, line.size(), stderr);
  std::fflush(stderr);
  MPI_Abort(communicator, exit_code);
  std::_Exit(exit_code);
}

}  // namespace internal

namespace {

// What Open MPI, MPICH and its kin, and PMIx launchers tell their processes.
constexpr std::array kSizeVariables = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK",
                                       "MPI_LOCALNRANKS"};
constexpr std::array kRankVariables = {"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK"};

int world_rank_for_signals = 0;
void (*handler_of_program)(int) = nullptr;

// Async-signal-safe: writes fixed pieces only.
extern "C" void report_termination(int signal) {
  std::array<char, 160> line{};
  std::size_t length = 0;
  const auto put = [&](const char* text) {
    while (*text && length < line.size()) line[length++] = *text++;
  };
  std::array<char, 12> digits{};
  std::size_t first = digits.size() - 1;
  int rest = world_rank_for_signals;
  do {
    digits[--first] = static_cast<char>('0' + rest % 10);
    rest /= 10;
  } while (rest > 0);
  put("error: rank ");
  put(&digits[first]);
  put(" was told to end in phase ");
  put(name(internal::noted_phase()));
  put("\n");
  [[maybe_unused]] const auto written = write(STDERR_FILENO, line.data(), length);
  if (handler_of_program != nullptr) return handler_of_program(signal);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

// Has SIGTERM reported as long as it lives.
class TerminationReport {
 public:
  explicit TerminationReport(int rank) {
    world_rank_for_signals = rank;
    struct sigaction old = {};
    if (sigaction(SIGTERM, nullptr, &old) != 0 || old.sa_handler == SIG_IGN) return;
    installed_ = true;
    handler_of_program = old.sa_handler == SIG_DFL ? nullptr : old.sa_handler;
    std::signal(SIGTERM, report_termination);
  }
  ~TerminationReport() {
    if (!installed_) return;
    std::signal(SIGTERM, handler_of_program != nullptr ? handler_of_program : SIG_DFL);
  }
  TerminationReport(const TerminationReport&) = delete;
  TerminationReport& operator=(const TerminationReport&) = delete;

 private:
  bool installed_ = false;
};

bool is_interruption(const std::exception_ptr& exception) {
  try {
    std::rethrow_exception(exception);
  } catch (const parallel::Interrupted&) {
    return true;
  } catch (...) {
    return false;
  }
}

// Where all ranks are interrupted rank 0 may be about to save what there is, which a busy disk
// delays, and ends the others afterwards; this one does nothing until then, or until it seems to be
// alone.
void wait_for_the_end() {
  constexpr std::chrono::minutes kLongest{1};
  std::signal(SIGTERM, SIG_DFL);
  std::this_thread::sleep_for(kLongest);
}

// What the line about a failure says.
std::string reason_of(const std::exception_ptr& failure) {
  return tells_of_no_memory(failure) ? "out of memory" : internal::describe(failure);
}

bool is_agreed(const std::exception_ptr& exception) {
  try {
    std::rethrow_exception(exception);
  } catch (const AgreedFailure&) {
    return true;
  } catch (...) {
    return false;
  }
}

}  // namespace

bool launched_by_mpi() {
  for (const char* variable : kSizeVariables) {
    if (std::getenv(variable)) return true;
  }
  return false;
}

int launched_rank() {
  for (const char* variable : kRankVariables) {
    if (const char* value = std::getenv(variable)) return std::atoi(value);
  }
  return 0;
}

int launched_size() {
  for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    if (const char* value = std::getenv(variable)) return std::max(1, std::atoi(value));
  }
  return 1;
}

void run_mpi(int* argc, char*** argv, const std::function<void(Communicator&)>& body,
             const MpiOptions& options) {
  int initialized = 0;
  MPI_Initialized(&initialized);
  if (!initialized) {
    internal::choose_for_open_mpi();
    int provided = 0;
    MPI_Init_thread(argc, argv, MPI_THREAD_SERIALIZED, &provided);
    if (provided < MPI_THREAD_SERIALIZED)
      throw std::runtime_error("this MPI does not let threads take turns (MPI_THREAD_SERIALIZED)");
  }
  std::exception_ptr failure;
  {
    const MPI_Comm world = MPI_COMM_WORLD;
    const auto communicator = make_mpi_communicator(&world, options);
    const TerminationReport report(communicator->rank());
    try {
      body(*communicator);
    } catch (...) {
      failure = std::current_exception();
    }
    if (failure && !is_agreed(failure)) {
      if (communicator->rank() != 0 && is_interruption(failure)) wait_for_the_end();
      internal::end_all_ranks(world, communicator->rank(), internal::noted_phase(),
                              reason_of(failure), exit_code_of(failure, kRankLost));
    }
  }
  if (!initialized) MPI_Finalize();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace delray::comm
