// The distinct points of a dynamic triangulation, and the rows that are equal to each.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <unordered_map>
#include <vector>

namespace delray::delaunay::internal {

// A site is a distinct point with its live rows. Numbers of sites are used again after their last
// row has gone; row numbers are not.
template <int D>
class DistinctPoints {
 public:
  using Point = glm::vec<D, double, glm::defaultp>;

  struct Added {
    std::uint32_t site;
    bool is_new;
  };
  // Gives the next row to a point. REQUIRES: no coordinate is -0.
  Added add(const Point& point) {
    const auto row = static_cast<std::uint32_t>(site_of_.size());
    const auto [entry, is_new] = site_at_.try_emplace(point, 0);
    std::uint32_t& site = entry->second;
    if (is_new && free_.empty()) {
      site = static_cast<std::uint32_t>(positions_.size());
      positions_.push_back(point);
      rows_.emplace_back();
    } else if (is_new) {
      site = free_.back();
      free_.pop_back();
      positions_[site] = point;
    }
    rows_[site].push_back(row);
    site_of_.push_back(site);
    ++live_;
    return {site, is_new};
  }
  // Whether its site has no row left; the position stays until another site takes the number.
  // REQUIRES: the row is live.
  bool remove(std::uint32_t row) {
    const std::uint32_t site = site_of_[row];
    rows_[site].erase(std::ranges::find(rows_[site], row));
    site_of_[row] = kNone;
    --live_;
    if (!rows_[site].empty()) return false;
    site_at_.erase(positions_[site]);
    free_.push_back(site);
    return true;
  }

  std::size_t rows() const { return site_of_.size(); }  // ever given
  std::size_t live_rows() const { return live_; }
  std::size_t distinct() const { return site_at_.size(); }
  bool is_live(std::uint32_t row) const { return row < site_of_.size() && site_of_[row] != kNone; }
  std::uint32_t site_of(std::uint32_t row) const { return site_of_[row]; }

  std::size_t size() const { return positions_.size(); }  // sites, used or not
  bool is_used(std::uint32_t site) const { return !rows_[site].empty(); }
  std::uint32_t lowest_row(std::uint32_t site) const { return rows_[site].front(); }
  std::span<const Point> positions() const { return positions_; }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffU;

  struct Hash {
    std::size_t operator()(const Point& point) const {
      std::uint64_t hash = 0;
      for (int k = 0; k < D; ++k) {
        hash = (hash ^ (hash >> 32) ^ std::bit_cast<std::uint64_t>(point[k])) * 0x9e3779b97f4a7c15;
      }
      return hash ^ (hash >> 32);
    }
  };

  std::vector<Point> positions_;                  // per site
  std::vector<std::vector<std::uint32_t>> rows_;  // per site: live rows there, ascending
  std::vector<std::uint32_t> site_of_;            // per row
  std::vector<std::uint32_t> free_;               // sites
  std::unordered_map<Point, std::uint32_t, Hash> site_at_;
  std::size_t live_ = 0;
};

}  // namespace delray::delaunay::internal
