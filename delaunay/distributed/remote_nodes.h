// Nodes of a triangulation that ranks hold in parts, and the locks by which ranks change them.
//
// Every node has a home, the rank that says whether it lives, who its neighbours are, and who may
// change it. An insertion locks what it needs, wherever that is, and in the end either changes all
// of it (commit) or leaves all as it was (rollback).
//
// Deadlocks are avoided by priorities, "wait-die" (Rosenkrantz, Stearns and Lewis 1978): who wants
// a node of a younger insertion waits, who wants that of an older one is refused and rolls back. An
// insertion keeps its priority until it succeeds, so it ends up the oldest.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "comm/communicator.h"
#include "comm/termination.h"
#include "delaunay/distributed.h"
#include "delaunay/distributed/node.h"
#include "delaunay/distributed/packing.h"

namespace delray::delaunay {

// Of an insertion; the lower one is older.
struct Priority {
  std::uint64_t time = 0;
  std::uint64_t rank = 0;
  auto operator<=>(const Priority&) const = default;
};

// What an insertion changes, as ranks are told.
template <int D>
struct Changes {
  struct Relink {
    NodeId node;
    NodeId before, after;  // the neighbour
  };
  std::uint64_t row = kInfiniteRow;   // of the point that was inserted
  NodeId successor;                   // of the nodes that die
  std::uint64_t successors = 0;       // likewise
  std::uint64_t nodes_at_sender = 0;  // that live and are at home there
  std::vector<NodeId> unlocked, killed;
  std::vector<Relink> relinked;
  std::vector<Node<D>> made;

  void pack(Packer& to) const;
  static Changes unpack(Unpacker& from);
};

template <int D>
class RemoteNodes {
 public:
  // Messages that are not of this class. Kinds are numbered from kFirstKind on.
  static constexpr std::uint32_t kFirstKind = 16;
  using OnMessage = std::function<void(std::uint32_t kind, int source, Unpacker& content)>;
  // Called for changes that other ranks and this one have made, after nodes that are at home here
  // have changed.
  using OnChanges = std::function<void(int source, const Changes<D>&)>;

  RemoteNodes(comm::Communicator& communicator, DistributedStatistics& statistics);

  void on_message(OnMessage call) { on_message_ = std::move(call); }
  void on_changes(OnChanges call) { on_changes_ = std::move(call); }

  int rank() const { return communicator_.rank(); }
  bool is_home_of(const NodeId& id) const { return id.home == static_cast<std::uint32_t>(rank()); }

  // Takes a node in that has its home here.
  void put(const Node<D>& node);
  // Null where the node has not arrived yet. REQUIRES: it has its home here.
  const Node<D>* find(const NodeId& id) const;
  bool is_locked(const NodeId& id) const;
  std::uint64_t living() const { return living_; }
  template <class F>
  void for_each_living(const F& f) const {
    for (const auto& [id, slot] : slots_) {
      if (!slot.node.is_dead()) f(slot.node);
    }
  }

  // The number of the first of so many new nodes of this rank's.
  std::uint64_t new_numbers(std::uint64_t count) {
    return next_number_ += count, next_number_ - count;
  }

  // Begins an insertion: all locks until commit() or rollback() are its. With `only_here` it is
  // refused what is at home elsewhere, and what it would have to wait for.
  void begin(const Priority& priority, bool only_here = false) {
    priority_ = priority;
    only_here_ = only_here;
  }
  // Asks the homes of the nodes for all of them at once, and waits once, for the last answer: each
  // node is then held() as its home has it; locked, unless it is dead. False where waiting for one
  // of them might end in a deadlock: then rollback() is due. Serves other ranks while it waits.
  bool lock(std::span<const NodeId> ids);
  // One node, or null.
  const Node<D>* lock(const NodeId& id) { return lock({&id, 1}) ? &held(id) : nullptr; }
  // Tells the home of each node, and `listeners` of it, what has changed; unlocks all. The caller
  // says whose nodes these are; nodes of `changes.unlocked` are filled in.
  using Listeners = std::function<void(const Node<D>&, std::vector<int>&)>;
  void commit(const Changes<D>& changes, const Listeners& listeners);
  void rollback();
  // A node that this insertion has locked. REQUIRES: it has.
  const Node<D>& held(const NodeId& id) const { return held_.at(id); }

  // So many nodes of one home and maker, from `first` on, in their present state, not locked.
  std::vector<Node<D>> read(const NodeId& first, std::uint64_t count);

  // Sends a message of one of the caller's kinds to another rank, or to this one.
  void send(int to, Packer&& message);
  static Packer message_of(std::uint32_t kind) { return std::move(Packer().value(kind)); }

  // Deals with one message; false if none comes before the deadline.
  bool serve(comm::Deadline deadline);
  // For a rank that has nothing to do: waits for a message and deals with it. False once no rank
  // has anything to do; then all may go on after a collective of all.
  bool wait_for_work();

 private:
  enum Kind : std::uint32_t { kLock, kLocked, kRead, kPage, kChanges };
  struct Request {
    Priority priority;
    int from = 0;
  };
  struct Slot {
    Node<D> node;
    int holder = -1;
    Priority priority;  // of the holder
    std::vector<Request> waiting;
  };
  // To requests for locks, as many as there are nodes and refusals.
  struct Answer {
    std::uint64_t refusals = 0;
    std::vector<Node<D>> granted;
  };

  // Adds to the answer, or has the request wait.
  void request(const NodeId& id, const Request& request, Answer& answer);
  void send_answer(int to, const Answer& answer);
  void take(const Answer& answer);
  void release(Slot& slot);
  Slot& slot_of(const NodeId& id);
  void apply(int source, const Changes<D>& changes);
  std::vector<Node<D>> page_of(const NodeId& first, std::uint64_t count) const;
  void handle(int source, const comm::Buffer& message);

  comm::Communicator& communicator_;
  DistributedStatistics& statistics_;
  std::optional<comm::Termination> termination_;
  OnMessage on_message_;
  OnChanges on_changes_;
  std::unordered_map<NodeId, Slot, NodeIdHash> slots_;
  std::unordered_map<NodeId, std::vector<Request>, NodeIdHash> early_;  // before the node has come
  std::unordered_map<NodeId, Node<D>, NodeIdHash> held_;
  Priority priority_;
  bool only_here_ = false;
  std::uint64_t unanswered_ = 0, refused_ = 0;  // of the requests of a call of lock()
  std::optional<std::vector<Node<D>>> page_;    // that was read
  std::uint64_t next_number_ = D + 2;           // after those of the first nodes
  std::uint64_t living_ = 0;
};

extern template class RemoteNodes<2>;
extern template class RemoteNodes<3>;

}  // namespace delray::delaunay
