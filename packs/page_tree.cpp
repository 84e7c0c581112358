// Builds the levels of nodes from the pages up.
#include "packs/page_tree.h"

#include <limits>

namespace delray::packs {

PageTree::PageTree(std::span<const PageRow> rows, PageRange pages, std::span<const Group> groups)
    : pages_(pages) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::vector<Node> below;
  below.reserve(pages.count);
  for (const PageRow& row : rows.subspan(pages.first, pages.count)) {
    below.push_back({row.box, row.made_of == kNoGroup ? 0 : groups[row.made_of].error,
                     row.simplified_in == kNoGroup ? kInfinity : groups[row.simplified_in].error});
  }
  while (below.size() > 1 || levels_.empty()) {
    if (below.empty()) return;
    std::vector<Node> nodes((below.size() + kBranches - 1) / kBranches, Node{{}, kInfinity, 0});
    for (std::size_t i = 0; i < below.size(); ++i) {
      Node& node = nodes[i / kBranches];
      node.box.include(below[i].box);
      node.least_made_of = std::min(node.least_made_of, below[i].least_made_of);
      node.most_simplified_in = std::max(node.most_simplified_in, below[i].most_simplified_in);
    }
    levels_.push_back(std::move(nodes));
    below = levels_.back();
  }
}

}  // namespace delray::packs
