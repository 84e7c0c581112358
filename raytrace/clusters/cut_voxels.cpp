// A triangle is tried in the voxels that its box overlaps and clipped by each one's planes; what is
// left decides. A ray that has met all voxels up to its nearest hit has met every triangle that
// could be nearer: the hit on it lies in a voxel that has the triangle. Which triangle is nearest
// does not depend on how often it is met.
//
// Degenerate: a scene without extent is one voxel.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <utility>

#include "comm/bad_message.h"
#include "comm/collectives.h"
#include "raytrace/clusters/cluster_items.h"
#include "raytrace/clusters/voxels.h"

namespace delray::raytrace {
namespace {

// Filled voxels for each rank, and triangles of one, about, at least.
constexpr double kVoxelsPerRank = 64, kFewestTriangles = 64;
constexpr int kMostCells = 128;  // along a side

// Of a voxel's side and of the largest coordinate: beyond what floats lose.
constexpr double kVoxelSlack = 0x1p-20;

constexpr float kFarthest = 1e18F;  // no triangle is hit beyond it

std::uint64_t voxel_hash(std::uint64_t x) {  // the finaliser of SplitMix64
  x += 0x9E3779B97F4A7C15U;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9U;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBU;
  return x ^ (x >> 31);
}

struct Polygon {
  std::array<glm::dvec3, 10> corners;  // a plane adds one at most
  std::size_t count = 0;
  void add(const glm::dvec3& corner) { corners[count++] = corner; }
};

// The part where sign * (coordinate - at) <= 0.
Polygon clipped(const Polygon& polygon, int axis, double sign, double at) {
  Polygon result;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const glm::dvec3 &a = polygon.corners[i], &b = polygon.corners[(i + 1) % polygon.count];
    const double da = sign * (a[axis] - at), db = sign * (b[axis] - at);
    if (da <= 0) result.add(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) result.add(a + (b - a) * (da / (da - db)));
  }
  return result;
}

bool is_clipped(const GeometryInstance& instance, const glm::vec3 (&corners)[3]) {
  if (instance.see_through || instance.layered || !instance.mesh->has_triangles()) return false;
  for (const glm::vec3& corner : corners)
    for (int k = 0; k < 3; ++k)
      if (!(std::abs(corner[k]) <= kFarthest)) return false;
  const glm::vec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  return normal != glm::vec3(0.0F);
}

// Visits the numbers of the voxels that a triangle goes into.
template <class Visit>
void for_voxels(const GeometryInstance& instance, const ClusterItem& item, const VoxelGrid& grid,
                Visit&& visit) {
  const glm::uvec3 numbers = instance.mesh->triangles[item.triangle];
  const glm::vec3 corners[3] = {instance.positions[numbers.x], instance.positions[numbers.y],
                                instance.positions[numbers.z]};
  if (!is_clipped(instance, corners)) return visit(grid.number(grid.cell_of(item.centre)));
  const glm::vec3 low = glm::min(corners[0], glm::min(corners[1], corners[2]));
  const glm::vec3 high = glm::max(corners[0], glm::max(corners[1], corners[2]));
  // A voxel more on each side, whose box reaches a little over its border.
  const glm::ivec3 first = glm::max(grid.cell_of(low) - 1, glm::ivec3(0));
  const glm::ivec3 last = glm::min(grid.cell_of(high) + 1, grid.cells - 1);
  bool any = false;
  for (int z = first.z; z <= last.z; ++z) {
    for (int y = first.y; y <= last.y; ++y) {
      for (int x = first.x; x <= last.x; ++x) {
        const std::uint32_t voxel = grid.number({x, y, z});
        if (!reaches_into(corners, grid.box(voxel))) continue;
        any = true;
        visit(voxel);
      }
    }
  }
  if (!any) visit(grid.number(grid.cell_of(item.centre)));
}

// Adds the pieces of another part of the same voxel.
void join(ClusterData& to, ClusterData&& from) {
  const auto first = static_cast<std::uint32_t>(to.pieces.size());
  for (GeometryInstance& instance : from.instances) {
    instance.mesh_number += first;
    to.instances.push_back(std::move(instance));
  }
  for (Piece& piece : from.pieces) to.pieces.push_back(std::move(piece));
}

}  // namespace

glm::ivec3 VoxelGrid::cell_of(const glm::vec3& point) const {
  glm::ivec3 cell(0);
  for (int k = 0; k < 3; ++k) {
    const double at = std::floor((static_cast<double>(point[k]) - low[k]) / side);
    if (at > 0) cell[k] = static_cast<int>(std::min(at, static_cast<double>(cells[k] - 1)));
  }
  return cell;
}

std::uint32_t VoxelGrid::number(const glm::ivec3& cell) const {
  return static_cast<std::uint32_t>((cell.z * cells.y + cell.y) * cells.x + cell.x);
}

