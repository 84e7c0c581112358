// Traces wavefronts of a rank's tiles, and of others' tiles, a few hundred rays at a time, so that
// messages are answered in between. Waiting rays are released from the end of the pool: camera
// rays of wavefronts that are not begun, by their numbers, then blocks of those that are. Sums of
// samples that are done before their turn wait for it.
//
// Degenerate: a wavefront in progress keeps one of its blocks, and one of a single block is not
// divided; tiles of which nothing is rendered have no wavefronts.
#include "raytrace/distributed/ray_pool.h"

#include <algorithm>
#include <atomic>
#include <iterator>
#include <utility>

#include "comm/bad_message.h"
#include "parallel/arena.h"
#include "parallel/parallel_for.h"
#include "raytrace/integrators/intersect.h"
#include "raytrace/scene/flush_to_zero.h"

namespace delray::raytrace {
namespace {

// Rays that a thread traces between two looks at messages: some hundred microseconds, and more
// where threads wait for each other at the end of it.
constexpr std::uint64_t kRaysAtOnce = 512, kRaysAtOnceOfSeveral = 2048;
// Rays that wait, at least, where they are divided for threads that have none.
constexpr std::uint64_t kLeastToDivide = 512;
// Wavefronts that threads take at once: enough for all to come to their number of rays.
constexpr std::size_t kWavefrontsForThread = 8;

// What becomes of a wavefront, or of blocks of one, on another rank.
struct MovedRays {
  std::int32_t home = 0;
  std::uint32_t scattered = 0;
  Task task;
  std::uint32_t is_begun = 0;  // blocks and their rays follow
};
struct FoundSamples {
  std::uint32_t scattered = 0;
  RayCounts rays;
  double busy = 0.0;
};

std::size_t count_of(std::span<const std::uint8_t> blocks) {
  return blocks.size() - static_cast<std::size_t>(std::ranges::count(blocks, std::uint8_t{0}));
}

// Blocks of a wavefront in progress that have at most `amount` waiting rays together; one of those
// that are `here` stays. Subtracts their rays from the amount.
std::vector<std::uint8_t> blocks_to_release(WavefrontIntegrator& integrator,
                                            std::span<const std::uint8_t> here,
                                            std::uint64_t& amount) {
  const std::vector<std::uint32_t> waiting = integrator.waiting();
  std::vector<std::uint8_t> chosen(waiting.size(), 0);
  std::size_t left = here.empty() ? chosen.size() : count_of(here);
  for (std::size_t b = chosen.size(); b-- > 0 && left > 1;) {
    if (waiting[b] == 0 || waiting[b] > amount) continue;
    amount -= waiting[b];
    chosen[b] = 1;
    --left;
  }
  return chosen;
}

}  // namespace

RayPool::RayPool(comm::Communicator& communicator, const TiledFrame& frame)
    : communicator_(communicator),
      frame_(frame),
      first_sample_(frame.options.part.first_sample),
      last_sample_(first_sample_ + samples_of(frame.options)),
      threads_(static_cast<std::size_t>(parallel::arena_threads())),
      rays_at_once_(threads_ > 1 ? kRaysAtOnceOfSeveral : kRaysAtOnce) {}

std::uint64_t RayPool::units_of(std::uint32_t tile) const {
  return static_cast<std::uint64_t>(frame_.tiles.block(tile).area()) *
         static_cast<std::uint64_t>(last_sample_ - first_sample_);
}

void RayPool::begin(std::uint32_t number) {
  TilePixels pixels = start_tile(frame_, number);
  const std::vector<Task> tasks = tasks_of(frame_, pixels.rect, frame_.integrators.side());
  if (tasks.empty()) {
    done_.push_back(std::move(pixels));
    return;
  }
  Tile& tile = *open_.emplace_back(std::make_unique<Tile>());
  tile.pixels = std::move(pixels);
  for (const Task& task : tasks) {
    for (int sample = first_sample_; sample < last_sample_; ++sample) {
      Wavefront& wavefront = waiting_.emplace_back();
      wavefront.home = communicator_.rank();
      wavefront.place = {&tile, tile.squares.size(), sample};
      wavefront.task = task;
      wavefront.task.first_sample = sample;
      wavefront.waiting = static_cast<std::uint64_t>(task.pixels.area());
      waiting_rays_ += wavefront.waiting;
      ++tile.wavefronts;
    }
    tile.squares.push_back({task, {}});
  }
}

// Where there are fewer wavefronts than threads: what other ranks would get, threads get.
void RayPool::divide_among_threads() {
  while (waiting_.size() < threads_ && waiting_rays_ >= kLeastToDivide) {
    const std::size_t before = waiting_.size();
    put(release(waiting_rays_ / 2).message.as<std::byte>());
    if (waiting_.size() == before) return;
  }
}

bool RayPool::advance() {
  if (waiting_.empty()) return false;
  divide_among_threads();
  const std::size_t count = std::min(waiting_.size(), threads_ * kWavefrontsForThread);
  const auto end = waiting_.begin() + static_cast<std::ptrdiff_t>(count);
  std::vector<Wavefront> taken(std::make_move_iterator(waiting_.begin()),
                               std::make_move_iterator(end));
  waiting_.erase(waiting_.begin(), end);
  for (const Wavefront& wavefront : taken) waiting_rays_ -= wavefront.waiting;
  std::atomic<std::size_t> next = 0;
  std::atomic<std::uint64_t> traced = 0;
  parallel::parallel_for(0, threads_, 1, [&](std::size_t) {
    std::uint64_t mine = 0;
    while (mine < rays_at_once_) {
      const std::size_t i = next++;
      if (i >= count) break;
      // At least a generation of rays, or there would be no end.
      mine += std::max<std::uint64_t>(1, trace(taken[i], rays_at_once_ - mine));
    }
    traced += mine;
  });
  std::erase_if(taken, [this](Wavefront& wavefront) {
    if (wavefront.integrator == nullptr || !wavefront.integrator->done()) return false;
    finish(wavefront);
    return true;
  });
  for (const Wavefront& wavefront : taken) waiting_rays_ += wavefront.waiting;
  waiting_.insert(waiting_.begin(), std::make_move_iterator(taken.begin()),
                  std::make_move_iterator(taken.end()));
  communicator_.work(comm::Work::rays, traced);
  return true;
}

// Generation after generation until it is done or so many rays are traced. Returns how many were.
std::uint64_t RayPool::trace(Wavefront& wavefront, std::uint64_t most) {
  const FlushToZero flush;
  const double start = thread_seconds();
  std::uint64_t traced = 0, sent = 0;
  const auto advance = [&] {
    traced += wavefront.waiting;
    sent = wavefront.integrator->rays().sent();
    wavefront.integrator->advance();
    wavefront.waiting = wavefront.integrator->rays().sent() - sent;
  };
  if (wavefront.integrator == nullptr) {
    wavefront.integrator = frame_.integrators.take();
    wavefront.integrator->start(wavefront.task);
    wavefront.waiting = wavefront.integrator->rays().sent();
    if (frame_.first_hits != nullptr && !wavefront.integrator->done()) {
      FirstHits::Memory memory;
      RayBatch& batch = wavefront.integrator->batch();
      wavefront.rasterized = frame_.first_hits->find(wavefront.task.pixels, batch.rays, memory);
      intersect_rest(*frame_.tracer, batch, memory.left);
      advance();
    }
  }
  while (!wavefront.integrator->done() && traced < most) {
    intersect(*frame_.tracer, frame_.context.shader, wavefront.integrator->batch());
    advance();
  }
  wavefront.busy += thread_seconds() - start;
  return traced;
}

// Of a wavefront whose integrator is done: to the tile where that is here, else to its rank.
void RayPool::finish(Wavefront& wavefront) {
  WavefrontIntegrator& integrator = *wavefront.integrator;
  const std::span<const SampleBlock> samples = integrator.samples();
  RayCounts rays = integrator.rays();
  rays.rasterized = wavefront.rasterized;
  rays_ += rays;
  busy_ += wavefront.busy;
  if (wavefront.here.empty()) wavefront.here.assign(samples.size(), 1);
  if (wavefront.home != communicator_.rank()) {
    RayWriter& to = results_[wavefront.home];
    to.value(FoundSamples{wavefront.scattered, rays, wavefront.busy});
    for (std::size_t b = 0; b < samples.size(); ++b) {
      to.value(wavefront.here[b]);
      if (wavefront.here[b] != 0) to.value(samples[b]);
    }
  } else if (wavefront.scattered == kWhole) {
    wavefront.place.tile->pixels.rays += rays;
    wavefront.place.tile->pixels.busy += wavefront.busy;
    complete(wavefront.place, samples);
  } else {
    deliver(wavefront.scattered, wavefront.here, samples, {rays, wavefront.busy});
  }
  frame_.integrators.give(std::move(wavefront.integrator));
}

// Some blocks of a wavefront of this rank.
void RayPool::deliver(std::uint32_t number, std::span<const std::uint8_t> blocks,
                      std::span<const SampleBlock> samples, const Took& took) {
  Scattered& scattered = scattered_.at(number);
  TilePixels& pixels = scattered.place.tile->pixels;
  pixels.rays += took.rays;
  pixels.busy += took.seconds;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (blocks[b] != 0) scattered.samples[b] = samples[b];
  }
  scattered.missing -= count_of(blocks);
  if (scattered.missing > 0) return;
  complete(scattered.place, scattered.samples);
  scattered_.erase(number);
}

