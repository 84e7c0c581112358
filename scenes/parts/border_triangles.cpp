// Every position has a rank that keeps its account, by a hash: ranks tell it the positions of their
// vertices, and are told which other ranks have been there. To these go the triangles around.
//
// Degenerate: a position that k ranks have is told in k * (k - 1) answers. 0 and -0 are one
// coordinate.
#include "scenes/parts/border_triangles.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>
#include <tuple>

#include "comm/collectives.h"
#include "scenes/geometry/noise.h"

namespace delray::scenes::internal {
namespace {

struct Visit {
  glm::vec3 position;  // without -0
  std::uint32_t rank = 0;
  std::uint32_t index = 0;  // in the rank's message

  auto key() const { return std::tie(position.x, position.y, position.z); }
};

// A position that was also on another rank.
struct Shared {
  std::uint32_t index = 0, rank = 0;
};

// Vertex `vertex` is where a vertex of `rank` is.
struct Neighbour {
  std::uint32_t vertex = 0, rank = 0;
  auto operator<=>(const Neighbour&) const = default;
};

int keeper_of(const glm::vec3& p, int ranks) {
  std::uint64_t hash = 0;
  for (int k = 0; k < 3; ++k) hash = scatter(hash ^ std::bit_cast<std::uint32_t>(p[k]));
  return static_cast<int>(hash % static_cast<std::uint64_t>(ranks));
}

// Which ranks have a vertex in the same place, by vertex. Collective.
std::vector<Neighbour> neighbours(comm::Communicator& communicator, const Mesh& mesh) {
  const auto ranks = static_cast<std::size_t>(communicator.size());
  std::vector<std::vector<std::uint32_t>> vertices(ranks);  // of each message
  std::vector<std::vector<glm::vec3>> positions(ranks);
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    const glm::vec3 p = mesh.positions[v] + glm::vec3(0.0F);
    const auto keeper = static_cast<std::size_t>(keeper_of(p, communicator.size()));
    vertices[keeper].push_back(v);
    positions[keeper].push_back(p);
  }
  std::vector<comm::Parcel> parcels;
  for (std::size_t k = 0; k < ranks; ++k) {
    if (positions[k].empty()) continue;
    parcels.push_back(
        {static_cast<int>(k), comm::Buffer::of(std::span<const glm::vec3>(positions[k]))});
    std::vector<glm::vec3>().swap(positions[k]);
  }
  std::vector<Visit> visits;
  for (comm::Parcel& parcel : comm::exchange(communicator, std::move(parcels))) {
    std::uint32_t index = 0;
    for (const glm::vec3& p : parcel.message.as<glm::vec3>())
      visits.push_back({p, static_cast<std::uint32_t>(parcel.rank), index++});
    parcel.message = {};
  }
  std::ranges::sort(visits, [](const Visit& a, const Visit& b) { return a.key() < b.key(); });
  std::map<int, std::vector<Shared>> answers;
  for (std::size_t i = 0; i < visits.size();) {
    std::size_t end = i + 1;
    while (end < visits.size() && visits[end].key() == visits[i].key()) ++end;
    std::vector<std::uint32_t> there;
    for (std::size_t k = i; k < end; ++k) there.push_back(visits[k].rank);
    std::ranges::sort(there);
    there.erase(std::unique(there.begin(), there.end()), there.end());
    for (std::size_t k = i; k < end && there.size() > 1; ++k) {
      std::vector<Shared>& answer = answers[static_cast<int>(visits[k].rank)];
      for (const std::uint32_t rank : there)
        if (rank != visits[k].rank) answer.push_back({visits[k].index, rank});
    }
    i = end;
  }
  std::vector<Visit>().swap(visits);
  for (auto& [rank, answer] : answers)
    parcels.push_back({rank, comm::Buffer::of(std::span<const Shared>(answer))});
  std::vector<Neighbour> result;
  for (const comm::Parcel& parcel : comm::exchange(communicator, std::move(parcels))) {
    const std::vector<std::uint32_t>& sent = vertices[static_cast<std::size_t>(parcel.rank)];
    for (const Shared& shared : parcel.message.as<Shared>())
      result.push_back({sent.at(shared.index), shared.rank});
  }
  std::ranges::sort(result);
  return result;
}

}  // namespace

std::vector<BorderTriangle> border_triangles(comm::Communicator& communicator, const Mesh& mesh,
                                             std::uint64_t first) {
  const std::vector<Neighbour> all = neighbours(communicator, mesh);
  std::vector<std::uint8_t> at_border(mesh.positions.size(), 0);
  for (const Neighbour& neighbour : all) at_border[neighbour.vertex] = 1;
  std::map<int, std::vector<BorderTriangle>> going;
  std::vector<std::uint32_t> to;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const glm::uvec3& v = mesh.triangles[t];
    if ((at_border[v.x] | at_border[v.y] | at_border[v.z]) == 0) continue;
    to.clear();
    for (int k = 0; k < 3; ++k) {
      for (auto n = std::ranges::lower_bound(all, Neighbour{v[k], 0});
           n != all.end() && n->vertex == v[k]; ++n)
        to.push_back(n->rank);
    }
    std::ranges::sort(to);
    to.erase(std::unique(to.begin(), to.end()), to.end());
    for (const std::uint32_t rank : to) {
      going[static_cast<int>(rank)].push_back(
          {first + t, {mesh.positions[v.x], mesh.positions[v.y], mesh.positions[v.z]}});
    }
  }
  std::vector<comm::Parcel> parcels;
  for (auto& [rank, triangles] : going)
    parcels.push_back({rank, comm::Buffer::of(std::span<const BorderTriangle>(triangles))});
  going.clear();
  std::vector<BorderTriangle> result;
  // By sender, whose runs ascend.
  for (const comm::Parcel& parcel : comm::exchange(communicator, std::move(parcels))) {
    const auto triangles = parcel.message.as<BorderTriangle>();
    result.insert(result.end(), triangles.begin(), triangles.end());
  }
  return result;
}

}  // namespace delray::scenes::internal
