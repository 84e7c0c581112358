// The distributed methods of the table in distributed.cpp, one source each.
#pragma once

#include <memory>
#include <span>

#include "comm/communicator.h"
#include "delaunay/distributed.h"

namespace delray::delaunay {

// Tiles of tiles.h, one for each rank.
DistributedTriangulation triangulate_by_tiles(comm::Communicator& communicator,
                                              std::span<const RowPoint> points,
                                              const DistributedOptions& options);
// Collective: how many of the rank's simplices have corners in the areas of several ranks.
std::uint64_t count_shared_rows(comm::Communicator& communicator, std::span<const RowPoint> points,
                                const DistributedOptions& options, const TiledTriangulation& part);

// Kohout (2004), chapter 8.
DistributedTriangulation virtual_shared_memory(comm::Communicator& communicator,
                                               std::span<const RowPoint> points,
                                               const DistributedOptions& options);

std::unique_ptr<OnlineTriangulation> virtual_shared_memory_on_line(
    comm::Communicator& communicator, const DistributedOptions& options);
DistributedTriangulation interface_workers(comm::Communicator& communicator,
                                           std::span<const RowPoint> points,
                                           const DistributedOptions& options);
std::unique_ptr<OnlineTriangulation> interface_workers_on_line(comm::Communicator& communicator,
                                                               const DistributedOptions& options);
DistributedTriangulation administrators(comm::Communicator& communicator,
                                        std::span<const RowPoint> points,
                                        const DistributedOptions& options);
std::unique_ptr<OnlineTriangulation> administrators_on_line(comm::Communicator& communicator,
                                                            const DistributedOptions& options);

// Kohout (2004), 5.3: methods that others had published. In the plane only.
DistributedTriangulation lee_1997(comm::Communicator& communicator,
                                  std::span<const RowPoint> points,
                                  const DistributedOptions& options);
DistributedTriangulation chen(comm::Communicator& communicator, std::span<const RowPoint> points,
                              const DistributedOptions& options);
DistributedTriangulation hardwick(comm::Communicator& communicator,
                                  std::span<const RowPoint> points,
                                  const DistributedOptions& options);
DistributedTriangulation lee_2001(comm::Communicator& communicator,
                                  std::span<const RowPoint> points,
                                  const DistributedOptions& options);

}  // namespace delray::delaunay
