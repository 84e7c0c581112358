// A Delaunay triangulation whose points come and go.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <unordered_map>
#include <vector>

#include "delaunay/mesh.h"
#include "delaunay/points.h"
#include "delaunay/triangulation.h"

namespace delray::delaunay {

// Points of the plane. Each inserted point gets the next row number, from 0; rows of removed
// points are not used again. At any moment the simplices are those that triangulate() gives for
// the live points, whatever came and went before.
class DynamicTriangulation {
 public:
  // Returns the row. Expected O(n^(1/3)) for evenly spread points and O(1) for a point near the
  // one before. -0 equals 0.
  //
  // Errors: std::invalid_argument for a coordinate that is not finite, or beyond 2^29 points.
  std::uint32_t insert(const glm::dvec2& point);
  // Inserts a batch, in an order of its own that is fast; returns the row of the first, the others
  // follow. The first two coordinates count. Errors: as above; then nothing is inserted.
  std::uint32_t insert(PointView<double> points);

  // Removes the point of a row. O(d^2) for a vertex of d neighbours, beside the location. Returns
  // false if the row was not live.
  bool remove(std::uint32_t row);

  std::size_t size() const { return live_; }  // live rows
  bool is_live(std::uint32_t row) const {
    return row < site_of_.size() && site_of_[row] != kNoSite;
  }

  // The simplices of the live points; vertices are rows, of equal points the lowest live one.
  // O(simplices).
  Triangulation triangulation() const;

 private:
  static constexpr std::uint32_t kNoSite = 0xffffffffU;

  // Hands out slots of the mesh, first those that removals left.
  struct Access {
    DynamicTriangulation& owner;
    bool acquire(SimplexNumber) const { return true; }
    SimplexNumber create() { return owner.create(); }
  };
  struct Key {
    double x, y;
    bool operator==(const Key&) const = default;
  };
  struct KeyHash {
    std::size_t operator()(const Key& key) const;
  };

  SimplexNumber create();
  void retire(SimplexNumber simplex);
  void reserve(std::size_t simplices);
  std::uint32_t add_row(const glm::dvec2& point);
  void add_site(std::uint32_t site);
  void insert_site(std::uint32_t site);
  void start_mesh(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  SimplexNumber start_near(const glm::dvec2& q);
  void remove_site(std::uint32_t site);
  void flatten();

  // Sites are distinct live places; a site is a vertex of the mesh.
  std::vector<glm::dvec2> positions_;             // per site
  std::vector<std::vector<std::uint32_t>> rows_;  // per site: live rows there, ascending
  std::vector<SimplexNumber> near_;               // per site: a simplex that once had it
  std::vector<std::uint32_t> free_sites_;
  std::vector<std::uint32_t> site_of_;  // per row
  std::unordered_map<Key, std::uint32_t, KeyHash> site_at_;
  std::size_t live_ = 0;

  // While all sites are on one line there is no mesh.
  bool meshed_ = false;
  std::array<std::uint32_t, 2> line_ = {kNoSite, kNoSite};  // two sites on it
  Mesh<2> mesh_;
  SimplexNumber used_ = 0;  // slots from here on are free
  std::vector<SimplexNumber> free_slots_;
  SimplexNumber last_ = 0;  // a live simplex
  std::vector<CornerNumber> suspects_;
  std::uint32_t random_ = 1;
};

}  // namespace delray::delaunay
