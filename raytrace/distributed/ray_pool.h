// The pool of rays of one rank that are still to be traced, over a scene that every rank has: rays
// of its own tiles, and those that it took from other ranks.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <unordered_map>
#include <vector>

#include "loadbalance/divisible_work.h"
#include "raytrace/integrators/sample_tile.h"
#include "raytrace/integrators/waiting_rays.h"

namespace delray::raytrace {

// A tile is traced in wavefronts: one sample of a square of its pixels each. Of those in progress
// samples of some blocks of pixels move with all of their rays that wait; whoever has them traces
// what follows, and returns the sums to the tile's rank, which adds them in the order of samples.
// So the picture has the same bytes wherever rays were traced.
class RayPool final : public loadbalance::DivisibleWork {
 public:
  // Of integrators that this rank's threads take in turn. REQUIRES: both outlive it.
  RayPool(comm::Communicator& communicator, const TiledFrame& frame);

  // Adds the wavefronts of a tile.
  void begin(std::uint32_t tile);

  std::uint64_t units_of(std::uint32_t tile) const override;
  std::uint64_t waiting() const override { return waiting_rays_; }
  bool wants_task() const override { return waiting_.size() < threads_; }
  bool advance() override;
  Released release(std::uint64_t amount) override;
  std::uint64_t put(std::span<const std::byte> message) override;
  std::vector<comm::Parcel> take_results() override;
  void put_results(std::span<const std::byte> message) override;

  // Those that this rank began, once all is done.
  std::vector<TilePixels>& tiles() { return done_; }
  // Traced here, whosoever's tiles they are of.
  const RayCounts& rays() const { return rays_; }
  double busy() const { return busy_; }

 private:
  struct Square {
    Task task;  // its next sample to be added
    std::map<int, std::vector<SampleBlock>> early;
  };
  struct Tile {
    TilePixels pixels;
    std::vector<Square> squares;
    std::size_t wavefronts = 0;  // that are not complete
  };
  // A sample of a square of a tile.
  struct Place {
    Tile* tile = nullptr;
    std::size_t square = 0;
    int sample = 0;
  };
  // A wavefront of this rank of which some blocks are elsewhere.
  struct Scattered {
    Place place;
    std::vector<SampleBlock> samples;
    std::size_t missing = 0;  // blocks, here and elsewhere
  };
  static constexpr std::uint32_t kWhole = 0xFFFFFFFF;
  struct Wavefront {
    int home = 0;
    std::uint32_t scattered = kWhole;  // number in the home's scattered_; kWhole: all of it is here
    Place place;                       // at home
    Task task;
    std::unique_ptr<WavefrontIntegrator> integrator;  // null: not begun
    std::vector<std::uint8_t> here;                   // blocks b with here[b] != 0; empty: all
    std::uint64_t waiting = 0;                        // rays
    std::uint64_t rasterized = 0;
    double busy = 0.0;
  };

  // Rays and processor time of blocks.
  struct Took {
    RayCounts rays;
    double seconds = 0.0;
  };

  void divide_among_threads();
  std::uint64_t trace(Wavefront& wavefront, std::uint64_t most);
  void finish(Wavefront& wavefront);
  void scatter(Wavefront& wavefront);
  void deliver(std::uint32_t scattered, std::span<const std::uint8_t> blocks,
               std::span<const SampleBlock> samples, const Took& took);
  void complete(const Place& place, std::span<const SampleBlock> samples);

  comm::Communicator& communicator_;
  const TiledFrame& frame_;
  int first_sample_, last_sample_;  // last: one past it
  std::size_t threads_;
  std::uint64_t rays_at_once_;
  std::deque<Wavefront> waiting_;  // those in progress first
  std::uint64_t waiting_rays_ = 0;
  std::unordered_map<std::uint32_t, Scattered> scattered_;
  std::uint32_t next_scattered_ = 0;
  std::map<int, RayWriter> results_;  // by rank
  std::vector<std::unique_ptr<Tile>> open_;
  std::vector<TilePixels> done_;
  RayCounts rays_;
  double busy_ = 0.0;
};

}  // namespace delray::raytrace
