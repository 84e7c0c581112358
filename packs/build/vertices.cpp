// Attributes are copied one by one; the order is that of the finest level's points.
#include "packs/build/vertices.h"

#include "geometry/box.h"
#include "scenes/point_order.h"

namespace delray::packs::internal {
namespace {

template <class T>
void copy_value(const std::vector<T>& from, std::size_t i, std::vector<T>& to) {
  if (!from.empty()) to.push_back(from[i]);
}

}  // namespace

void copy_vertex(const scenes::Mesh& from, std::size_t i, scenes::Mesh& to) {
  copy_value(from.positions, i, to.positions);
  copy_value(from.normals, i, to.normals);
  copy_value(from.uvs, i, to.uvs);
  copy_value(from.uvs2, i, to.uvs2);
  copy_value(from.tangents, i, to.tangents);
  copy_value(from.colours, i, to.colours);
}

std::vector<std::uint32_t> order_along_curve(std::span<const glm::vec3> places) {
  geometry::Box3 box;
  for (const glm::vec3& p : places) box.include(p);
  std::vector<std::uint32_t> order;
  order.reserve(places.size());
  for (const auto& [place, point] : scenes::order_points(places, scenes::PointOrder(box)))
    order.push_back(point);
  return order;
}

}  // namespace delray::packs::internal
