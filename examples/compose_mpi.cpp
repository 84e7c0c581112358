// Compositing in an MPI program: some of its processes draw, and merge their pictures over a
// communicator of their own, while the others do something else.
//
//   mpirun -n 4 example_compose_mpi [PICTURE.png]
#include <comm/mpi.h>
#include <composite/codec.h>
#include <composite/scheme.h>
#include <image/io.h>
#include <mpi.h>

#include <cstdio>

using namespace delray;

namespace {

constexpr int kWidth = 320, kHeight = 240;

// Any renderer's picture: here a disc for each rank, tilted so that each hides a part of the one
// before.
image::Image8 draw(int rank, int ranks) {
  image::Image8 picture(kWidth, kHeight);
  image::clear(picture);
  const int centre = kWidth * (rank + 1) / (ranks + 1), radius = kHeight / 3;
  const auto shade = static_cast<std::uint8_t>(255 * (rank + 1) / ranks);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const int dx = x - centre, dy = y - kHeight / 2;
      if (dx * dx + dy * dy > radius * radius) continue;
      const auto i = static_cast<std::size_t>(y * kWidth + x);
      picture.colour[i] = {shade, 128, static_cast<std::uint8_t>(255 - shade), 255};
      picture.depth[i] = 1.0F + static_cast<float>(dx) / kWidth;  // smaller is nearer
    }
  }
  return picture;
}

// Returns how many pixels of the merged picture are covered, on rank 0.
int render_together(MPI_Comm renderers, const char* file) {
  const auto communicator = comm::make_mpi_communicator(&renderers);
  image::Image8 picture = draw(communicator->rank(), communicator->size());

  auto layer = composite::find_codec("active")->make(std::move(picture));
  composite::OwnedPixels part = composite::compose(*communicator, std::move(layer), "radix-k");
  part = composite::gather(*communicator, std::move(part), 0);
  if (communicator->rank() != 0) return 0;

  picture = composite::take_image<image::Rgba8>(std::move(part));
  if (file != nullptr) image::write_image(file, picture);
  int covered = 0;
  for (const image::Rgba8& colour : picture.colour.span()) covered += colour.a > 0 ? 1 : 0;
  std::printf("%d ranks, %d pixels covered\n", communicator->size(), covered);
  return covered;
}

}  // namespace

int main(int argc, char** argv) {
  int provided = 0, rank = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);

  // The last process keeps the simulation, the user interface, or whatever else there is.
  int size = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  const bool draws = size == 1 || rank + 1 < size;
  MPI_Comm renderers = MPI_COMM_NULL;
  MPI_Comm_split(MPI_COMM_WORLD, draws ? 0 : MPI_UNDEFINED, rank, &renderers);

  bool fine = true;
  if (draws) {
    const int covered = render_together(renderers, argc > 1 ? argv[1] : nullptr);
    fine = rank != 0 || covered > kHeight * kHeight / 4;
    MPI_Comm_free(&renderers);
  }
  MPI_Finalize();
  return fine ? 0 : 1;
}