geometry::Box3 VoxelGrid::box(std::uint32_t number) const {
  const auto columns = static_cast<std::uint32_t>(cells.x);
  const auto rows = static_cast<std::uint32_t>(cells.y);
  const glm::dvec3 cell(number % columns, number / columns % rows, number / columns / rows);
  const glm::dvec3 from = low + cell * side, to = from + side;
  geometry::Box3 box;
  for (int k = 0; k < 3; ++k) {
    const double slack = kVoxelSlack * (side + std::max(std::abs(from[k]), std::abs(to[k])));
    box.low[k] = static_cast<float>(from[k] - slack);
    box.high[k] = static_cast<float>(to[k] + slack);
  }
  return box;
}

VoxelGrid voxel_grid(const geometry::Box3& bounds, std::uint64_t triangles, int ranks) {
  VoxelGrid grid;
  if (bounds.empty()) return grid;
  const glm::dvec3 low(bounds.low), size = glm::dvec3(bounds.high) - low;
  const double longest = std::max({size.x, size.y, size.z});
  if (!(longest > 0) || !std::isfinite(longest)) return grid;
  // Surfaces of a scene fill some k^2 of k^3 voxels.
  const double filled = std::min(kVoxelsPerRank * static_cast<double>(ranks),
                                 static_cast<double>(triangles) / kFewestTriangles);
  const int along = std::clamp(static_cast<int>(std::sqrt(filled)), 1, kMostCells);
  grid.low = low;
  grid.side = longest / along;
  for (int k = 0; k < 3; ++k)
    grid.cells[k] = std::clamp(static_cast<int>(std::ceil(size[k] / grid.side)), 1, along);
  return grid;
}

bool reaches_into(const glm::vec3 (&corners)[3], const geometry::Box3& box) {
  Polygon polygon;
  for (const glm::vec3& corner : corners) polygon.add(glm::dvec3(corner));
  for (int axis = 0; axis < 3 && polygon.count > 0; ++axis) {
    polygon = clipped(polygon, axis, -1.0, box.low[axis]);
    polygon = clipped(polygon, axis, 1.0, box.high[axis]);
  }
  return polygon.count > 0;
}

std::vector<Voxel> cut_voxels(std::span<const GeometryInstance> instances, std::uint64_t begin,
                              std::uint64_t end, const VoxelGrid& grid, std::uint32_t most,
                              std::uint32_t first_triangle) {
  const PlacedMeshes placed = placed_meshes(instances);
  std::vector<Voxel> result;
  std::map<std::uint32_t, std::vector<ClusterItem>> voxels;
  for_cluster_items(
      instances, placed, begin, end, [&](std::span<ClusterItem> items, bool instanced) {
        if (!instanced) {
          for (const ClusterItem& item : items)
            for_voxels(instances[item.instance], item, grid,
                       [&](std::uint32_t voxel) { voxels[voxel].push_back(item); });
          return;
        }
        for (std::size_t first = 0; first < items.size(); first += most) {
          const std::span<ClusterItem> part =
              items.subspan(first, std::min<std::size_t>(most, items.size() - first));
          // A number of its own, whichever rank has it.
          const std::uint64_t key = voxel_hash(std::uint64_t{part.front().instance} << 32 |
                                               (first_triangle + part.front().triangle));
          const std::uint32_t room = ~std::uint32_t{0} - grid.count();
          const std::uint32_t number = grid.count() + static_cast<std::uint32_t>(key % room);
          result.push_back({number, cluster_of_items(part, instances, placed, first_triangle)});
        }
      });
  for (auto& [number, items] : voxels)
    result.push_back({number, cluster_of_items(items, instances, placed, first_triangle)});
  return result;
}

std::vector<ClusterData> deal_voxels(comm::Communicator& communicator, std::vector<Voxel>&& mine,
                                     const VoxelGrid& grid, std::uint64_t seed) {
  std::vector<comm::Parcel> parcels;
  std::map<std::uint32_t, ClusterData> own;
  for (Voxel& voxel : mine) {
    const std::uint64_t key = voxel_hash(seed ^ voxel_hash(voxel.number));
    const int owner = static_cast<int>(key % static_cast<std::uint64_t>(communicator.size()));
    if (owner == communicator.rank()) {
      join(own[voxel.number], std::move(voxel.data));
      continue;
    }
    const comm::Buffer packed = pack(voxel.data);
    comm::Buffer message(sizeof(voxel.number) + packed.size());
    std::memcpy(message.data(), &voxel.number, sizeof(voxel.number));
    std::memcpy(message.data() + sizeof(voxel.number), packed.data(), packed.size());
    parcels.push_back({owner, std::move(message)});
    voxel.data = {};
  }
  for (comm::Parcel& parcel : comm::exchange(communicator, std::move(parcels))) {
    const std::span<const std::byte> bytes(parcel.message.data(), parcel.message.size());
    std::uint32_t number = 0;
    comm::check_message(bytes.size() >= sizeof(number));
    std::memcpy(&number, bytes.data(), sizeof(number));
    join(own[number], unpack_cluster(bytes.subspan(sizeof(number))));
    parcel.message = {};
  }
  std::vector<ClusterData> result;
  for (auto& [number, data] : own) {
    if (number < grid.count()) data.clip = grid.box(number);
    result.push_back(std::move(data));
  }
  return result;
}

}  // namespace delray::raytrace
