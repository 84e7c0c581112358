// Builds the levels of nodes from the pages up.
#include "packs/page_tree.h"

#include <algorithm>
#include <limits>

namespace delray::packs {

PageTree::PageTree(std::span<const PageRow> rows, PageRange pages, std::span<const Group> groups)
    : pages_(pages) {
  std::vector<Node> below;
  below.reserve(pages.count);
  for (const PageRow& row : rows.subspan(pages.first, pages.count)) {
    const float made_error = row.made_of == kNoGroup ? 0 : groups[row.made_of].error;
    if (row.simplified_in == kNoGroup) {
      below.push_back({row.box, std::numeric_limits<float>::infinity(), row.box, made_error});
      continue;
    }
    const Group& group = groups[row.simplified_in];
    below.push_back({row.box, group.error, group.bounds, made_error});
  }
  while (below.size() > 1 || levels_.empty()) {
    if (below.empty()) return;
    std::vector<Node> nodes((below.size() + kBranches - 1) / kBranches);
    for (std::size_t i = 0; i < below.size(); ++i) {
      Node& node = nodes[i / kBranches];
      node.box.include(below[i].box);
      node.error = std::max(node.error, below[i].error);
      node.bounds.include(below[i].bounds);
      node.made_error = std::max(node.made_error, below[i].made_error);
    }
    levels_.push_back(std::move(nodes));
    below = levels_.back();
  }
}

}  // namespace delray::packs
