// Counts and times a scheme without pixels: its own code runs for all ranks on a simulated machine,
// on layers without pixels, and a tally notes what each rank sends and composites.
//
// Compositing ends with the last rank; the gather begins when all have ended. One thread; time and
// memory in proportion to the messages and to what they cover. Degenerate: a single rank sends
// nothing.
#include "composite/simulate.h"

#include <algorithm>
#include <stdexcept>

#include "comm/collectives.h"
#include "comm/recording.h"
#include "comm/simulated.h"
#include "parallel/arena.h"

namespace delray::composite {
namespace {

class Counter {
 public:
  void add(const comm::Totals& rank) {
    const std::uint64_t pixels = rank.work[static_cast<std::size_t>(comm::Work::pixels_composited)];
    counts_.bytes_total += rank.bytes_sent;
    counts_.bytes_sent_max = std::max(counts_.bytes_sent_max, rank.bytes_sent);
    counts_.bytes_received_max = std::max(counts_.bytes_received_max, rank.bytes_received);
    counts_.messages += rank.messages_sent;
    counts_.pixels_composited_total += pixels;
    counts_.pixels_composited_max = std::max(counts_.pixels_composited_max, pixels);
  }
  void add_round(std::size_t round, bool happened) {
    if (rounds_.size() <= round) rounds_.resize(round + 1);
    if (happened) rounds_[round] = true;
  }
  Counts counts() const {
    Counts result = counts_;
    result.rounds = static_cast<std::uint64_t>(std::count(rounds_.begin(), rounds_.end(), true));
    return result;
  }

 private:
  Counts counts_;
  std::vector<bool> rounds_;
};

std::unique_ptr<Layer> make_layer(const MetadataOnlyImages& images, int rank,
                                  const LayerClock& clock) {
  if (images.codec == MetadataOnly::deep) {
    return make_metadata_only_deep(images.deep[static_cast<std::size_t>(rank)], sizeof(Fragment),
                                   clock);
  }
  const ImageMasks& image = images.ranks[static_cast<std::size_t>(rank)];
  switch (images.codec) {
    case MetadataOnly::dense:
    case MetadataOnly::deep:
      break;
    case MetadataOnly::bounds:
      return make_metadata_only_bounds(image.copy(), images.width, images.pixel_bytes, clock);
    case MetadataOnly::active:
      return make_metadata_only_active(image.copy(), images.pixel_bytes, clock);
  }
  return make_metadata_only_dense(image.covered.pixels(), images.pixel_bytes, image.covered.empty(),
                                  clock);
}

}  // namespace

Counts count(std::span<const comm::Tally> ranks, comm::Phase phase) {
  Counter counter;
  for (const comm::Tally& rank : ranks) {
    const std::vector<bool>& rounds = rank.rounds(phase);
    counter.add(rank.totals(phase));
    for (std::size_t i = 0; i < rounds.size(); ++i) counter.add_round(i, rounds[i]);
  }
  return counter.counts();
}

Counts count(comm::Communicator& communicator, const comm::Tally& own, comm::Phase phase) {
  const std::vector<bool>& rounds = own.rounds(phase);
  const std::vector<std::uint8_t> flags(rounds.begin(), rounds.end());
  Counter counter;
  for (const comm::Buffer& totals :
       comm::gather(communicator, 0, comm::Buffer::of_value(own.totals(phase)))) {
    counter.add(totals.as<comm::Totals>()[0]);
  }
  for (const comm::Buffer& buffer :
       comm::gather(communicator, 0, comm::Buffer::of(std::span<const std::uint8_t>(flags)))) {
    const auto all = buffer.as<std::uint8_t>();
    for (std::size_t i = 0; i < all.size(); ++i) counter.add_round(i, all[i] != 0);
  }
  return counter.counts();
}

Simulated simulate(std::string_view scheme, const MetadataOnlyImages& images,
                   const MachineModel& machine, const ComposeOptions& options) {
  const int ranks = images.count();
  if (ranks < 1) throw std::invalid_argument("there are no images to composite");
  comm::Network network = machine.network;
  network.seconds_per_work[static_cast<std::size_t>(comm::Work::pixels_composited)] =
      machine.costs.merge_covered;
  std::vector<comm::Tally> tallies;
  for (int rank = 0; rank < ranks; ++rank) tallies.emplace_back(rank);
  Simulated result;
  double gather_begin = 0, gather_end = 0;
  parallel::Arena(1).execute([&] {
    comm::run_simulated(ranks, network, 1, [&](comm::Communicator& communicator) {
      const int rank = communicator.rank();
      comm::Recording recording(communicator, tallies[static_cast<std::size_t>(rank)]);
      OwnedPixels part = compose(
          recording, make_layer(images, rank, {&communicator, machine.costs}), scheme, options);
      result.compose_seconds = std::max(result.compose_seconds, communicator.seconds());
      comm::barrier(communicator);
      gather_begin = std::max(gather_begin, communicator.seconds());
      part = gather(recording, std::move(part), 0);
      gather_end = std::max(gather_end, communicator.seconds());
    });
  });
  result.compose = count(tallies, comm::Phase::compose);
  result.gather = count(tallies, comm::Phase::gather);
  result.gather_seconds = gather_end - gather_begin;
  return result;
}

}  // namespace delray::composite
