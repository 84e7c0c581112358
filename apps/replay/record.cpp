// Wraps the communicator twice: Charged tells the time between messages as work, Recording writes
// all down. Clocks of the ranks are set to 0 after a barrier.
#include "apps/replay/record.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <fstream>
#include <map>
#include <numeric>
#include <thread>

#include "comm/agree_on_failure.h"
#include "comm/charged.h"
#include "comm/collectives.h"
#include "comm/ledger_file.h"
#include "comm/recording.h"
#include "files/atomic_file.h"

namespace delray::apps {
namespace {

// Lets times count from `begin` on.
void count_from(double begin, std::vector<comm::Event>& events) {
  for (comm::Event& event : events) {
    event.begin = std::max(0.0, event.begin - begin);
    event.end = std::max(event.begin, event.end - begin);
  }
}

// Seconds that cores of this machine were busy since it started, and, of `process`, this process's
// own.
struct BusySeconds {
  double machine = -1, process = 0;
};
BusySeconds busy_seconds() {
  BusySeconds busy;
  std::ifstream file("/proc/stat");
  std::string name;
  // user, nice, system, idle, waiting for devices, interrupts of two kinds, stolen
  std::array<double, 8> ticks{};
  if (file >> name && name == "cpu") {
    for (double& one : ticks) file >> one;
    constexpr std::size_t kIdle = 3, kDevices = 4;
    busy.machine =
        (std::accumulate(ticks.begin(), ticks.end(), 0.0) - ticks[kIdle] - ticks[kDevices]) /
        static_cast<double>(sysconf(_SC_CLK_TCK));
  }
  timespec own{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &own);
  busy.process = static_cast<double>(own.tv_sec) + 1e-9 * static_cast<double>(own.tv_nsec);
  return busy;
}

// Cores that other programs of rank 0's machine took on the average of so many seconds; negative
// where that is not known. Collective; the result is rank 0's.
double other_programs(comm::Communicator& communicator, const BusySeconds& before, double seconds) {
  const BusySeconds after = busy_seconds();
  struct Process {
    std::array<char, 64> host{};
    std::int64_t number = 0;
    double seconds = 0;
  } mine;
  gethostname(mine.host.data(), mine.host.size() - 1);
  mine.number = getpid();
  mine.seconds = after.process - before.process;
  std::map<std::int64_t, double> by_process;  // of this host: ranks may be threads of one
  for (const comm::Buffer& buffer : comm::gather(communicator, 0, comm::Buffer::of_value(mine))) {
    const Process& process = buffer.as<Process>()[0];
    if (process.host == mine.host) by_process[process.number] = process.seconds;
  }
  if (before.machine < 0 || !(seconds > 0)) return -1;
  double others = after.machine - before.machine;
  for (const auto& [number, own] : by_process) others -= own;
  return std::max(0.0, others / seconds);
}

double last_end(const comm::Ledger& ledger) {
  double last = 0;
  for (const std::vector<comm::Event>& events : ledger.ranks)
    for (const comm::Event& event : events) last = std::max(last, event.end);
  return last;
}

}  // namespace

void run_recorded(comm::Communicator& communicator, const RecordOptions& options,
                  const std::function<void(comm::Communicator&)>& body) {
  std::vector<comm::Event> events;
  const BusySeconds busy = busy_seconds();
  comm::barrier(communicator);
  const double begin = communicator.seconds();
  {
    comm::Recording recording = options.has_cores
                                    ? comm::Recording(communicator, events)
                                    : comm::Recording::with_processor_time(communicator, events);
    comm::Charged charged(
        recording, options.has_cores ? comm::ChargedTime::clock : comm::ChargedTime::processor);
    body(charged);
    charged.mark(comm::Phase::other, 0);  // charges for what followed the last message
  }
  comm::RecordedRun run;
  run.other_programs = other_programs(communicator, busy, communicator.seconds() - begin);
  count_from(begin, events);
  run.ledger = comm::gather_ledger(communicator, events);
  comm::all_or_none(communicator, comm::Phase::other, [&] {
    if (communicator.rank() != 0) return;
    run.program = options.program;
    run.seconds = last_end(run.ledger);
    run.machine = comm::machine_of(
        run.ledger, static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
    files::write_file(options.file, comm::ledger_text(run));
  });
}

}  // namespace delray::apps
