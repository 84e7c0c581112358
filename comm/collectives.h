// Collective operations of all ranks of a communicator, made of sends and receives.
//
// Every rank calls the same collectives in the same order. Every receive names its source, so the
// order in which messages arrive changes nothing: values are combined in one fixed order that
// depends on the number of ranks only, and floating-point sums are the same on every
// implementation. n is the number of ranks throughout, any n >= 1. A root, or receiver, that does
// not exist is a std::invalid_argument.
#pragma once

#include <functional>
#include <span>
#include <type_traits>
#include <vector>

#include "comm/communicator.h"

namespace delray::comm {

// Tags of collectives, from kReservedTags on; one each suffices because messages of one source and
// tag stay in order and every receive names its source.
enum ReservedTag : Tag {
  kTagBarrier = kReservedTags,
  kTagBroadcast,
  kTagGather,
  kTagAllGather,
  kTagReduce,
  kTagAllReduce,
  kTagScan,
  kTagExchangeHeaders,
  kTagExchange,
  kEndOfReservedTags,
};

// Returns once all ranks have called it. Dissemination (Hensgen, Finkel and Manber 1988): ceil(log2
// n) rounds.
void barrier(Communicator& communicator);

// Every rank gets root's message; the argument counts on root only. Binomial tree, ceil(log2 n)
// rounds.
Buffer broadcast(Communicator& communicator, int root, Buffer&& message);

// Root gets every rank's message, indexed by rank; others get nothing. Sizes may differ. Each
// message goes straight to root, so its bytes travel once.
std::vector<Buffer> gather(Communicator& communicator, int root, Buffer&& message);

// Every rank gets every rank's message, indexed by rank. Sizes may differ. ceil(log2 n) rounds
// (Bruck et al. 1997).
std::vector<Buffer> all_gather(Communicator& communicator, Buffer&& message);

// A message with its other end, for exchange.
struct Parcel {
  int rank = 0;  // the receiver on the way out, the sender on the way in
  Buffer message;
};

// Delivers every parcel; returns those for this rank, by ascending sender, those of one sender in
// the order in which it listed them. Who sends to whom is arbitrary: ceil(log2 n) rounds route the
// parcels' headers (Bruck et al. 1997), then each message goes straight to its receiver, the rank
// itself included.
std::vector<Parcel> exchange(Communicator& communicator, std::vector<Parcel>&& parcels);

// Replaces `lower` by lower combined with upper; the ranks whose values went into `lower` all
// precede those of `upper`.
using Combine = std::function<void(Buffer& lower, Buffer& upper)>;

// The untyped forms of what follows. Root's result is in the returned buffer; that of other ranks
// is unspecified.
Buffer reduce_buffers(Communicator& communicator, int root, Buffer&& mine, const Combine& combine);
Buffer all_reduce_buffers(Communicator& communicator, Buffer&& mine, const Combine& combine);
// Rank 0 gets an empty buffer, rank k what ranks 0 to k - 1 combine to.
Buffer exclusive_scan_buffers(Communicator& communicator, Buffer&& mine, const Combine& combine);

// An all_reduce during which a rank turns to other things. REQUIRES: it is finished before the
// rank calls another all_reduce; the communicator outlives it.
class AllReduce {
 public:
  // Sends what can be sent.
  AllReduce(Communicator& communicator, Buffer&& mine, Combine combine);
  // Takes in what has arrived, without waiting for more; whether that was all.
  bool advance() { return advance(Deadline::now()); }
  // Waits for the rest.
  Buffer finish();

 private:
  bool advance(Deadline deadline);
  void send_round();

  Communicator& communicator_;
  const Combine combine_;
  Buffer mine_;
  int partner_ = -1;  // whose message comes next; -1: none
  int step_ = 0;      // of the round at hand; 0: others are folded in first
};

// `op(lower, upper)` on each element.
template <class T, class Op>
Combine elementwise(const Op& op) {
  static_assert(std::is_trivially_copyable_v<T>);
  return [op](Buffer& lower, Buffer& upper) {
    const std::span<T> a = lower.as<T>();
    const std::span<const T> b = upper.as<T>();
    for (std::size_t i = 0; i < a.size(); ++i) a[i] = op(a[i], b[i]);
  };
}

// values[i] on root becomes op over all ranks' values[i], in ascending rank order; unchanged
// elsewhere. op is associative up to rounding. Same result as all_reduce, bit by bit. REQUIRES: all
// spans have one size.
template <class T, class Op>
void reduce(Communicator& communicator, int root, std::span<T> values, const Op& op) {
  const Buffer result = reduce_buffers(communicator, root, Buffer::of(std::span<const T>(values)),
                                       elementwise<T>(op));
  if (communicator.rank() == root && !values.empty()) {
    std::memcpy(values.data(), result.data(), result.size());
  }
}

// As reduce, with the result on every rank. Recursive doubling on the largest power of two, the
// other ranks folded in first and told last (Thakur, Rabenseifner and Gropp 2005): at most 2 + log2
// n rounds.
template <class T, class Op>
void all_reduce(Communicator& communicator, std::span<T> values, const Op& op) {
  const Buffer result =
      all_reduce_buffers(communicator, Buffer::of(std::span<const T>(values)), elementwise<T>(op));
  if (!values.empty()) std::memcpy(values.data(), result.data(), result.size());
}
template <class T, class Op>
T all_reduce_value(Communicator& communicator, T value, const Op& op) {
  all_reduce(communicator, std::span<T>(&value, 1), op);
  return value;
}

// values[i] of rank k becomes op over values[i] of ranks 0 to k - 1, `identity` on rank 0.
// ceil(log2 n) rounds (Hillis and Steele 1986).
template <class T, class Op>
void exclusive_scan(Communicator& communicator, std::span<T> values, const T& identity,
                    const Op& op) {
  const Buffer result = exclusive_scan_buffers(communicator, Buffer::of(std::span<const T>(values)),
                                               elementwise<T>(op));
  if (communicator.rank() == 0) {
    for (T& value : values) value = identity;
  } else if (!values.empty()) {
    std::memcpy(values.data(), result.data(), result.size());
  }
}

}  // namespace delray::comm
