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
  for (const Request& each : early.mapped()) {
    Answer answer;
    request(node.id, each, answer);
    send_answer(each.from, answer);
  }
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
void RemoteNodes<D>::request(const NodeId& id, const Request& request, Answer& answer) {
  const auto at = slots_.find(id);
  if (at == slots_.end()) {
    early_[id].push_back(request);
    return;
  }
  Slot& slot = at->second;
  if (slot.node.is_dead()) {
    answer.granted.push_back(slot.node);
  } else if (slot.holder < 0) {
    slot.holder = request.from;
    slot.priority = request.priority;
    answer.granted.push_back(slot.node);
  } else if (request.priority < slot.priority) {
    slot.waiting.push_back(request);
  } else {
    ++answer.refusals;
  }
}

template <int D>
void RemoteNodes<D>::send_answer(int to, const Answer& answer) {
  if (answer.refusals == 0 && answer.granted.empty()) return;
  if (to == rank()) {
    take(answer);
  } else {
    send(to, std::move(message_of(kLocked).value(answer.refusals).list(answer.granted)));
  }
}

template <int D>
void RemoteNodes<D>::take(const Answer& answer) {
  const std::uint64_t answered = answer.refusals + answer.granted.size();
  comm::check_message(answered <= unanswered_);
  unanswered_ -= answered;
  refused_ += answer.refusals;
  // A dead node is kept until the end of the insertion as well, but nobody locked it.
  for (const Node<D>& node : answer.granted) held_.insert_or_assign(node.id, node);
}

template <int D>
void RemoteNodes<D>::release(Slot& slot) {
  slot.holder = -1;
  if (slot.waiting.empty()) return;
  if (slot.node.is_dead()) {
    for (const Request& each : std::exchange(slot.waiting, {}))
      send_answer(each.from, {0, {slot.node}});
    return;
  }
  const auto youngest = std::ranges::max_element(slot.waiting, {}, &Request::priority);
  const Request next = *youngest;
  slot.waiting.erase(youngest);
  slot.holder = next.from;
  slot.priority = next.priority;
  send_answer(next.from, {0, {slot.node}});
}

template <int D>
bool RemoteNodes<D>::lock(std::span<const NodeId> ids) {
  std::vector<NodeId> own;
  std::map<int, std::vector<NodeId>> elsewhere;  // by home
  unanswered_ = refused_ = 0;
  for (const NodeId& id : ids) {
    if (held_.contains(id)) continue;
    if (only_here_ && (!is_home_of(id) || is_locked(id))) return false;
    (is_home_of(id) ? own : elsewhere[static_cast<int>(id.home)]).push_back(id);
    ++unanswered_;
  }
  for (const auto& [home, asked] : elsewhere) {
    ++statistics_.requests;
    send(home, std::move(message_of(kLock).value(priority_).list(asked)));
  }
  Answer answer;
  for (const NodeId& id : own) request(id, {priority_, rank()}, answer);
  take(answer);
  if (unanswered_ > 0) ++statistics_.waits;
  while (unanswered_ > 0) serve(comm::Deadline::never());
  statistics_.refusals += refused_;
  return refused_ == 0;
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
  page_.reset();
  send(static_cast<int>(first.home), std::move(message_of(kRead).value(first).value(count)));
  while (!page_) serve(comm::Deadline::never());
  return *std::exchange(page_, std::nullopt);
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
      const auto priority = content.value<Priority>();
      Answer answer;
      for (const NodeId& id : content.list<NodeId>()) request(id, {priority, source}, answer);
      send_answer(source, answer);
      break;
    }
    case kLocked: {
      const auto refusals = content.value<std::uint64_t>();
      take({refusals, content.list<Node<D>>()});
      break;
    }
    case kRead: {
      const auto first = content.value<NodeId>();
      const auto page = page_of(first, content.value<std::uint64_t>());
      send(source, std::move(message_of(kPage).list(page)));
      break;
    }
    case kPage:
      page_ = content.list<Node<D>>();
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
