// A pack as the rasterizer keeps it from frame to frame, on one rank.
#pragma once

#include <memory>
#include <vector>

#include "packs/pack_reader.h"
#include "packs/page_cache.h"
#include "packs/page_tree.h"
#include "raster/pipeline/mesh_clusters.h"
#include "raster/render.h"

namespace delray::raster {

// A page as it is drawn: a mesh whose clusters are known.
class RasterPage final : public packs::CachedPage {
 public:
  RasterPage();
  // Another page into the same memory. Returns for how many seconds the disk was waited for. Throws
  // FileError.
  double read(const packs::PackReader& pack, std::uint32_t number);

  std::uint64_t bytes() const override { return bytes_; }
  const scenes::Mesh& mesh() const { return page_.mesh; }
  const MeshClusters& clusters() const { return clusters_; }

 private:
  packs::Page page_;  // but for what clusters_ have
  MeshClusters clusters_;
  std::uint64_t bytes_ = 0;
};

class PackedScene {
 public:
  // Refers to the pack.
  PackedScene(const packs::PackReader& source, const PackMemory& memory);

  const packs::PackReader& pack;
  std::vector<std::vector<packs::PageTree>> trees;  // by mesh and level
  packs::PageCache cache;                           // of RasterPages
  const bool one_frame;                             // that anybody will draw
};

}  // namespace delray::raster
