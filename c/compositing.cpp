// Compositing behind the functions of delray.h.
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>

#include "c/communicator.h"
#include "c/delray.h"
#include "c/guard.h"
#include "comm/agree_on_failure.h"
#include "comm/mpi.h"
#include "composite/codec.h"
#include "composite/compose_images.h"
#include "parallel/arena.h"

namespace delray::c {
namespace {

DelrayComposeOptions options_of(const DelrayComposeOptions* options) {
  DelrayComposeOptions given = DELRAY_COMPOSE_OPTIONS;
  if (options == nullptr) return given;
  if (options->size == 0 || options->size > sizeof(given))
    throw std::invalid_argument("options->size: begin with DELRAY_COMPOSE_OPTIONS");
  std::memcpy(&given, options, options->size);
  return given;
}

template <class Colour>
void compose(comm::Communicator& ranks, const DelrayImage& mine, const DelrayComposeOptions& given,
             DelrayImage* whole) {
  composite::ImageOptions options;
  options.how = mine.depth != nullptr ? composite::Operator::nearest : composite::Operator::over;
  if (given.scheme != nullptr) options.scheme = given.scheme;
  if (given.codec != nullptr) options.codec = given.codec;
  options.interlace = given.interlace != 0;
  options.root = given.root;
  const composite::ImageBuffers<Colour> buffers{
      static_cast<int>(mine.width), static_cast<int>(mine.height),
      static_cast<const Colour*>(mine.colour), mine.depth};
  const parallel::AllowThreads allowed(given.threads);
  parallel::Arena arena(given.threads);
  image::BasicImage<Colour> made = arena.execute(
      [&] { return composite::compose_images(ranks, buffers, given.empty_depth, options); });
  if (ranks.rank() != options.root) return;
  std::memcpy(whole->colour, made.colour.data(), made.pixels() * sizeof(Colour));
  if (whole->depth == nullptr) return;
  for (std::size_t i = 0; i < made.pixels(); ++i) {
    const float depth = made.depth[i];
    whole->depth[i] = depth == image::kEmptyDepth ? given.empty_depth : depth;
  }
}

}  // namespace
}  // namespace delray::c

extern "C" {

DelrayCommunicator delrayNewCommunicator(const void* mpi_communicator) {
  return delray::c::guarded_value([&]() -> DelrayCommunicator {
    delray::c::require(mpi_communicator, "mpi_communicator");
    auto made = std::make_unique<DelrayCommunicator_>();
    made->ranks = delray::comm::make_mpi_communicator(mpi_communicator);
    return made.release();
  });
}

void delrayReleaseCommunicator(DelrayCommunicator communicator) { delete communicator; }

int delrayRank(DelrayCommunicator communicator) {
  return communicator == nullptr ? 0 : communicator->ranks->rank();
}

int delrayRanks(DelrayCommunicator communicator) {
  return communicator == nullptr ? 0 : communicator->ranks->size();
}

DelrayStatus delrayCompose(DelrayCommunicator communicator, const DelrayImage* mine,
                           const DelrayComposeOptions* options, DelrayImage* whole) {
  using namespace delray;
  return c::guarded([&] {
    c::require(communicator, "communicator");
    DelrayComposeOptions given{};
    // Nobody waits for a rank whose arguments are wrong.
    comm::all_or_none(*communicator->ranks, comm::Phase::other, [&] {
      c::require(mine, "mine");
      c::require(mine->colour, "mine->colour");
      given = c::options_of(options);
      if (given.threads < 1) throw std::invalid_argument("options->threads is below 1");
      if (mine->type != DELRAY_UFIXED8_RGBA_SRGB && mine->type != DELRAY_FLOAT32_VEC4) {
        throw std::invalid_argument(
            "mine->type is neither DELRAY_UFIXED8_RGBA_SRGB nor DELRAY_FLOAT32_VEC4");
      }
      if (given.codec != nullptr && composite::find_codec(given.codec) == nullptr)
        throw std::invalid_argument(std::string("there is no codec '") + given.codec + "'");
      if (communicator->ranks->rank() != given.root) return;
      c::require(whole, "whole");
      c::require(whole->colour, "whole->colour");
      if (whole->width != mine->width || whole->height != mine->height || whole->type != mine->type)
        throw std::invalid_argument("whole is of another size or type than mine");
    });
    if (mine->type == DELRAY_UFIXED8_RGBA_SRGB) {
      c::compose<image::Rgba8>(*communicator->ranks, *mine, given, whole);
    } else {
      c::compose<image::RgbaF>(*communicator->ranks, *mine, given, whole);
    }
  });
}

}  // extern "C"
