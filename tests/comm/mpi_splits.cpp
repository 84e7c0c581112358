// Splits over MPI: many communicators share one of MPI, and get one of their own where tags cannot
// tell more of them apart.
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <vector>

#include "comm/collectives.h"
#include "comm/mpi.h"
#include "comm/mpi/mpi_header.h"
#include "comm/mpi/shared_message.h"

namespace delray::comm {
namespace {

std::unique_ptr<Communicator> world_with(const MpiOptions& options) {
  const MPI_Comm all = MPI_COMM_WORLD;
  return make_mpi_communicator(&all, options);
}

int sum(Communicator& communicator, int value) {
  return all_reduce_value(communicator, value, std::plus<>());
}

// Every message of each communicator arrives there, though all have one tag.
void exchange_in_all(const std::vector<Communicator*>& communicators) {
  for (std::size_t i = 0; i < communicators.size(); ++i) {
    Communicator& c = *communicators[i];
    c.send((c.rank() + 1) % c.size(), 1, Buffer::of_value(i));
  }
  for (std::size_t i = communicators.size(); i-- > 0;) {
    EXPECT_EQ(communicators[i]->receive(kAnyRank, kAnyTag).as<std::size_t>()[0], i);
  }
}

void split_again_and_again(int most_contexts) {
  const auto world = world_with({.most_contexts = most_contexts});
  const auto halves = world->split(world->rank() % 2, -world->rank());
  const auto pairs = world->split(world->rank() / 2, 0);
  const auto same = halves->split(0, halves->rank());
  const auto alone = pairs->split(pairs->rank(), 0);
  EXPECT_EQ(alone->size(), 1);
  EXPECT_EQ(same->size(), halves->size());
  EXPECT_EQ(halves->world_rank(halves->rank()), world->rank());
  // The highest first.
  EXPECT_EQ(halves->world_rank(0),
            (world->size() - 1 - world->rank() % 2) / 2 * 2 + world->rank() % 2);
  exchange_in_all({world.get(), halves.get(), pairs.get(), same.get(), alone.get()});
}

TEST(MpiSplits, ShareACommunicatorOfMpi) { split_again_and_again(MpiOptions().most_contexts); }
TEST(MpiSplits, HaveTheirOwnWhereTagsDoNotTellThemApart) { split_again_and_again(0); }
TEST(MpiSplits, GoOnWithTheirOwnWhereTagsRunOut) {
  split_again_and_again(internal::kFirstSplitContext + 2);
}

// Some ranks have split, sent and gone on before others know of the new communicator.
TEST(MpiSplits, MessagesMayComeBeforeTheirCommunicatorIsThere) {
  const auto world = world_with({});
  for (int i = 0; i < 50; ++i) {
    const auto part = world->split(0, -world->rank());
    for (int to = 0; to < part->size(); ++to) part->send(to, i, Buffer::of_value(part->rank()));
    int all = 0;
    for (int k = 0; k < part->size(); ++k) all += part->receive(kAnyRank, i).as<int>()[0];
    EXPECT_EQ(all, part->size() * (part->size() - 1) / 2);
  }
}

TEST(MpiSplits, WhatNobodyReceivedIsNotTakenForAMessageOfTheNextOne) {
  const auto world = world_with({});
  for (const std::size_t bytes : {4, 5000, 100000}) {
    {
      const auto part = world->split(0, 0);
      part->send((part->rank() + 1) % part->size(), 1, Buffer(bytes));
      if (part->rank() == 0) barrier(*world);  // the others' messages come now or later
    }
    if (world->rank() != 0) barrier(*world);
    const auto next = world->split(0, 0);
    EXPECT_FALSE(next->probe(kAnyRank, kAnyTag, Deadline::in(std::chrono::milliseconds(2))));
    EXPECT_EQ(sum(*next, 1), world->size());
  }
}

// Options that differ are each rank's own affair.
TEST(MpiSplits, RanksMayDifferInPiecesAndInWhetherTheyShareMemory) {
  const int rank = [] {
    int number = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &number);
    return number;
  }();
  const auto world =
      world_with({.piece_bytes = rank % 2 == 0 ? std::size_t{1000} : std::size_t{1} << 30,
                  .share_memory = rank % 3 != 0});
  std::vector<std::uint32_t> values(100000, static_cast<std::uint32_t>(rank));
  world->send((rank + 1) % world->size(), 1, Buffer::of(std::span<const std::uint32_t>(values)));
  const int from = (rank + world->size() - 1) % world->size();
  const Buffer message = world->receive(from, 1);
  ASSERT_EQ(message.size(), values.size() * sizeof(std::uint32_t));
  for (const std::uint32_t value : message.as<std::uint32_t>()) {
    ASSERT_EQ(value, static_cast<std::uint32_t>(from));
  }
}

}  // namespace
}  // namespace delray::comm
