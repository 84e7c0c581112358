/* Inside an MPI program whose communicator is a split one: images are composited, and each rank
 * renders a part of a scene, opaque and see-through, to the same bytes as all of it on one rank. */
#include <mpi.h>

#include "tests/c/scene.h"

#define W 48
#define H 36

static void test_compose(DelrayCommunicator ranks) {
  unsigned char mine[W * H * 4], whole[W * H * 4];
  float depth[W * H], nearest[W * H];
  DelrayImage image, result;
  DelrayComposeOptions options = DELRAY_COMPOSE_OPTIONS;
  const int rank = delrayRank(ranks), n = delrayRanks(ranks);
  int i, r;
  options.root = n - 1;
  options.scheme = "binary-swap";
  for (i = 0; i < W * H; ++i) {
    const int shown = (i + rank) % 3 != 0;
    depth[i] = shown ? 0.1F + 0.8F * (float)((i * 31 + rank * 17) % 101) / 101.0F : 1.0F;
    memset(mine + 4 * i, 0, 4);
    if (shown) {
      mine[4 * i] = (unsigned char)(rank + 1);
      mine[4 * i + 3] = 255;
    }
  }
  image.width = W;
  image.height = H;
  image.type = DELRAY_UFIXED8_RGBA_SRGB;
  image.colour = mine;
  image.depth = depth;
  result = image;
  result.colour = whole;
  result.depth = nearest;
  OK(delrayCompose(ranks, &image, &options, rank == options.root ? &result : NULL));
  for (i = 0; rank == options.root && i < W * H; ++i) {
    float least = 1.0F;
    int winner = 0;
    for (r = 0; r < n; ++r) {
      const float z =
          (i + r) % 3 != 0 ? 0.1F + 0.8F * (float)((i * 31 + r * 17) % 101) / 101.0F : 1.0F;
      if (z < least) {
        least = z;
        winner = r + 1;
      }
    }
    CHECK(whole[4 * i] == winner && nearest[i] == least);
  }
  /* What is wrong on one rank fails on all. */
  options.scheme = NULL;
  if (rank == 0) image.colour = NULL;
  FAILS(DELRAY_INVALID_ARGUMENT, delrayCompose(ranks, &image, &options, &result), "mine->colour");
  image.colour = mine;
  options.scheme = "fastest";
  FAILS(DELRAY_INVALID_ARGUMENT, delrayCompose(ranks, &image, &options, &result), "fastest");
}

static void test_frame(MPI_Comm comm, float opacity) {
  DelrayDevice d = delrayNewDevice(1);
  const void* address = &comm;
  DelrayWorld part, all;
  DelrayFrame mine, alone;
  uint32_t width, height;
  DelrayDataType type;
  const unsigned char *pixels, *expected;
  const float *depth, *expected_depth;
  int rank, size, i;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  /* Ranks beyond the second have nothing. */
  part = new_world(d, size == 1 ? 3 : rank == 0 ? 2 : rank == 1 ? 1 : 0, opacity);
  mine = new_frame(d, part, "default", DELRAY_UFIXED8_RGBA_SRGB, W, H);
  OK(delraySetParameter(d, mine, "mpiCommunicator", DELRAY_VOID_POINTER, &address));
  OK(delrayCommitParameters(d, mine));
  for (i = 0; i < 2; ++i) OK(delrayRenderFrame(d, mine));
  pixels = (const unsigned char*)delrayMapFrame(d, mine, "channel.color", &width, &height, &type);
  CHECK((pixels != NULL) == (rank == 0));
  if (rank == 0) {
    all = new_world(d, 3, opacity);
    alone = new_frame(d, all, "default", DELRAY_UFIXED8_RGBA_SRGB, W, H);
    OK(delrayRenderFrame(d, alone));
    expected =
        (const unsigned char*)delrayMapFrame(d, alone, "channel.color", &width, &height, &type);
    CHECK(memcmp(pixels, expected, W * H * 4) == 0);
    CHECK(pixels[4 * (H / 2 * W + W / 2)] > 50);
    CHECK((pixels[4 * (H / 2 * W + W / 2) + 2] > 20) == (opacity < 1));
    depth = (const float*)delrayMapFrame(d, mine, "channel.depth", &width, &height, &type);
    expected_depth =
        (const float*)delrayMapFrame(d, alone, "channel.depth", &width, &height, &type);
    for (i = 0; i < W * H; ++i) {
      CHECK(depth[i] == expected_depth[i] ||
            (depth[i] - expected_depth[i] < 1e-5F && expected_depth[i] - depth[i] < 1e-5F));
    }
    delrayRelease(d, alone);
    delrayRelease(d, all);
  }
  delrayRelease(d, mine);
  delrayRelease(d, part);
  delrayReleaseDevice(d);
}

int main(int argc, char** argv) {
  int rank, provided;
  MPI_Comm half;
  DelrayCommunicator ranks;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_split(MPI_COMM_WORLD, rank % 2, -rank, &half); /* and turned round */
  ranks = delrayNewCommunicator(&half);
  CHECK(ranks != NULL);
  CHECK(delrayNewCommunicator(NULL) == NULL);
  test_compose(ranks);
  delrayReleaseCommunicator(ranks);
  test_frame(half, 1);
  test_frame(half, 0.5F);
  MPI_Comm_free(&half);
  MPI_Finalize();
  return 0;
}
