// The message queue against a plain list, under random calls.
#include "comm/transport/message_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace delray::comm::internal {
namespace {

struct Expected {
  int source;
  Tag tag;
  double arrival;
  int value;
};

// The position of the message that comes first of those that match; the number of all without any.
std::size_t first_of(const std::vector<Expected>& all, int from, Tag tag) {
  std::size_t first = all.size();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!matches(all[i].source, all[i].tag, from, tag)) continue;
    if (first == all.size() || all[i].arrival < all[first].arrival) first = i;
  }
  return first;
}

// Few sources and many, few tags, those of collectives, wildcards early, late and never.
TEST(MessageQueue, GivesWhatAListWouldUnderRandomPushesAndTakes) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const unsigned sources = seed % 3 == 0 ? 3 : 1 + random() % 700;
    const std::vector<Tag> tags = {5, kReservedTags + 1, 0, kReservedTags - 1};
    const unsigned wildcards = seed % 4;
    MessageQueue<std::unique_ptr<int>> queue;
    std::vector<Expected> expected;
    for (int step = 0; step < 3000; ++step) {
      // Grows for a while, then shrinks, often to nothing.
      if (random() % 10 < (step / 400 % 2 == 0 ? 6U : 3U)) {
        const int source = static_cast<int>(random() % sources);
        const Tag tag = tags[random() % tags.size()];
        double arrival = static_cast<double>(random() % 20);
        for (const Expected& other : expected)
          if (other.source == source) arrival = std::max(arrival, other.arrival);
        queue.push(source, tag, arrival, std::make_unique<int>(step));
        expected.push_back({source, tag, arrival, step});
        continue;
      }
      int from = static_cast<int>(random() % sources);
      Tag tag = tags[random() % tags.size()];
      if (random() % 2 == 0 && !expected.empty()) {
        from = expected[random() % expected.size()].source;
      }
      if (random() % 4 < wildcards) from = kAnyRank;
      if (random() % 8 < wildcards) tag = kAnyTag;
      auto* const message = queue.find(from, tag);
      const std::size_t first = first_of(expected, from, tag);
      ASSERT_EQ(message == nullptr, first == expected.size());
      if (message == nullptr) continue;
      ASSERT_EQ(*message->payload, expected[first].value);
      ASSERT_EQ(message->source, expected[first].source);
      ASSERT_EQ(message->tag, expected[first].tag);
      ASSERT_EQ(*queue.take(message), expected[first].value);
      expected.erase(expected.begin() + static_cast<std::ptrdiff_t>(first));
    }
    std::vector<int> left, expected_left;
    for (const auto& value : queue.take_all()) left.push_back(*value);
    for (const Expected& one : expected) expected_left.push_back(one.value);
    std::sort(left.begin(), left.end());
    EXPECT_EQ(left, expected_left);
    EXPECT_EQ(queue.find(kAnyRank, kAnyTag), nullptr);
    queue.push(1, 2, 0, std::make_unique<int>(7));
    EXPECT_EQ(*queue.find(1, 2)->payload, 7);
  }  // and what is left when a queue ends is destroyed
}

}  // namespace
}  // namespace delray::comm::internal
