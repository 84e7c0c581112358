// Messages that have come but were not taken yet, found by source, tag, both or neither.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "comm/communicator.h"

namespace delray::comm::internal {

// Whether a message that came matches what somebody waits for.
inline bool matches(int source, Tag tag, int from_or_any, Tag tag_or_any) {
  return (from_or_any == kAnyRank || from_or_any == source) &&
         (tag_or_any == kAnyTag ? tag < kReservedTags : tag_or_any == tag);
}

// Objects of one type, created and destroyed one by one; memory comes in blocks, each as large as
// all before together up to a limit, and is kept until none is left. Objects stay where they are.
template <class T>
class ObjectPool {
 public:
  ObjectPool() = default;
  ObjectPool(const ObjectPool&) = delete;
  ObjectPool& operator=(const ObjectPool&) = delete;
  // REQUIRES: all objects are destroyed.

  template <class... Arguments>
  T* create(Arguments&&... arguments) {
    if (free_ == nullptr) grow();
    Place* const place = free_;
    free_ = place->next;
    ++count_;
    return new (place->object) T{std::forward<Arguments>(arguments)...};
  }
  void destroy(T* object) {
    object->~T();
    auto* const place = reinterpret_cast<Place*>(object);
    place->next = free_;
    free_ = place;
    if (--count_ == 0 && blocks_.size() > 1) {
      blocks_.clear();
      free_ = nullptr;
      size_ = 0;
    }
  }
  std::size_t count() const { return count_; }

 private:
  union Place {
    Place* next;
    alignas(T) std::byte object[sizeof(T)];
  };

  void grow() {
    constexpr std::size_t kFirst = 4, kMost = 512;
    const std::size_t size = std::clamp(size_, kFirst, kMost);
    Place* const block = blocks_.emplace_back(new Place[size]).get();
    for (std::size_t i = 0; i < size; ++i) block[i].next = i + 1 < size ? &block[i + 1] : nullptr;
    free_ = block;
    size_ += size;
  }

  std::vector<std::unique_ptr<Place[]>> blocks_;
  std::size_t size_ = 0, count_ = 0;  // places, and objects in them
  Place* free_ = nullptr;
};

// The messages of one rank in one communicator. A call costs O(1), or O(log messages) from the
// first time on that somebody asks for any source or any tag. Thousands of queues with thousands of
// messages each may be there at a time: a message costs no allocation of its own, and is looked up
// in a table of 16 bytes a place. Payload is what stands for the bytes: a Buffer, or one that is
// still being filled.
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
    Message* last = nullptr;  // of these, where this is the first
  };

  MessageQueue() = default;
  ~MessageQueue() { take_all(); }
  MessageQueue(const MessageQueue&) = delete;
  MessageQueue& operator=(const MessageQueue&) = delete;

  // Messages are ordered by arrival, then by the order of these calls.
  // REQUIRES: messages of one source come in with ascending arrivals.
  Message& push(int source, Tag tag, double arrival, Payload&& payload) {
    Message* const message =
        messages_.create(source, tag, arrival, next_sequence_++, std::move(payload));
    message->last = message;
    if (2 * (lists_ + 1) > places_.size()) enlarge();
    Place& place = places_[place_of(key(source, tag))];
    if (place.first == nullptr) {
      place = {key(source, tag), message};
      ++lists_;
    } else {
      place.first->last->next = message;
      place.first->last = message;
    }
    for_each_index(*message, [&](Index& index) { index.emplace(order(*message), message); });
    return *message;
  }

  // The first message that matches, or null.
  Message* find(int from_or_any, Tag tag_or_any) {
    if (from_or_any != kAnyRank && tag_or_any != kAnyTag) {
      return places_.empty() ? nullptr : places_[place_of(key(from_or_any, tag_or_any))].first;
    }
    const Index& index = index_of({from_or_any, tag_or_any});
    return index.empty() ? nullptr : index.begin()->second;
  }

  // REQUIRES: find has returned `message`, and nobody has taken it since.
  Payload take(Message* message) {
    for_each_index(*message, [&](Index& index) { index.erase(order(*message)); });
    const std::size_t place = place_of(key(message->source, message->tag));
    if (message->next) {
      message->next->last = message->last;
      places_[place].first = message->next;
    } else {
      vacate(place);
    }
    Payload payload = std::move(message->payload);
    messages_.destroy(message);
    return payload;
  }

  // All that are left, collectives' included, in any order but that of a source and tag.
  std::vector<Payload> take_all() {
    std::vector<Payload> all;
    all.reserve(messages_.count());
    for (const Place& place : places_) {
      for (Message* message = place.first; message;) {
        Message* const next = message->next;
        all.push_back(std::move(message->payload));
        messages_.destroy(message);
        message = next;
      }
    }
    places_.clear();
    lists_ = 0;
    for (auto& [unused, index] : indexes_) index.clear();
    return all;
  }

 private:
  // Of a table with linear probing: the messages of a source and tag, first in, first out.
  struct Place {
    std::uint64_t key = 0;
    Message* first = nullptr;  // null: nobody's
  };
  using Order = std::pair<double, std::uint64_t>;
  using Index = std::map<Order, Message*>;
  using Pattern = std::pair<int, Tag>;

  static std::uint64_t key(int source, Tag tag) {
    return static_cast<std::uint64_t>(source) << 32 | static_cast<std::uint32_t>(tag);
  }
  static Order order(const Message& message) { return {message.arrival, message.sequence}; }

  // Where the search for a key begins. (Knuth's multiplicative hashing.)
  std::size_t home_of(std::uint64_t key) const {
    return static_cast<std::size_t>((key ^ key >> 32) * 0x9E3779B97F4A7C15U >> 32) &
           (places_.size() - 1);
  }
  // Where it is, or would be. REQUIRES: there is a place that is nobody's.
  std::size_t place_of(std::uint64_t key) const {
    std::size_t place = home_of(key);
    while (places_[place].first != nullptr && places_[place].key != key) {
      place = (place + 1) & (places_.size() - 1);
    }
    return place;
  }
  void enlarge() {
    constexpr std::size_t kFewest = 8;
    std::vector<Place> before(std::max(kFewest, 2 * places_.size()));
    before.swap(places_);
    for (const Place& place : before) {
      if (place.first != nullptr) places_[place_of(place.key)] = place;
    }
  }
  // Those behind that were pushed away from home move up. (Knuth, 6.4, algorithm R.)
  void vacate(std::size_t place) {
    --lists_;
    const std::size_t mask = places_.size() - 1;
    for (std::size_t next = (place + 1) & mask; places_[next].first != nullptr;
         next = (next + 1) & mask) {
      const std::size_t home = home_of(places_[next].key);
      if (((next - home) & mask) < ((next - place) & mask)) continue;
      places_[place] = places_[next];
      place = next;
    }
    places_[place].first = nullptr;
    constexpr std::size_t kSoonThereAgain = 64;
    if (lists_ == 0 && places_.size() > kSoonThereAgain) places_ = {};
  }

  // The messages that a pattern with kAnyRank or kAnyTag matches; kept up from the first call on.
  Index& index_of(Pattern pattern) {
    const auto [i, is_new] = indexes_.try_emplace(pattern);
    if (is_new) {
      for (const Place& place : places_) {
        for (Message* message = place.first; message; message = message->next) {
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
  ObjectPool<Message> messages_;
  std::vector<Place> places_;  // a power of two, at most half of them somebody's
  std::size_t lists_ = 0;
  std::map<Pattern, Index> indexes_;
};

}  // namespace delray::comm::internal
