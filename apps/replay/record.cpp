// Wraps the communicator twice: Charged tells the time between messages as work, Recording writes
// all down. Clocks of the ranks are set to 0 after a barrier.
#include "apps/replay/record.h"

#include <algorithm>
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
  comm::barrier(communicator);
  const double begin = communicator.seconds();
  {
    comm::Recording recording(communicator, events);
    comm::Charged charged(
        recording, options.has_cores ? comm::ChargedTime::clock : comm::ChargedTime::processor);
    body(charged);
    charged.mark(comm::Phase::other, 0);  // charges for what followed the last message
  }
  count_from(begin, events);
  comm::RecordedRun run;
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
