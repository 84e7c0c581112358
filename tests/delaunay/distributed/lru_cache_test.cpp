#include "delaunay/distributed/lru_cache.h"

#include <gtest/gtest.h>

#include <functional>
#include <list>
#include <random>

namespace delray::delaunay {
namespace {

TEST(LruCache, ForgetsWhatWasUsedLeastRecently) {
  LruCache<int, int, std::hash<int>> cache(3);
  for (const int key : {1, 2, 3}) cache.put(key, 10 * key);
  ASSERT_NE(cache.find(1), nullptr);
  cache.put(4, 40);
  EXPECT_EQ(cache.find(2), nullptr);
  for (const int key : {1, 3, 4}) {
    ASSERT_NE(cache.find(key), nullptr) << key;
    EXPECT_EQ(*cache.find(key), 10 * key);
  }
  EXPECT_EQ(cache.size(), 3U);
}

TEST(LruCache, DoesAsAListDoes) {
  std::mt19937_64 random(7);
  LruCache<int, int, std::hash<int>> cache(8);
  std::list<int> recent;
  for (int step = 0; step < 2000; ++step) {
    const int key = static_cast<int>(random() % 20);
    const auto at = std::find(recent.begin(), recent.end(), key);
    ASSERT_EQ(cache.find(key) != nullptr, at != recent.end()) << step;
    if (at == recent.end()) {
      cache.put(key, key);
      if (recent.size() == 8) recent.pop_back();
    } else {
      recent.erase(at);
    }
    recent.push_front(key);
  }
}

}  // namespace
}  // namespace delray::delaunay
