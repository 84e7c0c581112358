// Wraps the C interface of IceT: one tile as large as the picture, composited in the order of ranks
// or by depth. A table says which strategies and single-image strategies of IceT there are, and
// which of them can composite in order.
#include "bench/peers/icet.h"

#include <IceT.h>
#include <IceTMPI.h>
#include <mpi.h>

#include <stdexcept>

namespace delray::bench {
namespace {

struct Strategy {
  const char* name;
  IceTEnum strategy, single_image;
  bool ordered;
};

constexpr Strategy kStrategies[] = {
    {"bswap", ICET_STRATEGY_SEQUENTIAL, ICET_SINGLE_IMAGE_STRATEGY_BSWAP, true},
    {"bswap-folding", ICET_STRATEGY_SEQUENTIAL, ICET_SINGLE_IMAGE_STRATEGY_BSWAP_FOLDING, true},
    {"radixk", ICET_STRATEGY_SEQUENTIAL, ICET_SINGLE_IMAGE_STRATEGY_RADIXK, true},
    {"radixkr", ICET_STRATEGY_SEQUENTIAL, ICET_SINGLE_IMAGE_STRATEGY_RADIXKR, true},
    {"tree", ICET_STRATEGY_SEQUENTIAL, ICET_SINGLE_IMAGE_STRATEGY_TREE, true},
    {"direct", ICET_STRATEGY_DIRECT, ICET_SINGLE_IMAGE_STRATEGY_AUTOMATIC, true},
    {"reduce", ICET_STRATEGY_REDUCE, ICET_SINGLE_IMAGE_STRATEGY_AUTOMATIC, true},
    {"split", ICET_STRATEGY_SPLIT, ICET_SINGLE_IMAGE_STRATEGY_AUTOMATIC, false},
    {"vtree", ICET_STRATEGY_VTREE, ICET_SINGLE_IMAGE_STRATEGY_AUTOMATIC, false},
};

}  // namespace

struct Icet::Context {
  IceTCommunicator communicator;
  IceTContext context;
};

Icet::Icet(int width, int height, IcetKind kind) : context_(new Context) {
  context_->communicator = icetCreateMPICommunicator(MPI_COMM_WORLD);
  context_->context = icetCreateContext(context_->communicator);
  icetDiagnostics(ICET_DIAG_ERRORS);
  icetResetTiles();
  icetAddTile(0, 0, width, height, 0);
  icetSetColorFormat(ICET_IMAGE_COLOR_RGBA_UBYTE);
  icetEnable(ICET_COMPOSITE_ONE_BUFFER);
  icetEnable(ICET_COLLECT_IMAGES);
  icetDisable(ICET_CORRECT_COLORED_BACKGROUND);
  if (kind == IcetKind::nearest) {
    icetSetDepthFormat(ICET_IMAGE_DEPTH_FLOAT);
    icetCompositeMode(ICET_COMPOSITE_MODE_Z_BUFFER);
    icetDisable(ICET_ORDERED_COMPOSITE);
    return;
  }
  icetSetDepthFormat(ICET_IMAGE_DEPTH_NONE);
  icetCompositeMode(ICET_COMPOSITE_MODE_BLEND);
  icetEnable(ICET_ORDERED_COMPOSITE);
  int size = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  std::vector<IceTInt> order;
  for (int i = 0; i < size; ++i) order.push_back(i);
  icetCompositeOrder(order.data());
}

Icet::~Icet() {
  icetDestroyContext(context_->context);
  icetDestroyMPICommunicator(context_->communicator);
  delete context_;
}

std::vector<std::string> Icet::strategies(IcetKind kind) {
  std::vector<std::string> result;
  for (const Strategy& strategy : kStrategies) {
    if (kind == IcetKind::nearest || strategy.ordered) result.emplace_back(strategy.name);
  }
  return result;
}

void Icet::choose(const std::string& name) {
  for (const Strategy& strategy : kStrategies) {
    if (name != strategy.name) continue;
    icetStrategy(strategy.strategy);
    icetSingleImageStrategy(strategy.single_image);
    return;
  }
  throw std::runtime_error("IceT has no strategy " + name);
}

const image::Rgba8* Icet::compose(const image::Rgba8* colour, const float* depth) {
  const IceTFloat background[4] = {0, 0, 0, 0};
  const IceTImage image = icetCompositeImage(colour, depth, nullptr, nullptr, nullptr, background);
  if (icetImageIsNull(image)) return nullptr;
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank == 0 ? reinterpret_cast<const image::Rgba8*>(icetImageGetColorcub(image)) : nullptr;
}

}  // namespace delray::bench
