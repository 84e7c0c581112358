// A cache that forgets what was used least recently.
#pragma once

#include <cstddef>
#include <list>
#include <unordered_map>
#include <utility>

namespace delray::delaunay {

template <class Key, class Value, class Hash>
class LruCache {
 public:
  // REQUIRES: capacity >= 1, in entries.
  explicit LruCache(std::size_t capacity) : capacity_(capacity) {}

  // Null if the key is not there; valid until the next put().
  Value* find(const Key& key) {
    const auto at = places_.find(key);
    if (at == places_.end()) return nullptr;
    entries_.splice(entries_.begin(), entries_, at->second);
    return &at->second->second;
  }
  // REQUIRES: the key is not there.
  Value& put(const Key& key, Value value) {
    if (entries_.size() == capacity_) {
      places_.erase(entries_.back().first);
      entries_.pop_back();
    }
    entries_.emplace_front(key, std::move(value));
    places_[key] = entries_.begin();
    return entries_.front().second;
  }
  std::size_t size() const { return entries_.size(); }

 private:
  using Entries = std::list<std::pair<Key, Value>>;
  std::size_t capacity_;
  Entries entries_;  // most recently used first
  std::unordered_map<Key, typename Entries::iterator, Hash> places_;
};

}  // namespace delray::delaunay
