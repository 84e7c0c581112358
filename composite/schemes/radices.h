// The groups of radix-k: which rounds any number of ranks goes through.
#pragma once

#include <span>
#include <vector>

namespace delray::composite::internal {

// Ranks are divided into blocks of neighbours, each of `block()` members and, where the number of
// ranks is no product of small radices, some more that are spread over the blocks: those send their
// image to the members of their block, which hold a piece of it each by then, and are done.
struct Radices {
  std::vector<int> radices;  // round by round; none for a single rank
  int joined_rounds = 0;     // after so many a block is one group, and is joined by its extra ranks
  int members = 1;           // the product of all radices
  int ranks = 1;             // members and extra ranks

  int extra() const { return ranks - members; }
  int block() const;
  int blocks() const { return members / block(); }
  // First rank of a block, counted from 0 to blocks().
  int first_of(int block_number) const;
};

// Where a rank stands.
struct RadixPlace {
  int block = 0;
  int member = 0;      // from 0 to members; of an extra rank: -1
  int first_rank = 0;  // of the block
  int extra = 0;       // ranks of the block beyond its members, which are its last
};
RadixPlace place_of(const Radices& radices, int rank);
int rank_of(const Radices& radices, int member);

// Radices of at most `wished` each, round by round, of which the last is repeated; without any of
// at most 8. Of all numbers of members up to 1/8 below
// `ranks` (and the power of two below) that which is estimated to take the shortest, from messages,
// pixels merged and rounds. Some microseconds for each number that is tried, of which there are
// seldom more than 256.
//
// REQUIRES: ranks >= 1; every wish is >= 1 (1 counts as 2).
Radices choose_radices(int ranks, std::span<const int> wished);

}  // namespace delray::composite::internal
