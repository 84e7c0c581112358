// Groups of primitives that change rank, over the frames of an animation.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "raster/distribute/agreement.h"
#include "raster/distribute/rank_context.h"
#include "raster/distribute/travel.h"
#include "raster/pipeline/draws.h"
#include "scenes/pose.h"

namespace delray::raster {

// What travels in a frame is what a rank needs and was not sent before (Mueller 1995: only
// primitives that come into a region are sent). A rank keeps what it was sent until it has not
// needed it for kFramesKept frames, and draws what it needs; it is told by the sender, which is the
// one that knows, where that changes. Frames are calls: there is none where nothing has changed.
class GroupTraffic {
 public:
  static constexpr std::uint64_t kFramesKept = 8;

  // Group i of this rank's own is needed by the ranks needed_by(i, ranks) writes. Returns what this
  // rank is to draw: its own groups that it needs, and those that others sent it, now or before.
  // Collective. The pieces stay valid until the next call.
  //
  // Of groups that moved() was told of since the last call, those that only have another transform
  // are sent that, and those that bent are sent again.
  //
  // If not all remember the same frames all begin anew. REQUIRES: for the same number of groups,
  // they are the same from frame to frame.
  template <class F>
  std::vector<Piece> exchange(RankContext& rank, std::span<const Piece> groups, F&& needed_by) {
    begin_frame(rank, groups);
    for (std::size_t i = 0; i < groups.size(); ++i) {
      needed_by(i, owners_);
      for (const int owner : owners_) need(rank, groups, i, owner);
    }
    return finish_frame(rank, groups);
  }

  // Some of the scene's instances have other transforms, and meshes other vertices. To be told on
  // all ranks.
  void moved(const scenes::Movement& movement);

 private:
  // A rank other than this that has a group.
  struct Holder {
    int rank;
    std::uint64_t last_needed;
  };
  // A group with a new transform: its first primitive.
  struct MovedGroup {
    std::uint64_t primitive;
    glm::mat4x3 transform;
  };
  // A group that came from another rank.
  struct Held {
    Arrival arrival;
    bool needed = true;  // in this frame
  };
  // The groups that one rank is sent in a frame.
  struct Outgoing {
    std::vector<Piece> pieces;
    // First primitives of groups that it holds: no longer, for now not needed, needed again.
    std::vector<std::uint64_t> forgotten, parked, resumed;
    std::vector<MovedGroup> moved;  // that it holds
  };

  void begin_frame(RankContext& rank, std::span<const Piece> groups);
  void note_moved(const RankContext& rank, std::span<const Piece> groups);
  void need(const RankContext& rank, std::span<const Piece> groups, std::size_t group, int owner);
  std::vector<Piece> finish_frame(RankContext& rank, std::span<const Piece> groups);
  void park_or_forget(std::span<const Piece> groups);
  comm::Buffer pack(RankContext& rank, const Outgoing& outgoing) const;
  void keep(RankContext& rank, const comm::Buffer& message);

  Agreement agreement_;
  std::uint64_t frame_ = 0;
  int rank_ = -1, ranks_ = 0;
  Travel travel_ = Travel::geometry;
  std::vector<std::vector<Holder>> holders_;      // by group
  std::unordered_map<std::uint64_t, Held> held_;  // by first primitive
  std::unordered_map<int, Outgoing> outgoing_;    // by rank
  std::vector<Piece> staying_;
  // What moved since the last frame: by instance and mesh of the scene, empty where nothing did;
  // and then by group, those who hold what it was before it bent.
  std::vector<std::uint32_t> moved_instances_, bent_meshes_;
  std::unordered_map<std::size_t, std::vector<Holder>> outdated_;
  std::vector<int> owners_;
};

}  // namespace delray::raster