void RayPool::complete(const Place& place, std::span<const SampleBlock> samples) {
  const FlushToZero flush;
  Tile& tile = *place.tile;
  Square& square = tile.squares[place.square];
  const std::uint64_t surplus = surplus_of(frame_, tile.pixels.rect, square.task);
  tile.pixels.rays.surplus += surplus;
  rays_.surplus += surplus;
  square.early.emplace(place.sample, std::vector<SampleBlock>(samples.begin(), samples.end()));
  while (!square.early.empty() && square.early.begin()->first == square.task.first_sample) {
    add_samples(frame_, square.early.begin()->second, square.task, tile.pixels);
    square.early.erase(square.early.begin());
    ++square.task.first_sample;
  }
  if (--tile.wavefronts > 0) return;
  done_.push_back(std::move(tile.pixels));
  std::erase_if(open_, [&tile](const auto& open) { return open.get() == &tile; });
}

void RayPool::scatter(Wavefront& wavefront) {
  const auto blocks = static_cast<std::size_t>(wavefront.task.blocks());
  if (wavefront.here.empty()) wavefront.here.assign(blocks, 1);
  if (wavefront.scattered != kWhole) return;
  wavefront.scattered = next_scattered_++;
  scattered_[wavefront.scattered] = {wavefront.place, std::vector<SampleBlock>(blocks), blocks};
}

