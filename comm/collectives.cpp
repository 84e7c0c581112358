// Collective operations over point-to-point messages, each O(log n) rounds unless said otherwise.
//
// - barrier: dissemination, a message to the rank 1, 2, 4 ... further on (Hensgen, Finkel and
//   Manber 1988).
// - broadcast: a binomial tree.
// - gather: every message goes straight to the root, O(n) there.
// - all_gather: messages are collected in blocks of doubling size (Bruck et al. 1997).
// - exchange: headers are routed by the binary digits of their distance (Bruck et al. 1997), then
//   messages go straight to their receivers.
// - all_reduce: recursive doubling on a power of two of ranks, the others folded in first (Thakur,
//   Rabenseifner and Gropp 2005).
// - reduce: a binomial tree to rank 0 that makes the same combinations, then one message to the
//   root.
// - exclusive_scan: partial sums over doubling distances (Hillis and Steele 1986).
//
// Degenerate: a single rank sends nothing, but its parcels to itself.
#include "comm/collectives.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

namespace delray::comm {
namespace {

void check_rank(const Communicator& communicator, int rank) {
  if (rank < 0 || rank >= communicator.size()) {
    throw std::invalid_argument("rank " + std::to_string(rank) + " is none of " +
                                std::to_string(communicator.size()));
  }
}

// Several buffers in one: their number, their sizes, their bytes.
Buffer pack(std::span<const Buffer> buffers) {
  std::size_t size = sizeof(std::uint64_t) * (1 + buffers.size());
  for (const Buffer& buffer : buffers) size += buffer.size();
  Buffer packed(size);
  std::byte* out = packed.data();
  const auto put = [&out](const void* bytes, std::size_t count) {
    if (count > 0) std::memcpy(out, bytes, count);
    out += count;
  };
  const std::uint64_t count = buffers.size();
  put(&count, sizeof count);
  for (const Buffer& buffer : buffers) {
    const std::uint64_t bytes = buffer.size();
    put(&bytes, sizeof bytes);
  }
  for (const Buffer& buffer : buffers) put(buffer.data(), buffer.size());
  return packed;
}

std::vector<Buffer> unpack(const Buffer& packed) {
  const std::byte* in = packed.data();
  const auto take = [&in](void* bytes, std::size_t count) {
    if (count > 0) std::memcpy(bytes, in, count);
    in += count;
  };
  std::uint64_t count = 0;
  take(&count, sizeof count);
  std::vector<std::uint64_t> sizes(count);
  take(sizes.data(), count * sizeof(std::uint64_t));
  std::vector<Buffer> buffers;
  buffers.reserve(count);
  for (const std::uint64_t size : sizes) {
    Buffer& buffer = buffers.emplace_back(size);
    take(buffer.data(), size);
  }
  return buffers;
}

// Reductions work on the largest power of two of ranks: of the first 2 * extra ranks, each odd one
// hands its values to its left neighbour, which stands for both.
struct Fold {
  int n, power, extra;

  explicit Fold(int ranks)
      : n(ranks),
        power(static_cast<int>(std::bit_floor(static_cast<unsigned>(ranks)))),
        extra(ranks - power) {}

