// Rays of a wavefront that wait to be traced, with the state of their paths, in a message.
//
// Samples of whole blocks of 4 x 4 pixels move, each with its sum so far and all of its rays, in
// the groups and lanes that they had: on the other rank they are added in the same order, and
// packets of camera rays stay what they are.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "comm/bad_message.h"
#include "raytrace/integrators/enqueue.h"
#include "raytrace/scene/ray_batch.h"

namespace delray::raytrace {

// Appends values to a message.
class RayWriter {
 public:
  template <class T>
  void value(const T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* const from = reinterpret_cast<const std::byte*>(&v);
    bytes_.insert(bytes_.end(), from, from + sizeof(T));
  }
  // The lanes of `mask`.
  template <class T>
  void lanes(T* field) {
    for (shading::LaneMask rest = mask; rest != 0; rest &= rest - 1)
      value(field[std::countr_zero(rest)]);
  }

  std::span<const std::byte> bytes() const { return bytes_; }
  shading::LaneMask mask = 0;

 private:
  std::vector<std::byte> bytes_;
};

// Reads them in the same order. Throws comm::BadMessage where the message ends before.
class RayReader {
 public:
  explicit RayReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class T>
  void value(T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    comm::check_message(bytes_.size() >= sizeof(T));
    std::memcpy(&v, bytes_.data(), sizeof(T));
    bytes_ = bytes_.subspan(sizeof(T));
  }
  template <class T>
  T next() {
    T v;
    value(v);
    return v;
  }
  // The lanes of `mask`; others become 0, as Embree looks at rays that take no part as well.
  template <class T>
  void lanes(T* field) {
    std::fill_n(field, kPacketRays, T{});
    for (shading::LaneMask rest = mask; rest != 0; rest &= rest - 1)
      value(field[std::countr_zero(rest)]);
  }

  bool at_end() const { return bytes_.empty(); }
  shading::LaneMask mask = 0;

 private:
  std::span<const std::byte> bytes_;
};

template <class Visitor>
void visit(RayGroup& group, Visitor& to) {
  RayPacket& packet = group.packet;
  to.value(group.coherent);
  to.value(group.misses);
  for (float* const field :
       {packet.origin_x, packet.origin_y, packet.origin_z, packet.near, packet.direction_x,
        packet.direction_y, packet.direction_z, packet.far, group.view.x.lane, group.view.y.lane,
        group.view.z.lane, group.width.lane, group.spread.lane})
    to.lanes(field);
}
template <class Visitor>
void visit(ShadowGroup& group, Visitor& to) {
  ShadowPacket& packet = group.packet;
  to.value(group.coherent);
  to.value(group.through_glass);
  for (float* const field :
       {packet.origin_x, packet.origin_y, packet.origin_z, packet.near, packet.direction_x,
        packet.direction_y, packet.direction_z, packet.far})
    to.lanes(field);
}

// Functions over groups and the state beside them, element g of group g, which has
// pixel_of(lane), 16 * block + lane in it, and visit(visitor).

template <class Group, class State>
void count_rays(const Groups<Group>& groups, const Groups<State>& states,
                std::span<std::uint32_t> by_block) {
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (shading::LaneMask rest = active_lanes(groups[g].active); rest != 0; rest &= rest - 1)
      ++by_block[states[g].pixel_of(std::countr_zero(rest)) / kPacketRays];
  }
}

// Moves the rays of blocks b with moved[b] != 0; calls each(state, lane) for them.
template <class Group, class State, class Each>
void write_rays(Groups<Group>& groups, Groups<State>& states, std::span<const std::uint8_t> moved,
                RayWriter& to, Each&& each) {
  for (std::size_t g = 0; g < groups.size(); ++g) {
    to.mask = 0;
    for (shading::LaneMask rest = active_lanes(groups[g].active); rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      if (moved[states[g].pixel_of(i) / kPacketRays] == 0) continue;
      to.mask |= 1U << i;
      groups[g].active.ray[i] = 0;
      each(states[g], i);
    }
    if (to.mask == 0) continue;
    to.value(to.mask);
    visit(groups[g], to);
    states[g].visit(to);
  }
  to.value(shading::LaneMask{0});
}

// REQUIRES: no group is there yet.
template <class Group, class State>
void read_rays(RayReader& from, Groups<Group>& groups, Groups<State>& states) {
  for (from.value(from.mask); from.mask != 0; from.value(from.mask)) {
    Group& group = groups.add();
    clear_rays(group);
    for (int i = 0; i < kPacketRays; ++i) group.active.ray[i] = (from.mask >> i & 1) != 0 ? -1 : 0;
    visit(group, from);
    states.add().visit(from);
  }
}

}  // namespace delray::raytrace
