// A communicator over functions of a program that keep messages in a queue and never wait.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <deque>
#include <map>
#include <utility>
#include <vector>

#include "icet/communicators.h"

namespace delray::icet {
namespace {

// What the two ranks of a test have in common.
struct Wires {
  std::map<std::pair<int, int>, std::deque<std::vector<char>>> messages;  // from, to
  int started = 0, waited_for = 0;
};

struct Table : IceTCommunicatorStruct {
  Table(Wires& all, int number) : IceTCommunicatorStruct{}, wires(all), rank(number) {
    Duplicate = [](IceTCommunicator self) -> IceTCommunicator {
      return new Table(of(self).wires, of(self).rank);
    };
    Destroy = [](IceTCommunicator self) { delete &of(self); };
    Comm_rank = [](IceTCommunicator self) { return of(self).rank; };
    Comm_size = [](IceTCommunicator) { return 2; };
    Isend = [](IceTCommunicator self, const void* buffer, int count, IceTEnum, int to, int) {
      const auto* const bytes = static_cast<const char*>(buffer);
      of(self).wires.messages[{of(self).rank, to}].emplace_back(bytes, bytes + count);
      ++of(self).wires.started;
      return new IceTCommRequestStruct{1, nullptr};
    };
    Recv = [](IceTCommunicator self, void* buffer, int count, IceTEnum, int from, int) {
      auto& queue = of(self).wires.messages[{from, of(self).rank}];
      ASSERT_FALSE(queue.empty()) << "a receive that would wait for ever";
      ASSERT_EQ(queue.front().size(), static_cast<std::size_t>(count));
      std::memcpy(buffer, queue.front().data(), queue.front().size());
      queue.pop_front();
    };
    Wait = [](IceTCommunicator self, IceTCommRequest* request) {
      ++of(self).wires.waited_for;
      delete *request;
      *request = nullptr;
    };
  }
  static Table& of(IceTCommunicator self) { return *static_cast<Table*>(self); }

  Wires& wires;
  int rank;
};

struct Two {
  Wires wires;
  Table first{wires, 0}, second{wires, 1};
  std::unique_ptr<comm::Communicator> ranks[2] = {make_program_communicator(&first),
                                                  make_program_communicator(&second)};
};

}  // namespace

TEST(ProgramCommunicator, TakesMessagesByTheirTags) {
  for (const int asked : {5, 6, 7}) {
    Two two;
    for (const int tag : {5, 6, 7}) two.ranks[1]->send(0, tag, comm::Buffer::of_value(tag * 100));
    EXPECT_EQ(two.ranks[0]->receive(1, asked).as<int>()[0], asked * 100);
    for (const int tag : {7, 6, 5}) {
      if (tag == asked) continue;
      EXPECT_EQ(two.ranks[0]->receive(1, tag).as<int>()[0], tag * 100) << "asked for " << asked;
    }
  }
}

TEST(ProgramCommunicator, KeepsTheOrderOfOneTag) {
  Two two;
  for (int i = 0; i < 20; ++i) two.ranks[1]->send(0, i % 3, comm::Buffer::of_value(i));
  for (int tag = 2; tag >= 0; --tag) {
    for (int i = tag; i < 20; i += 3) EXPECT_EQ(two.ranks[0]->receive(1, tag).as<int>()[0], i);
  }
}

TEST(ProgramCommunicator, FinishesSendsWhenAsked) {
  Two two;
  two.ranks[0]->send(1, 3, comm::Buffer(1000));
  two.ranks[0]->send(1, 4, comm::Buffer());
  EXPECT_EQ(two.wires.started, 3);  // two announcements, and bytes
  two.ranks[0]->finish_sends();
  EXPECT_EQ(two.wires.waited_for, 3);
  two.ranks[0]->finish_sends();
  EXPECT_EQ(two.wires.waited_for, 3);
}

}  // namespace delray::icet