  bool is_folded(int rank) const { return rank < 2 * extra && rank % 2 == 1; }
  // Number among the ranks that take part, and back.
  int position(int rank) const { return rank < 2 * extra ? rank / 2 : rank - extra; }
  int rank_at(int where) const { return where < extra ? 2 * where : where + extra; }
};

// After this the ranks that are not folded hold all values.
void fold(Communicator& communicator, const Fold& f, Tag tag, Buffer& mine,
          const Combine& combine) {
  const int rank = communicator.rank();
  if (rank >= 2 * f.extra) return;
  if (f.is_folded(rank)) {
    communicator.send(rank - 1, tag, std::move(mine));
  } else {
    Buffer upper = communicator.receive(rank + 1, tag);
    combine(mine, upper);
  }
}

struct Header {
  std::int32_t source, destination;
};

// The senders of this rank's parcels, ascending, one for each parcel. A header that has d ranks to
// go travels by the powers of two in d; several headers share one message a round.
std::vector<int> route_headers(Communicator& communicator, std::span<const Parcel> parcels) {
  const int n = communicator.size(), rank = communicator.rank();
  std::vector<Header> held;
  held.reserve(parcels.size());
  for (const Parcel& parcel : parcels) held.push_back({rank, parcel.rank});
  for (int step = 1; step < n; step *= 2) {
    const auto stays = [&](const Header& header) {
      return (((header.destination - rank + n) % n) & step) == 0;
    };
    const auto leaving = std::stable_partition(held.begin(), held.end(), stays);
    communicator.send((rank + step) % n, kTagExchangeHeaders,
                      Buffer::of(std::span<const Header>(leaving, held.end())));
    held.erase(leaving, held.end());
    const Buffer arrived = communicator.receive((rank - step + n) % n, kTagExchangeHeaders);
    const std::span<const Header> headers = arrived.as<Header>();
    held.insert(held.end(), headers.begin(), headers.end());
  }
  std::vector<int> sources;
  sources.reserve(held.size());
  for (const Header& header : held) sources.push_back(header.source);
  std::sort(sources.begin(), sources.end());
  return sources;
}

}  // namespace

void barrier(Communicator& communicator) {
  const int n = communicator.size(), rank = communicator.rank();
  for (int step = 1; step < n; step *= 2) {
    communicator.send((rank + step) % n, kTagBarrier, Buffer());
    communicator.receive((rank - step + n) % n, kTagBarrier);
  }
}

Buffer broadcast(Communicator& communicator, int root, Buffer&& message) {
  check_rank(communicator, root);
  const int n = communicator.size();
  const int relative = (communicator.rank() - root + n) % n;
  int step = 1;
  // A rank hears from the one that differs in its lowest set bit, root from nobody.
  while (step < n && (relative & step) == 0) step *= 2;
  if (relative != 0) {
    message = communicator.receive((relative - step + root) % n, kTagBroadcast);
  }
  for (step /= 2; step >= 1; step /= 2) {
    if (relative + step < n) {
      communicator.send((relative + step + root) % n, kTagBroadcast, message.copy());
    }
  }
  return std::move(message);
}

std::vector<Buffer> gather(Communicator& communicator, int root, Buffer&& message) {
  check_rank(communicator, root);
  std::vector<Buffer> all;
  if (communicator.rank() != root) {
    communicator.send(root, kTagGather, std::move(message));
    return all;
  }
  all.resize(communicator.size());
  for (int rank = 0; rank < communicator.size(); ++rank) {
    all[rank] = rank == root ? std::move(message) : communicator.receive(rank, kTagGather);
  }
  return all;
}

std::vector<Buffer> all_gather(Communicator& communicator, Buffer&& message) {
  const int n = communicator.size(), rank = communicator.rank();
  std::vector<Buffer> held;  // held[i] is the message of rank + i
  held.reserve(n);
  held.push_back(std::move(message));
  for (int step = 1; step < n; step *= 2) {
    const auto count = static_cast<std::size_t>(std::min(step, n - step));
    communicator.send((rank - step + n) % n, kTagAllGather,
                      pack(std::span<const Buffer>(held).first(count)));
    for (Buffer& buffer : unpack(communicator.receive((rank + step) % n, kTagAllGather))) {
      held.push_back(std::move(buffer));
    }
  }
  std::rotate(held.begin(), held.begin() + (n - rank) % n, held.end());
  return held;
}

std::vector<Parcel> exchange(Communicator& communicator, std::vector<Parcel>&& parcels) {
  for (const Parcel& parcel : parcels) check_rank(communicator, parcel.rank);
  const std::vector<int> sources = route_headers(communicator, parcels);
  for (Parcel& parcel : parcels) {
    communicator.send(parcel.rank, kTagExchange, std::move(parcel.message));
  }
  std::vector<Parcel> arrived;
  arrived.reserve(sources.size());
  for (const int source : sources) {
    arrived.push_back({source, communicator.receive(source, kTagExchange)});
  }
  return arrived;
}

Buffer reduce_buffers(Communicator& communicator, int root, Buffer&& mine, const Combine& combine) {
  check_rank(communicator, root);
  const Fold f(communicator.size());
  const int rank = communicator.rank();
  fold(communicator, f, kTagReduce, mine, combine);
  if (!f.is_folded(rank)) {
    // A binomial tree to rank 0 makes the same combinations as recursive doubling; a tree to root
    // would not keep rank order.
    const int position = f.position(rank);
    for (int step = 1; step < f.power; step *= 2) {
      if (position & step) {
        communicator.send(f.rank_at(position - step), kTagReduce, std::move(mine));
        break;
      }
      Buffer upper = communicator.receive(f.rank_at(position + step), kTagReduce);
      combine(mine, upper);
    }
  }
  if (root != 0 && rank == 0) communicator.send(root, kTagReduce, std::move(mine));
  if (root != 0 && rank == root) mine = communicator.receive(0, kTagReduce);
  return std::move(mine);
}

AllReduce::AllReduce(Communicator& communicator, Buffer&& mine, Combine combine)
    : communicator_(communicator), combine_(std::move(combine)), mine_(std::move(mine)) {
  const Fold f(communicator_.size());
  const int rank = communicator_.rank();
  if (f.is_folded(rank)) {
    partner_ = rank - 1;
    communicator_.send(partner_, kTagAllReduce, std::move(mine_));
  } else if (rank < 2 * f.extra) {
    partner_ = rank + 1;
  } else {
    send_round();
  }
}

void AllReduce::send_round() {
  const Fold f(communicator_.size());
  const int rank = communicator_.rank();
  step_ = std::max(1, 2 * step_);
  partner_ = -1;
  if (step_ < f.power) {
    partner_ = f.rank_at(f.position(rank) ^ step_);
    communicator_.send(partner_, kTagAllReduce, mine_.copy());
  } else if (rank < 2 * f.extra) {
    communicator_.send(rank + 1, kTagAllReduce, mine_.copy());
  }
}

bool AllReduce::advance(Deadline deadline) {
  const Fold f(communicator_.size());
  const int rank = communicator_.rank();
  while (partner_ >= 0) {
    if (deadline.wait != Deadline::never().wait &&
        !communicator_.probe(partner_, kTagAllReduce, deadline))
      return false;
    Buffer theirs = communicator_.receive(partner_, kTagAllReduce);
    if (f.is_folded(rank)) {
      mine_ = std::move(theirs);
      partner_ = -1;
      return true;
    }
    if (step_ > 0 && (f.position(rank) & step_) != 0) std::swap(mine_, theirs);
    combine_(mine_, theirs);
    send_round();
  }
  return true;
}

Buffer AllReduce::finish() {
  advance(Deadline::never());
  return std::move(mine_);
}

Buffer all_reduce_buffers(Communicator& communicator, Buffer&& mine, const Combine& combine) {
  return AllReduce(communicator, std::move(mine), combine).finish();
}

Buffer exclusive_scan_buffers(Communicator& communicator, Buffer&& mine, const Combine& combine) {
  const int n = communicator.size(), rank = communicator.rank();
  Buffer before;  // of the ranks before this one that were heard of
  bool heard = false;
  for (int step = 1; step < n; step *= 2) {
    if (rank + step < n) communicator.send(rank + step, kTagScan, mine.copy());
    if (rank < step) continue;
    Buffer lower = communicator.receive(rank - step, kTagScan);
    Buffer sum = lower.copy();
    combine(sum, mine);
    mine = std::move(sum);
    if (heard) combine(lower, before);
    before = std::move(lower);
    heard = true;
  }
  return before;
}

}  // namespace delray::comm
