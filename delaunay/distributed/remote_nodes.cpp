// One tag carries all messages of an insertion, so that those of one rank to another stay in order:
// a change arrives before the next request. A rank that waits for an answer serves others, which is
// why nobody waits for ever.
//
// A node may be asked for before the message that brings it has come, as that is another rank's:
// the request waits with it. A waiting request is answered when the node is released: the youngest
// of those that wait gets it, as all others are older and may go on waiting.
#include "delaunay/distributed/remote_nodes.h"

#include <algorithm>
#include <map>
#include <utility>

namespace delray::delaunay {
namespace {

constexpr comm::Tag kTermination = 1, kNodes = 2;

}  // namespace

template <int D>
void Changes<D>::pack(Packer& to) const {
  to.value(row).value(successor).value(successors).value(nodes_at_sender);
  to.list(unlocked).list(killed).list(relinked).list(made);
}

template <int D>
Changes<D> Changes<D>::unpack(Unpacker& from) {
  Changes changes;
  changes.row = from.value<std::uint64_t>();
  changes.successor = from.value<NodeId>();
  changes.successors = from.value<std::uint64_t>();
  changes.nodes_at_sender = from.value<std::uint64_t>();
  changes.unlocked = from.list<NodeId>();
  changes.killed = from.list<NodeId>();
  changes.relinked = from.list<Relink>();
  changes.made = from.list<Node<D>>();
  return changes;
}

template <int D>
RemoteNodes<D>::RemoteNodes(comm::Communicator& communicator, DistributedStatistics& statistics)
    : communicator_(communicator), statistics_(statistics) {
  termination_.emplace(communicator, kTermination);
}

template <int D>
void RemoteNodes<D>::put(const Node<D>& node) {
  Slot& slot = slots_[node.id];
  slot.node = node;
  ++living_;
  const auto early = early_.extract(node.id);
  if (early.empty()) return;
  for (const Request& each : early.mapped()) request(node.id, each);
}

template <int D>
const Node<D>* RemoteNodes<D>::find(const NodeId& id) const {
  const auto at = slots_.find(id);
  return at == slots_.end() ? nullptr : &at->second.node;
}

template <int D>
bool RemoteNodes<D>::is_locked(const NodeId& id) const {
  const auto at = slots_.find(id);
  return at != slots_.end() && at->second.holder >= 0;
}

template <int D>
typename RemoteNodes<D>::Slot& RemoteNodes<D>::slot_of(const NodeId& id) {
  const auto at = slots_.find(id);
  comm::check_message(at != slots_.end());
  return at->second;
}

template <int D>
void RemoteNodes<D>::request(const NodeId& id, const Request& request) {
  const auto at = slots_.find(id);
  if (at == slots_.end()) {
    early_[id].push_back(request);
    return;
  }
  Slot& slot = at->second;
  if (slot.node.is_dead()) {
    grant(slot.node, request.from);
  } else if (slot.holder < 0) {
    slot.holder = request.from;
    slot.priority = request.priority;
    grant(slot.node, request.from);
  } else if (request.priority < slot.priority) {
    slot.waiting.push_back(request);
  } else {
    refuse(request.from);
  }
}

template <int D>
void RemoteNodes<D>::grant(const Node<D>& node, int to) {
  if (to == rank()) {
    answer_ = Answer{true, {node}};
  } else {
    send(to, std::move(message_of(kGranted).value(node)));
  }
}

template <int D>
void RemoteNodes<D>::refuse(int to) {
  if (to == rank()) {
    answer_ = Answer{};
  } else {
    send(to, message_of(kRefused));
  }
}

template <int D>
void RemoteNodes<D>::release(Slot& slot) {
  slot.holder = -1;
  if (slot.waiting.empty()) return;
  if (slot.node.is_dead()) {
    for (const Request& each : std::exchange(slot.waiting, {})) grant(slot.node, each.from);
    return;
  }
  const auto youngest = std::ranges::max_element(slot.waiting, {}, &Request::priority);
  const Request next = *youngest;
  slot.waiting.erase(youngest);
  slot.holder = next.from;
  slot.priority = next.priority;
  grant(slot.node, next.from);
}

template <int D>
const Node<D>* RemoteNodes<D>::lock(const NodeId& id) {
  if (const auto at = held_.find(id); at != held_.end()) return &at->second;
  if (only_here_ && (!is_home_of(id) || is_locked(id))) return nullptr;
  answer_.reset();
  if (is_home_of(id)) {
    request(id, {priority_, rank()});
  } else {
    ++statistics_.requests;
    ++statistics_.waits;
    send(static_cast<int>(id.home), std::move(message_of(kLock).value(id).value(priority_)));
  }
  if (is_home_of(id) && !answer_) ++statistics_.waits;
  const Answer answer = wait_for_answer();
  if (!answer.granted) {
    ++statistics_.refusals;
    return nullptr;
  }
  // A dead node is kept until the end of the insertion as well, but nobody locked it.
  return &held_.insert_or_assign(id, answer.nodes.at(0)).first->second;
}

template <int D>
void RemoteNodes<D>::commit(const Changes<D>& changes, const Listeners& listeners) {
  std::map<int, Changes<D>> by_rank;
  std::vector<int> ranks;
  const auto ranks_of = [&](const Node<D>& node) {
    ranks = {static_cast<int>(node.id.home)};
    if (listeners) listeners(node, ranks);
    std::ranges::sort(ranks);
    ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
    return std::span<const int>(ranks);
  };
  for (const NodeId& id : changes.killed) {
    for (const int to : ranks_of(held(id))) by_rank[to].killed.push_back(id);
  }
  for (const auto& relink : changes.relinked) {
    for (const int to : ranks_of(held(relink.node))) by_rank[to].relinked.push_back(relink);
  }
  for (const Node<D>& node : changes.made) {
    for (const int to : ranks_of(node)) by_rank[to].made.push_back(node);
  }
  std::uint64_t own = living_;
  const auto at = by_rank.find(rank());
  if (at != by_rank.end()) {
    for (const Node<D>& node : at->second.made) own += is_home_of(node.id) ? 1 : 0;
    for (const NodeId& id : at->second.killed) own -= is_home_of(id) ? 1 : 0;
  }
  held_.clear();
  for (auto& [to, each] : by_rank) {
    each.row = changes.row;
    each.successor = changes.successor;
    each.successors = changes.successors;
    each.nodes_at_sender = own;
    if (to == rank()) {
      apply(rank(), each);
    } else {
      Packer message = message_of(kChanges);
      each.pack(message);
      send(to, std::move(message));
    }
  }
}

template <int D>
void RemoteNodes<D>::rollback() {
  std::map<int, Changes<D>> by_rank;
  for (const auto& [id, node] : held_) {
    if (!node.is_dead()) by_rank[static_cast<int>(id.home)].unlocked.push_back(id);
  }
  held_.clear();
  for (auto& [to, each] : by_rank) {
    each.nodes_at_sender = living_;
    if (to == rank()) {
      apply(rank(), each);
    } else {
      Packer message = message_of(kChanges);
      each.pack(message);
      send(to, std::move(message));
    }
  }
}

template <int D>
void RemoteNodes<D>::apply(int source, const Changes<D>& changes) {
  // New ones first: nobody is to see a node whose neighbours or successors have not come.
  for (const Node<D>& node : changes.made) {
    if (is_home_of(node.id)) put(node);
  }
  // A node may have several new neighbours.
  std::vector<NodeId> relinked;
  for (const auto& relink : changes.relinked) {
    if (!is_home_of(relink.node)) continue;
    std::ranges::replace(slot_of(relink.node).node.neighbours, relink.before, relink.after);
    if (std::ranges::find(relinked, relink.node) == relinked.end()) relinked.push_back(relink.node);
  }
  for (const NodeId& id : relinked) release(slot_of(id));
  for (const NodeId& id : changes.killed) {
    if (!is_home_of(id)) continue;
    Slot& slot = slot_of(id);
    slot.node.successor = changes.successor;
    slot.node.successors = changes.successors;
    --living_;
    release(slot);
  }
  for (const NodeId& id : changes.unlocked) release(slot_of(id));
  if (on_changes_) on_changes_(source, changes);
}

template <int D>
std::vector<Node<D>> RemoteNodes<D>::page_of(const NodeId& first, std::uint64_t count) const {
  std::vector<Node<D>> nodes;
  NodeId id = first;
  for (std::uint64_t i = 0; i < count; ++i, ++id.number) {
    const Node<D>* node = find(id);
    comm::check_message(node != nullptr);
    nodes.push_back(*node);
  }
  return nodes;
}

template <int D>
std::vector<Node<D>> RemoteNodes<D>::read(const NodeId& first, std::uint64_t count) {
  if (is_home_of(first)) return page_of(first, count);
  ++statistics_.requests;
  ++statistics_.waits;
  answer_.reset();
  send(static_cast<int>(first.home), std::move(message_of(kRead).value(first).value(count)));
  return wait_for_answer().nodes;
}

template <int D>
void RemoteNodes<D>::send(int to, Packer&& message) {
  termination_->count_sent();
  communicator_.send(to, kNodes, message.buffer());
}

template <int D>
void RemoteNodes<D>::handle(int source, const comm::Buffer& message) {
  Unpacker content(message);
  const auto kind = content.value<std::uint32_t>();
  switch (kind) {
    case kLock: {
      const auto id = content.value<NodeId>();
      request(id, {content.value<Priority>(), source});
      break;
    }
    case kGranted:
      answer_ = Answer{true, {content.value<Node<D>>()}};
      break;
    case kRefused:
      answer_ = Answer{};
      break;
    case kRead: {
      const auto first = content.value<NodeId>();
      const auto page = page_of(first, content.value<std::uint64_t>());
      send(source, std::move(message_of(kPage).list(page)));
      break;
    }
    case kPage:
      answer_ = Answer{true, content.list<Node<D>>()};
      break;
    case kChanges:
      apply(source, Changes<D>::unpack(content));
      break;
    default:
      comm::check_message(kind >= kFirstKind && on_message_ != nullptr);
      on_message_(kind, source, content);
  }
}

template <int D>
bool RemoteNodes<D>::serve(comm::Deadline deadline) {
  const auto envelope = communicator_.probe(comm::kAnyRank, comm::kAnyTag, deadline);
  if (!envelope) return false;
  if (envelope->tag == kTermination) {
    termination_->handle(*envelope);
  } else {
    const comm::Buffer message = communicator_.receive(envelope->source, kNodes);
    termination_->count_received();
    handle(envelope->source, message);
  }
  return true;
}

template <int D>
typename RemoteNodes<D>::Answer RemoteNodes<D>::wait_for_answer() {
  while (!answer_) serve(comm::Deadline::never());
  return *std::exchange(answer_, std::nullopt);
}

template <int D>
bool RemoteNodes<D>::wait_for_work() {
  termination_->idle();
  if (termination_->is_over()) {
    termination_.emplace(communicator_, kTermination);
    return false;
  }
  serve(comm::Deadline::never());
  return true;
}

template struct Changes<2>;
template struct Changes<3>;
template class RemoteNodes<2>;
template class RemoteNodes<3>;

}  // namespace delray::delaunay
