// 2-3 swap (Yu, Wang and Ma 2008): binary swap for any number n of ranks, by a tree of groups.
//
// A group consists of two or three smaller ones, and all leaves are at depth floor(log2 n). The
// members of a group of s hold an s-th of the image each. When groups join, pieces shrink and
// change hands in the order in which they lie, so that little moves; pixels from the own group
// replace, those from others merge. A rank finds out who owns what in O(n) steps, as groups of one
// size look alike.
//
// Degenerate: n = 1 has no round; a power of two has groups of two alone.
#include <algorithm>
#include <bit>
#include <map>
#include <utility>
#include <vector>

#include "composite/schemes/exchange.h"
#include "composite/schemes/schemes.h"

namespace delray::composite::internal {
namespace {

// Ranks first <= i < first + count, over `height` levels of joining two or three groups.
struct Subtree {
  int first = 0, count = 1, height = 0;

  // In rank order. As equal as can be, and two unless leaves would come to lie at other depths.
  std::vector<Subtree> children() const {
    int most = 1;  // ranks of a child
    for (int i = 1; i < height; ++i) most *= 3;
    const int parts = (count + 1) / 2 <= most ? 2 : 3;
    std::vector<Subtree> result;
    for (int i = 0; i < parts; ++i) {
      const int begin = count * i / parts, end = count * (i + 1) / parts;
      result.push_back({first + begin, end - begin, height - 1});
    }
    return result;
  }
};

// owners[i] is the rank that holds piece i of the image, of as many as there are ranks.
using Owners = std::vector<int>;

PixelRange piece(PixelRange all, const Owners& owners, std::size_t i, int samples) {
  return piece_of(all, static_cast<int>(i), static_cast<int>(owners.size()), samples);
}

PixelRange piece_of_rank(PixelRange all, const Owners& owners, int rank, int samples) {
  const auto at = std::find(owners.begin(), owners.end(), rank);
  return piece(all, owners, static_cast<std::size_t>(at - owners.begin()), samples);
}

// Pieces go to ranks in the order of those that they hold already, so that little moves.
Owners join(const std::vector<Owners>& children, PixelRange all, int samples) {
  std::vector<std::pair<std::uint64_t, int>> order;
  for (const Owners& owners : children) {
    for (std::size_t i = 0; i < owners.size(); ++i) {
      order.emplace_back(piece(all, owners, i, samples).begin, owners[i]);
    }
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  Owners result;
  for (const auto& [begin, rank] : order) result.push_back(rank);
  return result;
}

// Subtrees of one size and height look alike but for the number of their first rank, and there are
// few sizes: a rank knows who owns what in O(ranks) steps, not in that many on every level.
class Plan {
 public:
  Plan(PixelRange all, int samples) : all_(all), samples_(samples) {}

  Owners owners_of(const Subtree& tree) {
    Owners result = alike(tree);
    for (int& rank : result) rank += tree.first;
    return result;
  }

 private:
  // As if its first rank were 0.
  const Owners& alike(const Subtree& tree) {
    const auto [at, is_new] = known_.try_emplace({tree.count, tree.height}, Owners{0});
    if (!is_new || tree.height == 0) return at->second;
    std::vector<Owners> children;
    for (const Subtree& child : Subtree{0, tree.count, tree.height}.children())
      children.push_back(owners_of(child));
    return at->second = join(children, all_, samples_);
  }

  PixelRange all_;
  int samples_;
  std::map<std::pair<int, int>, Owners> known_;
};

// Pieces change hands: this rank is of child `mine`.
void regroup(comm::Communicator& communicator, Layer& layer, const std::vector<Owners>& children,
             int mine, const Owners& joined, PixelRange all, int samples) {
  const int me = communicator.rank();
  const PixelRange before =
      piece_of_rank(all, children[static_cast<std::size_t>(mine)], me, samples);
  const PixelRange after = piece_of_rank(all, joined, me, samples);
  for (std::size_t i = 0; i < joined.size(); ++i) {
    if (joined[i] == me) continue;
    send(communicator, layer, overlap(before, piece(all, joined, i, samples)), joined[i], samples);
  }
  const auto for_each_sender = [&](int child, auto&& f) {
    const Owners& owners = children[static_cast<std::size_t>(child)];
    for (std::size_t i = 0; i < owners.size(); ++i) {
      const PixelRange range = overlap(after, piece(all, owners, i, samples));
      if (owners[i] != me && range.size() > 0) f(owners[i], range);
    }
  };
  // Parts of the new piece that others of the own group held are theirs alone so far.
  for_each_sender(mine, [&](int from, PixelRange range) {
    for_each_message(range, samples, [&](PixelRange message) {
      layer.replace(message, communicator.receive(from, kTagCompose));
    });
  });
  for_each_outwards(mine, static_cast<int>(children.size()), [&](int child) {
    for_each_sender(child, [&](int from, PixelRange range) {
      merge(communicator, layer, range, from, samples);
    });
  });
}

void compose(comm::Communicator& communicator, Layer& layer, const Subtree& tree, Plan& plan,
             PixelRange all, int samples) {
  if (tree.height == 0) return;
  const int rank = communicator.rank();
  std::vector<Owners> children;
  int mine = 0;
  for (const Subtree& child : tree.children()) {
    if (child.first <= rank && rank < child.first + child.count) {
      mine = static_cast<int>(children.size());
      compose(communicator, layer, child, plan, all, samples);
    }
    children.push_back(plan.owners_of(child));
  }
  communicator.mark(comm::Phase::compose, tree.height - 1);
  regroup(communicator, layer, children, mine, plan.owners_of(tree), all, samples);
}

}  // namespace

OwnedPixels two_three_swap(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                           const ComposeOptions& options) {
  const PixelRange all{0, layer->pixels()};
  const int size = communicator.size();
  const int height = std::bit_width(static_cast<unsigned>(size)) - 1;
  const Subtree tree{0, size, height};
  Plan plan(all, options.samples_per_pixel);
  compose(communicator, *layer, tree, plan, all, options.samples_per_pixel);
  const PixelRange mine =
      piece_of_rank(all, plan.owners_of(tree), communicator.rank(), options.samples_per_pixel);
  return part_of(mine, std::move(layer));
}

}  // namespace delray::composite::internal
