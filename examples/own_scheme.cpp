// A compositing scheme of one's own. Every rank owns a piece of the image; what the ranks below the
// owner show of it is merged on its way up from rank 0, what those above show on its way down from
// the last. Ranks talk to their two neighbours only, and each sends its image once, but for its own
// piece. The scheme runs over threads here; it is the same over MPI and on the simulated machine.
#include <comm/ledger.h>
#include <comm/recording.h>
#include <comm/threads.h>
#include <composite/codec.h>
#include <composite/scheme.h>
#include <image/hash.h>

#include <cstdio>
#include <string>

using namespace delray;
using composite::PixelRange;
using composite::Side;

namespace {

composite::OwnedPixels chains(comm::Communicator& communicator,
                              std::unique_ptr<composite::Layer> layer,
                              const composite::ComposeOptions& options) {
  const int rank = communicator.rank(), ranks = communicator.size();
  const std::uint64_t samples = static_cast<std::uint64_t>(options.samples_per_pixel);
  const std::uint64_t pixels = layer->pixels() / samples;
  const auto piece_of = [&](int owner) {
    const auto begin = static_cast<std::uint64_t>(owner), all = static_cast<std::uint64_t>(ranks);
    return PixelRange{pixels * begin / all * samples, pixels * (begin + 1) / all * samples};
  };
  const auto merge = [&](int from, int owner, Side side) {
    if (from < 0 || from >= ranks) return;
    const PixelRange piece = piece_of(owner);
    const comm::Buffer pixels_received = communicator.receive(from, owner);
    communicator.work(comm::Work::pixels_composited, layer->merge(piece, pixels_received, side));
  };
  communicator.mark(comm::Phase::compose, 0);
  for (int owner = ranks - 1; owner > rank; --owner) {  // up; sending never blocks
    merge(rank - 1, owner, Side::lower);
    communicator.send(rank + 1, owner, layer->encode(piece_of(owner)));
  }
  for (int owner = 0; owner < rank; ++owner) {  // down
    merge(rank + 1, owner, Side::higher);
    communicator.send(rank - 1, owner, layer->encode(piece_of(owner)));
  }
  merge(rank - 1, rank, Side::lower);
  merge(rank + 1, rank, Side::higher);
  return {{piece_of(rank)}, std::move(layer)};
}

// What rank `rank` drew: every seventh pixel, at a depth of its own.
image::Image8 draw(int rank) {
  image::Image8 picture(200, 100);
  image::clear(picture);
  for (std::size_t i = static_cast<std::size_t>(rank) % 3; i < picture.pixels(); i += 7) {
    picture.colour[i] = {static_cast<std::uint8_t>(40 * rank), 100, 200, 255};
    picture.depth[i] = static_cast<float>((i * 31 + static_cast<std::size_t>(rank) * 17) % 101);
  }
  return picture;
}

// The hash of the picture that a scheme makes; prints what rank 0 sends for it.
std::string compose(const composite::Scheme& scheme, int ranks) {
  std::string hash;
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    comm::Tally tally(communicator.rank());
    comm::Recording recording(communicator, tally);
    auto layer = composite::find_codec("active")->make(draw(communicator.rank()));
    composite::OwnedPixels part = scheme.compose(recording, std::move(layer), {});
    part = composite::gather(communicator, std::move(part), 0);
    if (communicator.rank() != 0) return;
    const comm::Totals& totals = tally.totals(comm::Phase::compose);
    std::printf("%-12s %d ranks: rank 0 sends %llu messages, %llu bytes\n", scheme.name, ranks,
                static_cast<unsigned long long>(totals.messages_sent),
                static_cast<unsigned long long>(totals.bytes_sent));
    hash = image::hash(composite::take_image<image::Rgba8>(std::move(part)));
  });
  return hash;
}

}  // namespace

int main() {
  // A row of the table of schemes looks like this, too.
  const composite::Scheme own{"chains", "pieces go up and down to their owners", &chains, "chain"};
  for (int ranks = 1; ranks <= 6; ++ranks) {
    if (compose(own, ranks) != compose(*composite::find_scheme("binary-swap"), ranks)) return 1;
  }
  return 0;
}
