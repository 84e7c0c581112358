// Boxes around runs of pages, so that what is out of sight is not looked at page by page.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/box.h"
#include "packs/page.h"

namespace delray::packs {

// A tree over consecutive pages of one level of a mesh: a node of height h has those from i * 8^h
// on, 8^h of them or what is left. Neighbours in a mesh are neighbours in space where the mesh was
// ordered for locality; otherwise the boxes overlap, and only time is lost.
class PageTree {
 public:
  static constexpr std::uint32_t kBranches = 8;

  struct Node {
    geometry::Box3 box;
    // The largest error of the groups that the pages were simplified in, infinity where one was in
    // none, and a box around the bounds of those.
    float error = 0;
    geometry::Box3 bounds;
    float made_error = 0;  // the largest error of the groups that the pages were made of
  };

  // O(pages). Refers to the rows.
  PageTree(std::span<const PageRow> rows, PageRange pages, std::span<const Group> groups);

  // Calls visit(node, pages) for nodes from the root down, whose children follow if it returns
  // true, and page(i) for the pages of the lowest of them; in ascending order of pages.
  template <class Visit, class OfPage>
  void descend(Visit&& visit, OfPage&& page) const {
    if (!levels_.empty()) {
      const auto top = static_cast<std::uint32_t>(levels_.size() - 1);
      for (std::uint32_t i = 0; i < levels_[top].size(); ++i) descend(top, i, visit, page);
    }
  }

 private:
  template <class Visit, class OfPage>
  void descend(std::uint32_t height, std::uint32_t i, Visit&& visit, OfPage&& page) const {
    if (!visit(levels_[height][i])) return;
    const std::uint32_t below =
        height == 0 ? pages_.count : static_cast<std::uint32_t>(levels_[height - 1].size());
    for (std::uint32_t k = i * kBranches; k < std::min(below, (i + 1) * kBranches); ++k) {
      if (height == 0)
        page(pages_.first + k);
      else
        descend(height - 1, k, visit, page);
    }
  }

  PageRange pages_;
  std::vector<std::vector<Node>> levels_;  // the lowest first
};

}  // namespace delray::packs
