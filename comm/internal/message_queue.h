// Messages that have come but were not taken yet, found by source, tag, both or neither.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <unordered_map>
#include <utility>

#include "comm/communicator.h"

namespace delray::comm::internal {

// Whether a message that came matches what somebody waits for.
inline bool matches(int source, Tag tag, int from_or_any, Tag tag_or_any) {
  return (from_or_any == kAnyRank || from_or_any == source) &&
         (tag_or_any == kAnyTag ? tag < kReservedTags : tag_or_any == tag);
}

// The messages of one rank in one communicator. A call costs O(1), or O(log messages) from the
// first time on that somebody asks for any source or any tag. Payload is what stands for the bytes:
// a Buffer, or one that is still being filled.
template <class Payload>
class MessageQueue {
 public:
  struct Message {
    int source = 0;
    Tag tag = 0;
    double arrival = 0;
    std::uint64_t sequence = 0;
    Payload payload;
    Message* next = nullptr;  // of the same source and tag
  };

  MessageQueue() = default;
  ~MessageQueue() {
    while (Message* message = any()) take(message);
  }
  MessageQueue(const MessageQueue&) = delete;
  MessageQueue& operator=(const MessageQueue&) = delete;

  // Messages are ordered by arrival, then by the order of these calls.
  // REQUIRES: messages of one source come in with ascending arrivals.
  Message& push(int source, Tag tag, double arrival, Payload&& payload) {
    auto* const message =
        new Message{source, tag, arrival, next_sequence_++, std::move(payload), nullptr};
    List& list = lists_[key(source, tag)];
    (list.last ? list.last->next : list.first) = message;
    list.last = message;
    for_each_index(*message, [&](Index& index) { index.emplace(order(*message), message); });
    return *message;
  }

  // The first message that matches, or null.
  Message* find(int from_or_any, Tag tag_or_any) {
    if (from_or_any != kAnyRank && tag_or_any != kAnyTag) {
      const auto i = lists_.find(key(from_or_any, tag_or_any));
      return i == lists_.end() ? nullptr : i->second.first;
    }
    const Index& index = index_of({from_or_any, tag_or_any});
    return index.empty() ? nullptr : index.begin()->second;
  }

  // REQUIRES: find or any has returned `message`, and nobody has taken it since.
  Payload take(Message* message) {
    for_each_index(*message, [&](Index& index) { index.erase(order(*message)); });
    const auto i = lists_.find(key(message->source, message->tag));
    i->second.first = message->next;
    if (!message->next) lists_.erase(i);
    const std::unique_ptr<Message> owned(message);
    return std::move(message->payload);
  }

  // Some message, collectives' included; null when there is none.
  Message* any() const { return lists_.empty() ? nullptr : lists_.begin()->second.first; }

 private:
  // First in, first out; never empty.
  struct List {
    Message* first = nullptr;
    Message* last = nullptr;
  };
  using Order = std::pair<double, std::uint64_t>;
  using Index = std::map<Order, Message*>;
  using Pattern = std::pair<int, Tag>;

  static std::uint64_t key(int source, Tag tag) {
    return static_cast<std::uint64_t>(source) << 32 | static_cast<std::uint32_t>(tag);
  }
  static Order order(const Message& message) { return {message.arrival, message.sequence}; }

  // The messages that a pattern with kAnyRank or kAnyTag matches; kept up from the first call on.
  Index& index_of(Pattern pattern) {
    const auto [i, is_new] = indexes_.try_emplace(pattern);
    if (is_new) {
      for (const auto& [unused, list] : lists_) {
        for (Message* message = list.first; message; message = message->next) {
          if (matches(message->source, message->tag, pattern.first, pattern.second)) {
            i->second.emplace(order(*message), message);
          }
        }
      }
    }
    return i->second;
  }

  template <class F>
  void for_each_index(const Message& message, F&& f) {
    if (indexes_.empty()) return;
    const auto visit = [&](Pattern pattern) {
      if (const auto i = indexes_.find(pattern); i != indexes_.end()) f(i->second);
    };
    visit({kAnyRank, message.tag});
    // Tags of collectives never match kAnyTag.
    if (message.tag >= kReservedTags) return;
    visit({message.source, kAnyTag});
    visit({kAnyRank, kAnyTag});
  }

  std::uint64_t next_sequence_ = 0;
  std::unordered_map<std::uint64_t, List> lists_;  // by source and tag
  std::map<Pattern, Index> indexes_;
};

}  // namespace delray::comm::internal
