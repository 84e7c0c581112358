// Sends groups of primitives to the ranks that need them, and remembers who has which (Mueller
// 1995: only what comes into a region is sent).
//
// The owner of a group lists the ranks that hold it and the frame in which each needed it last. A
// rank that is not listed is sent the group; one that no longer needs it is told so, and one that
// has not for kFramesKept frames to forget it. A message holds what to forget, what not to draw for
// now and what to draw again, then what is new. O(groups x holders) a frame, messages for changes
// only.
//
// Degenerate: ranks that do not remember the same frames forget all and begin anew.
#include "raster/distribute/group_traffic.h"

#include <algorithm>
#include <cstring>

#include "comm/collectives.h"

namespace delray::raster {
namespace {

// A message: the counts of four lists, three of first primitives and one of first primitives with
// transforms, the lists, then the groups that are new.
struct Lists {
  std::span<const std::uint64_t> forgotten, parked, resumed, moved;  // as words of 8 bytes

  std::size_t bytes() const {
    return (kLists + forgotten.size() + parked.size() + resumed.size() + moved.size()) *
           sizeof(std::uint64_t);
  }
  static constexpr std::size_t kLists = 4;
};

// `write_pieces(to)` writes so many bytes.
template <class F>
comm::Buffer join(const Lists& lists, std::size_t pieces_bytes, F&& write_pieces) {
  comm::Buffer message(lists.bytes() + pieces_bytes);
  auto* to = reinterpret_cast<std::uint64_t*>(message.data());
  const auto all = {lists.forgotten, lists.parked, lists.resumed, lists.moved};
  for (const auto& list : all) *to++ = list.size();
  for (const auto& list : all) to = std::copy(list.begin(), list.end(), to);
  if (pieces_bytes > 0) write_pieces(reinterpret_cast<std::byte*>(to));
  return message;
}

Lists lists_in(const comm::Buffer& message) {
  const auto* const counts = reinterpret_cast<const std::uint64_t*>(message.data());
  const std::uint64_t* const first = counts + Lists::kLists;
  return {{first, counts[0]},
          {first + counts[0], counts[1]},
          {first + counts[0] + counts[1], counts[2]},
          {first + counts[0] + counts[1] + counts[2], counts[3]}};
}

std::span<const std::byte> pieces_in(const comm::Buffer& message) {
  return message.as<std::byte>().subspan(lists_in(message).bytes());
}

}  // namespace

void GroupTraffic::moved(const scenes::Movement& movement) {
  moved_instances_.insert(moved_instances_.end(), movement.instances.begin(),
                          movement.instances.end());
  bent_meshes_.insert(bent_meshes_.end(), movement.meshes.begin(), movement.meshes.end());
}

// Sorts groups by what has become of them: those that bent are nobody's any more. Ranks that look
// groups up in the scene have posed that themselves.
void GroupTraffic::note_moved(const RankContext& rank, std::span<const Piece> groups) {
  static_assert(sizeof(MovedGroup) % sizeof(std::uint64_t) == 0);
  const scenes::Scene& scene = rank.prepared.scene;
  std::vector<std::uint8_t> moved(scene.instances.size(), 0), bent(scene.meshes.size(), 0);
  for (const std::uint32_t i : moved_instances_) moved[i] = 1;
  for (const std::uint32_t m : bent_meshes_) bent[m] = 1;
  moved_instances_.clear();
  bent_meshes_.clear();
  const std::span<const std::uint64_t> first = rank.prepared.first_primitives;
  std::size_t instance = 0;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    while (first[instance + 1] <= groups[i].primitive) ++instance;
    if (bent[scene.instances[instance].mesh] != 0) {
      outdated_[i] = std::move(holders_[i]);
      holders_[i].clear();
    } else if (moved[instance] != 0) {
      for (const Holder& holder : holders_[i])
        outgoing_[holder.rank].moved.push_back({groups[i].primitive, *groups[i].transform});
    }
  }
}

void GroupTraffic::begin_frame(RankContext& rank, std::span<const Piece> groups) {
  const bool as_before = rank.number() == rank_ && rank.ranks() == ranks_ &&
                         rank.options.travel == travel_ && groups.size() == holders_.size();
  if (!agreement_.holds(rank.communicator, as_before)) {
    holders_.assign(groups.size(), {});
    held_.clear();
    rank_ = rank.number();
    ranks_ = rank.ranks();
    travel_ = rank.options.travel;
  }
  ++frame_;
  outgoing_.clear();
  outdated_.clear();
  staying_.clear();
  const bool anything = !moved_instances_.empty() || !bent_meshes_.empty();
  if (anything && travel_ == Travel::geometry) note_moved(rank, groups);
  moved_instances_.clear();
  bent_meshes_.clear();
}

