// Runs a schedule on the simulated machine with one thread to a rank; a task is work of a known
// number of nanoseconds, its result a part of a message of a known size.
#include "loadbalance/simulated_schedule.h"

#include <algorithm>
#include <cstring>
#include <deque>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "comm/collectives.h"
#include "comm/simulated.h"
#include "loadbalance/divisible_work.h"
#include "parallel/arena.h"

namespace delray::loadbalance {

namespace {

void do_part(comm::Communicator& communicator, const SimulatedTasks& tasks, std::uint32_t task,
             double part, SimulatedSchedule& result) {
  const auto rank = static_cast<std::size_t>(communicator.rank());
  const double seconds = tasks.seconds[task] * part;
  communicator.work(comm::Work::seconds_e9, static_cast<std::uint64_t>(seconds * 1e9 + 0.5));
  result.busy[rank] += seconds;
  if (!tasks.rays.empty()) result.rays[rank] += static_cast<double>(tasks.rays[task]) * part;
}

// The units of tasks whose times are known, on one rank: pieces of tasks.
class SimulatedUnits final : public DivisibleWork {
 public:
  SimulatedUnits(comm::Communicator& communicator, const SimulatedTasks& tasks,
                 SimulatedSchedule& result)
      : communicator_(communicator), tasks_(tasks), result_(result) {}

  void begin(std::uint32_t task) {
    pieces_.push_front({communicator_.rank(), task, tasks_.units[task]});
    waiting_ += tasks_.units[task];
  }

  std::uint64_t units_of(std::uint32_t task) const override { return tasks_.units[task]; }
  std::uint64_t waiting() const override { return waiting_; }
  bool wants_task() const override { return pieces_.empty(); }

  bool advance() override {
    if (pieces_.empty()) return false;
    Piece& piece = pieces_.front();
    const std::uint64_t done = std::min(piece.units, kUnitsAtOnce), all = tasks_.units[piece.task];
    // A task without units takes its time all the same.
    const double part = all > 0 ? static_cast<double>(done) / static_cast<double>(all) : 1.0;
    do_part(communicator_, tasks_, piece.task, part, result_);
    waiting_ -= done;
    piece.units -= done;
    if (piece.home != communicator_.rank()) found_[piece.home] += done;
    if (piece.units == 0) pieces_.pop_front();
    return true;
  }

  Released release(std::uint64_t amount) override {
    std::vector<Piece> taken;
    Released released;
    for (auto piece = pieces_.rbegin(); piece != pieces_.rend() && amount > 0; ++piece) {
      const std::uint64_t units = std::min(piece->units, amount);
      if (units == 0) continue;
      taken.push_back({piece->home, piece->task, units});
      piece->units -= units;
      amount -= units;
      released.units += units;
    }
    waiting_ -= released.units;
    std::erase_if(pieces_, [&](const Piece& piece) {
      return piece.units == 0 && tasks_.units[piece.task] > 0;
    });
    if (taken.empty()) return released;
    released.message = comm::Buffer::standing_for(bytes_of(released.units, tasks_.unit_bytes),
                                                  comm::Buffer::of(std::span<const Piece>(taken)));
    return released;
  }

  std::uint64_t put(std::span<const std::byte> message) override {
    std::vector<Piece> taken(message.size() / sizeof(Piece));
    std::memcpy(taken.data(), message.data(), taken.size() * sizeof(Piece));
    std::uint64_t units = 0;
    for (const Piece& piece : taken) {
      pieces_.push_front(piece);
      units += piece.units;
    }
    waiting_ += units;
    return units;
  }

  std::vector<comm::Parcel> take_results() override {
    std::vector<comm::Parcel> parcels;
    for (const auto& [home, units] : std::exchange(found_, {}))
      parcels.push_back({home, comm::Buffer::standing_for(bytes_of(units, tasks_.unit_result_bytes),
                                                          comm::Buffer())});
    return parcels;
  }
  void put_results(std::span<const std::byte>) override {}