loadbalance::DivisibleWork::Released RayPool::release(std::uint64_t amount) {
  RayWriter to;
  Released released;
  const auto add = [&](Wavefront& wavefront, std::uint64_t rays) {
    scatter(wavefront);
    to.value(MovedRays{wavefront.home, wavefront.scattered, wavefront.task,
                       wavefront.integrator != nullptr ? 1U : 0U});
    wavefront.waiting -= rays;
    released.units += rays;
  };
  constexpr int kGone = -1;
  for (auto wavefront = waiting_.rbegin(); wavefront != waiting_.rend() && amount > 0;
       ++wavefront) {
    if (wavefront->integrator == nullptr) {
      if (wavefront->waiting > amount) continue;
      amount -= wavefront->waiting;
      add(*wavefront, wavefront->waiting);
      wavefront->home = kGone;
      continue;
    }
    const std::uint64_t before = amount;
    const std::vector<std::uint8_t> chosen =
        blocks_to_release(*wavefront->integrator, wavefront->here, amount);
    if (amount == before) continue;
    add(*wavefront, before - amount);
    wavefront->integrator->release(chosen, to);
    for (std::size_t b = 0; b < chosen.size(); ++b) {
      if (chosen[b] != 0) wavefront->here[b] = 0;
    }
  }
  std::erase_if(waiting_, [](const Wavefront& wavefront) { return wavefront.home == kGone; });
  waiting_rays_ -= released.units;
  if (released.units > 0) released.message = comm::Buffer::of(to.bytes());
  return released;
}

std::uint64_t RayPool::put(std::span<const std::byte> message) {
  std::uint64_t rays = 0;
  for (RayReader from(message); !from.at_end();) {
    const auto piece = from.next<MovedRays>();
    comm::check_message(piece.home >= 0 && piece.home < communicator_.size() &&
                        !piece.task.pixels.empty() && piece.task.samples == 1 &&
                        geometry::intersection(piece.task.pixels, frame_.tiles.frame) ==
                            piece.task.pixels);
    Wavefront& wavefront = waiting_.emplace_front();
    wavefront.home = piece.home;
    wavefront.scattered = piece.scattered;
    wavefront.task = piece.task;
    wavefront.waiting = static_cast<std::uint64_t>(piece.task.pixels.area());
    if (piece.is_begun != 0) {
      wavefront.integrator = frame_.integrators.take();
      wavefront.here = wavefront.integrator->resume(piece.task, from);
      wavefront.waiting = wavefront.integrator->rays().sent();
    }
    rays += wavefront.waiting;
  }
  waiting_rays_ += rays;
  return rays;
}

std::vector<comm::Parcel> RayPool::take_results() {
  std::vector<comm::Parcel> parcels;
  for (const auto& [rank, results] : std::exchange(results_, {}))
    parcels.push_back({rank, comm::Buffer::of(results.bytes())});
  return parcels;
}

void RayPool::put_results(std::span<const std::byte> message) {
  for (RayReader from(message); !from.at_end();) {
    const auto found = from.next<FoundSamples>();
    const auto at = scattered_.find(found.scattered);
    comm::check_message(at != scattered_.end());
    std::vector<SampleBlock> samples(at->second.samples.size());
    std::vector<std::uint8_t> blocks(samples.size());
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      from.value(blocks[b]);
      if (blocks[b] != 0) from.value(samples[b]);
    }
    deliver(found.scattered, blocks, samples, {found.rays, found.busy});
  }
}

}  // namespace delray::raytrace
