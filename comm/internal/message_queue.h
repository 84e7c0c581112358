// Messages that have come but were not taken yet, found by source, tag, both or neither.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <tuple>
#include <utility>

#include "comm/communicator.h"

namespace delray::comm::internal {

// The messages of one rank in one communicator. Every call costs O(log messages). Payload is what
// stands for the bytes: a Buffer, or one that is still being filled.
template <class Payload>
class MessageQueue {
 public:
  struct Message {
    int source = 0;
    Tag tag = 0;
    double arrival = 0;
    std::uint64_t sequence = 0;
    Payload payload;
  };

  // Messages are ordered by arrival, then by the order of these calls.
  // REQUIRES: messages of one source come in with ascending arrivals.
  Message& push(int source, Tag tag, double arrival, Payload&& payload) {
    auto owned = std::make_unique<Message>(
        Message{source, tag, arrival, next_sequence_++, std::move(payload)});
    Message& message = *owned;
    const Order order{arrival, message.sequence};
    by_source_and_tag_.emplace(std::tuple{source, tag, order}, std::move(owned));
    by_tag_.emplace(std::tuple{tag, order}, &message);
    if (tag < kReservedTags) {
      by_source_.emplace(std::tuple{source, order}, &message);
      all_.emplace(order, &message);
    }
    return message;
  }

  // The first message that matches, or null.
  Message* find(int from_or_any, Tag tag_or_any) const {
    if (from_or_any != kAnyRank && tag_or_any != kAnyTag) {
      const auto i = by_source_and_tag_.lower_bound({from_or_any, tag_or_any, kFirst});
      if (i == by_source_and_tag_.end() || i->second->source != from_or_any ||
          i->second->tag != tag_or_any) {
        return nullptr;
      }
      return i->second.get();
    }
    if (from_or_any != kAnyRank) {
      const auto i = by_source_.lower_bound({from_or_any, kFirst});
      return i == by_source_.end() || i->second->source != from_or_any ? nullptr : i->second;
    }
    if (tag_or_any != kAnyTag) {
      const auto i = by_tag_.lower_bound({tag_or_any, kFirst});
      return i == by_tag_.end() || i->second->tag != tag_or_any ? nullptr : i->second;
    }
    return all_.empty() ? nullptr : all_.begin()->second;
  }

  // REQUIRES: `message` is in the queue.
  Payload take(Message* message) {
    const Order order{message->arrival, message->sequence};
    if (message->tag < kReservedTags) {
      by_source_.erase({message->source, order});
      all_.erase(order);
    }
    by_tag_.erase({message->tag, order});
    const auto i = by_source_and_tag_.find({message->source, message->tag, order});
    Payload payload = std::move(message->payload);
    by_source_and_tag_.erase(i);
    return payload;
  }

  // Some message, collectives' included; null when there is none.
  Message* any() const { return by_tag_.empty() ? nullptr : by_tag_.begin()->second; }

 private:
  using Order = std::pair<double, std::uint64_t>;
  static constexpr Order kFirst{-std::numeric_limits<double>::infinity(), 0};

  std::uint64_t next_sequence_ = 0;
  std::map<std::tuple<int, Tag, Order>, std::unique_ptr<Message>> by_source_and_tag_;
  std::map<std::tuple<Tag, Order>, Message*> by_tag_;
  // Tags of collectives never match kAnyTag, so these two do not hold them.
  std::map<std::tuple<int, Order>, Message*> by_source_;
  std::map<Order, Message*> all_;
};

// Whether a message that came matches what somebody waits for.
inline bool matches(int source, Tag tag, int from_or_any, Tag tag_or_any) {
  return (from_or_any == kAnyRank || from_or_any == source) &&
         (tag_or_any == kAnyTag ? tag < kReservedTags : tag_or_any == tag);
}

}  // namespace delray::comm::internal