 private:
  static std::size_t bytes_of(std::uint64_t units, double each) {
    return static_cast<std::size_t>(static_cast<double>(units) * each);
  }

  // As many as a rank does between two looks at messages.
  static constexpr std::uint64_t kUnitsAtOnce = 512;

  // Units of a task of rank `home`.
  struct Piece {
    int home = 0;
    std::uint32_t task = 0;
    std::uint64_t units = 0;
  };

  comm::Communicator& communicator_;
  const SimulatedTasks& tasks_;
  SimulatedSchedule& result_;
  std::deque<Piece> pieces_;
  std::map<int, std::uint64_t> found_;  // units of other ranks done, by rank
  std::uint64_t waiting_ = 0;
};

// Sends a rank's results to rank 0, where they become a part of all.
void gather_results(comm::Communicator& communicator, const SimulatedTasks& tasks,
                    std::uint64_t mine, std::uint64_t all) {
  const auto copy = [&](std::uint64_t bytes) {
    communicator.work(
        comm::Work::seconds_e9,
        static_cast<std::uint64_t>(static_cast<double>(bytes) * tasks.seconds_per_byte * 1e9));
  };
  const bool root = communicator.rank() == 0;
  if (!root) copy(mine);
  comm::gather(communicator, 0,
               root ? comm::Buffer()
                    : comm::Buffer::standing_for(tasks.message_bytes + mine, comm::Buffer()));
  if (root) copy(all - mine);
}

}  // namespace

SimulatedSchedule simulate(const Schedule& schedule, const SimulatedTasks& tasks, int ranks,
                           const comm::Network& network, const ScheduleOptions& options) {
  const std::size_t count = tasks.grid.count();
  if (tasks.seconds.size() != count ||
      (!tasks.result_bytes.empty() && tasks.result_bytes.size() != count))
    throw std::invalid_argument("there are not as many times as tasks");
  if ((!tasks.units.empty() && tasks.units.size() != count) ||
      (!tasks.rays.empty() && tasks.rays.size() != count))
    throw std::invalid_argument("there are not as many numbers of units, or of rays, as tasks");
  if (ranks < 1) throw std::invalid_argument("there is at least one rank");
  SimulatedSchedule result;
  result.ranks.resize(static_cast<std::size_t>(ranks));
  result.busy.resize(result.ranks.size());
  result.rays.resize(result.ranks.size());
  result.owners.assign(count, -1);
  const std::uint64_t all_bytes =
      std::accumulate(tasks.result_bytes.begin(), tasks.result_bytes.end(), std::uint64_t{0});
  ScheduleOptions how = options;
  how.threads = 1;
  parallel::Arena(1).execute([&] {
    comm::run_simulated(ranks, network, 1, [&](comm::Communicator& communicator) {
      const int rank = communicator.rank();
      const auto at = static_cast<std::size_t>(rank);
      std::uint64_t mine = 0;
      SimulatedUnits units(communicator, tasks, result);
      const bool divides = schedule.divides && !tasks.units.empty();
      ScheduleOptions with = how;
      if (divides) with.divisible = &units;
      result.ranks[at] = schedule.run(communicator, tasks.grid, with, [&](std::uint32_t task, int) {
        result.owners[task] = rank;
        if (!tasks.result_bytes.empty()) mine += tasks.result_bytes[task];
        if (divides) return units.begin(task);
        do_part(communicator, tasks, task, 1.0, result);
      });
      if (!tasks.result_bytes.empty()) gather_results(communicator, tasks, mine, all_bytes);
      if (rank == 0) result.frame_seconds = communicator.seconds();
    });
  });
  for (const RankReport& rank : result.ranks) {
    for (const Interval& interval : rank.timeline) {
      if (interval.kind == Interval::Kind::work)
        result.seconds = std::max(result.seconds, interval.end);
    }
  }
  return result;
}

}  // namespace delray::loadbalance