void GroupTraffic::need(const RankContext& rank, std::span<const Piece> groups, std::size_t group,
                        int owner) {
  if (owner == rank.number()) {
    staying_.push_back(groups[group]);
    return;
  }
  std::vector<Holder>& holders = holders_[group];
  const auto holder = std::find_if(holders.begin(), holders.end(),
                                   [&](const Holder& h) { return h.rank == owner; });
  if (holder != holders.end()) {
    if (holder->last_needed + 1 < frame_)
      outgoing_[owner].resumed.push_back(groups[group].primitive);
    holder->last_needed = frame_;
    return;
  }
  holders.push_back({owner, frame_});
  outgoing_[owner].pieces.push_back(groups[group]);
  // What it holds of the same group from before is replaced.
  if (const auto old = outdated_.find(group); old != outdated_.end())
    std::erase_if(old->second, [&](const Holder& h) { return h.rank == owner; });
}

void GroupTraffic::park_or_forget(std::span<const Piece> groups) {
  for (const auto& [group, holders] : outdated_)
    for (const Holder& holder : holders)
      outgoing_[holder.rank].forgotten.push_back(groups[group].primitive);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    std::erase_if(holders_[i], [&](const Holder& holder) {
      if (holder.last_needed + 1 == frame_)
        outgoing_[holder.rank].parked.push_back(groups[i].primitive);
      if (holder.last_needed + kFramesKept > frame_) return false;
      outgoing_[holder.rank].forgotten.push_back(groups[i].primitive);
      return true;
    });
  }
}

void GroupTraffic::keep(RankContext& rank, const comm::Buffer& message) {
  const Lists lists = lists_in(message);
  for (const std::uint64_t primitive : lists.parked) held_.at(primitive).needed = false;
  for (const std::uint64_t primitive : lists.resumed) held_.at(primitive).needed = true;
  for (const std::uint64_t primitive : lists.forgotten) held_.erase(primitive);
  MovedGroup moved;
  for (auto words = lists.moved; !words.empty(); words = words.subspan(sizeof moved / 8)) {
    std::memcpy(&moved, words.data(), sizeof moved);
    const auto held = held_.find(moved.primitive);
    if (held != held_.end()) held->second.arrival.mesh->transform = moved.transform;
  }
  std::vector<Arrival> arrivals;
  if (travel_ == Travel::numbers) {
    unpack_numbers(pieces_in(message), rank.prepared.scene, rank.prepared.first_primitives,
                   arrivals);
  } else {
    unpack_geometry(pieces_in(message), arrivals);
  }
  for (Arrival& arrival : arrivals) {
    const std::uint64_t primitive = arrival.piece.primitive;
    held_[primitive] = {std::move(arrival)};
  }
}

comm::Buffer GroupTraffic::pack(RankContext& rank, const Outgoing& outgoing) const {
  const Lists lists{outgoing.forgotten,
                    outgoing.parked,
                    outgoing.resumed,
                    {reinterpret_cast<const std::uint64_t*>(outgoing.moved.data()),
                     outgoing.moved.size() * sizeof(MovedGroup) / sizeof(std::uint64_t)}};
  if (travel_ == Travel::numbers) {
    const std::vector<std::uint64_t> numbers = pack_numbers(outgoing.pieces);
    const std::size_t bytes = numbers.size() * sizeof(numbers[0]);
    return join(lists, bytes, [&](std::byte* to) { std::memcpy(to, numbers.data(), bytes); });
  }
  const GeometryPacker packer(outgoing.pieces, rank.prepared.clusters);
  return join(lists, packer.bytes(), [&](std::byte* to) { packer.write(to); });
}

std::vector<Piece> GroupTraffic::finish_frame(RankContext& rank, std::span<const Piece> groups) {
  park_or_forget(groups);
  std::vector<comm::Parcel> parcels;
  for (auto& [to, outgoing] : outgoing_) {
    for (const Piece& piece : outgoing.pieces) rank.triangles_travelled += piece.count;
    parcels.push_back({to, pack(rank, outgoing)});
  }
  std::sort(parcels.begin(), parcels.end(),
            [](const comm::Parcel& a, const comm::Parcel& b) { return a.rank < b.rank; });
  for (const comm::Parcel& parcel : comm::exchange(rank.communicator, std::move(parcels)))
    keep(rank, parcel.message);
  std::vector<Piece> pieces = std::move(staying_);
  for (const auto& [primitive, held] : held_)
    if (held.needed) pieces.push_back(held.arrival.piece);
  return pieces;
}

}  // namespace delray::raster
