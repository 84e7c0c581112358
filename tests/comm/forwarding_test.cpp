// A wrapper that overrides nothing: every call reaches the communicator inside, with its arguments.
#include "comm/forwarding.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace delray::comm {
namespace {

// Writes down how it was called.
class Noted final : public Communicator {
 public:
  explicit Noted(std::vector<std::string>& calls) : calls_(calls) {}

  int rank() const override { return 3; }
  int size() const override { return 7; }
  int world_rank(int rank) const override { return 10 + rank; }
  double seconds() const override { return 2.5; }
  void send(int to, Tag tag, Buffer&& message) override {
    note("send", to, tag, static_cast<int>(message.size()));
  }
  void multicast(std::span<const int> to, Tag tag, Buffer&& message) override {
    note("multicast", static_cast<int>(to.size()), tag, static_cast<int>(message.size()));
  }
  void finish_sends() override { note("finish_sends", 0, 0, 0); }
  Buffer receive(int from, Tag tag) override {
    note("receive", from, tag, 0);
    return Buffer(5);
  }
  std::optional<Envelope> probe(int from, Tag tag, Deadline deadline) override {
    note("probe", from, tag, static_cast<int>(deadline.wait.count()));
    return Envelope{from, tag, 9};
  }
  std::unique_ptr<Communicator> split(int color, int key) override {
    note("split", color, key, 0);
    return std::make_unique<Noted>(calls_);
  }
  void mark(Phase phase, int round) override { note("mark", static_cast<int>(phase), round, 0); }
  void work(Work kind, std::uint64_t amount) override {
    note("work", static_cast<int>(kind), static_cast<int>(amount), 0);
  }
  [[noreturn]] void abort(std::string why) override { throw why; }

 private:
  void note(const char* call, int a, int b, int c) {
    calls_.push_back(std::string(call) + ' ' + std::to_string(a) + ' ' + std::to_string(b) + ' ' +
                     std::to_string(c));
  }
  std::vector<std::string>& calls_;
};

class Plain final : public ForwardingCommunicator {
 public:
  explicit Plain(Communicator& inner) : ForwardingCommunicator(inner) {}
  explicit Plain(std::unique_ptr<Communicator> inner) : ForwardingCommunicator(std::move(inner)) {}
};

void call_everything(Communicator& plain, std::vector<std::string>& calls) {
  EXPECT_EQ(plain.rank(), 3);
  EXPECT_EQ(plain.size(), 7);
  EXPECT_EQ(plain.world_rank(2), 12);
  EXPECT_EQ(plain.seconds(), 2.5);
  plain.send(1, 2, Buffer(4));
  const std::vector<int> to = {1, 2, 4};
  plain.multicast(to, 6, Buffer(8));
  plain.finish_sends();
  EXPECT_EQ(plain.receive(5, 6).size(), 5U);
  EXPECT_EQ(plain.probe(4, 3, Deadline::in(std::chrono::nanoseconds(11)))->bytes, 9U);
  EXPECT_EQ(plain.split(8, 9)->rank(), 3);
  plain.mark(Phase::gather, 2);
  plain.work(Work::rays, 40);
  EXPECT_THROW(plain.abort("why"), std::string);
  const std::vector<std::string> expected = {
      "send 1 2 4",
      "multicast 3 6 8",
      "finish_sends 0 0 0",
      "receive 5 6 0",
      "probe 4 3 11",
      "split 8 9 0",
      "mark " + std::to_string(static_cast<int>(Phase::gather)) + " 2 0",
      "work " + std::to_string(static_cast<int>(Work::rays)) + " 40 0"};
  EXPECT_EQ(calls, expected);
}

TEST(ForwardingCommunicator, EveryCallReachesTheOneInside) {
  std::vector<std::string> calls;
  Noted noted(calls);
  Plain plain(noted);
  call_everything(plain, calls);
}

TEST(ForwardingCommunicator, MayOwnTheOneInside) {
  std::vector<std::string> calls;
  Plain plain(std::make_unique<Noted>(calls));
  call_everything(plain, calls);
}

}  // namespace
}  // namespace delray::comm
