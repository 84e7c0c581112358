// IceT (Sandia), the compositing library of ParaView and VisIt, over MPI.
#pragma once

#include <string>
#include <vector>

#include "image/image.h"

namespace delray::bench {

enum class IcetKind { nearest, ordered };

// A context over all processes of MPI_COMM_WORLD for images of one size: Rgba8, and depth for
// `nearest`. One at a time. REQUIRES: MPI is initialised.
class Icet {
 public:
  Icet(int width, int height, IcetKind kind);
  ~Icet();
  Icet(const Icet&) = delete;
  Icet& operator=(const Icet&) = delete;

  // "bswap", "bswap-folding", "radixk", "tree", "direct" ...: those that can do the kind.
  static std::vector<std::string> strategies(IcetKind kind);
  void choose(const std::string& strategy);

  // Collective: composites what every process gives, and collects the picture on rank 0, whose
  // colours it returns there, `width` x `height` of them; nullptr elsewhere. They stay until the
  // next call. Depths are from 0 to 1, 1 where nothing is.
  const image::Rgba8* compose(const image::Rgba8* colour, const float* depth);

 private:
  struct Context;
  Context* context_;
};

}  // namespace delray::bench
