// Balances intervals of primitives by feedback: ranks tell where in their interval their work lies,
// in segments of about equal work, and the intervals are cut anew. A primitive with more work than
// a segment is one of its own, so that cuts are beside it.
//
// Ranks get equal parts of what is left for them and those after them, or, where primitives of much
// work make that worse by more than kKeep than it can be, as much as the busiest must have: the
// least such bound is found by bisection (chains on chains: Pinar and Aykanat 2004). Cuts stay
// while no rank has more than kKeep of that bound, so that a camera at rest finds the same
// intervals. O((ranks + segments) * 40) on rank 0.
//
// Degenerate: frames without any work leave the cuts.
#include "raster/distribute/primitive_shares.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "comm/bad_message.h"
#include "comm/collectives.h"

namespace delray::raster {
namespace {

constexpr double kSegments = 1024;  // of all ranks together, to twice as many; or more by kFewest
constexpr double kKeep = 1.02;
constexpr double kFewest = 16;  // segments of a rank

// Primitives [begin, end) in order.
struct Chain {
  std::uint64_t begin, end;
  double work;
};

struct Filled {
  std::vector<std::uint64_t> cuts;
  double most = 0;  // work of a rank
};

// One rank after the other takes up to `most`, in equal parts if they fit. The last has the rest.
Filled fill(std::span<const Chain> chains, double all, std::size_t ranks, double most,
            bool in_equal_parts) {
  constexpr double kRounding = 1e-9;
  Filled result{{chains.front().begin}, 0};
  double left = all, of_chain = chains.front().work;  // and what of chain i is left
  std::size_t i = 0;
  for (std::size_t k = 1; k < ranks; ++k) {
    const double wanted =
        in_equal_parts ? std::min(left / static_cast<double>(ranks - k + 1), most) : most;
    double taken = 0;
    while (i < chains.size() && taken + of_chain <= wanted + kRounding * all) {
      taken += of_chain;
      of_chain = ++i < chains.size() ? chains[i].work : 0;
    }
    if (i < chains.size() && chains[i].end - chains[i].begin > 1) {
      of_chain -= wanted - taken;
      taken = wanted;
    } else if (i < chains.size() && taken + of_chain <= most && 2 * (wanted - taken) >= of_chain) {
      taken += of_chain;
      of_chain = ++i < chains.size() ? chains[i].work : 0;
    }
    std::uint64_t cut = chains.back().end;
    if (i < chains.size()) {
      const Chain& chain = chains[i];
      const double before = chain.work > 0 ? 1 - of_chain / chain.work : 0;
      cut = chain.begin +
            static_cast<std::uint64_t>(std::llround(std::clamp(before, 0.0, 1.0) *
                                                    static_cast<double>(chain.end - chain.begin)));
    }
    result.cuts.push_back(cut);
    result.most = std::max(result.most, taken);
    left -= taken;
  }
  result.cuts.push_back(chains.back().end);
  result.most = std::max(result.most, left);
  return result;
}

}  // namespace

std::uint64_t begin_of_equal_share(std::uint64_t all, int holders, int k) {
  const auto n = static_cast<std::uint64_t>(holders), i = static_cast<std::uint64_t>(k);
  return all / n * i + std::min(i, all % n);
}

void PrimitiveShares::measure(double work_each, double work_seen,
                              std::span<const std::uint64_t> seen) {
  last_.segments.clear();
  if (last_.begin == last_.end) return;
  const double all = work_each * static_cast<double>(last_.end - last_.begin) + work_seen;
  if (seen.empty() || !(all > 0)) {
    last_.segments.push_back({last_.end, all});
    return;
  }
  assert(std::ranges::is_sorted(seen) && last_.begin <= seen.front() && seen.back() < last_.end);
  const double work_sample = work_seen / static_cast<double>(seen.size());
  const double enough = all * std::min(ranks_ / kSegments, 1 / kFewest);
  std::uint64_t begin = last_.begin;
  double work = 0;  // of samples since then
  const auto end_at = [&](std::uint64_t end) {
    if (end > begin)
      last_.segments.push_back({end, work + work_each * static_cast<double>(end - begin)});
    begin = end;
    work = 0;
  };
  for (std::size_t i = 0, next = 0; i < seen.size(); i = next) {
    while (next < seen.size() && seen[next] == seen[i]) ++next;
    const double here = work_sample * static_cast<double>(next - i);
    if (here >= enough) end_at(seen[i]);
    work += here;
    if (work + work_each * static_cast<double>(seen[i] + 1 - begin) >= enough) end_at(seen[i] + 1);
  }
  end_at(last_.end);
}

bool PrimitiveShares::remembers(std::span<const Done> done, std::uint64_t primitives) const {
  if (cuts_.size() != done.size() + 1 || cuts_.back() != primitives) return false;
  for (std::size_t k = 0; k < done.size(); ++k) {
    const Done& of_rank = done[k];
    if (of_rank.begin != cuts_[k] || of_rank.end != cuts_[k + 1]) return false;
    const bool is_measured =
        !of_rank.segments.empty() && of_rank.segments.back().end == of_rank.end;
    if (of_rank.begin < of_rank.end && !is_measured) return false;
  }
  return true;
}

void PrimitiveShares::cut(std::span<const Done> done) {
  const std::size_t ranks = done.size();
  std::vector<Chain> chains;
  double all = 0, most = 0;
  for (const Done& of_rank : done) {
    double sum = 0;
    std::uint64_t begin = of_rank.begin;
    for (const Segment& segment : of_rank.segments) {
      comm::check_message(begin < segment.end && segment.end <= of_rank.end && segment.work >= 0);
      chains.push_back({begin, segment.end, segment.work});
      begin = segment.end;
      sum += segment.work;
    }
    all += sum;
    most = std::max(most, sum);
  }
  double low = all / static_cast<double>(ranks), high = all;
  if (most <= kKeep * low) return;
  constexpr int kHalvings = 40;
  for (int step = 0; step < kHalvings && high > (1 + 1e-6) * low; ++step) {
    const double middle = (low + high) / 2;
    (fill(chains, all, ranks, middle, false).most <= middle * (1 + 1e-9) ? high : low) = middle;
  }
  if (most <= kKeep * high) return;
  Filled filled = fill(chains, all, ranks, high, true);
  if (filled.most > kKeep * high) filled = fill(chains, all, ranks, high, false);
  cuts_ = std::move(filled.cuts);
}

std::pair<std::uint64_t, std::uint64_t> PrimitiveShares::next(comm::Communicator& communicator,
                                                              std::uint64_t primitives) {
  ranks_ = communicator.size();
  if (ranks_ == 1) return {0, primitives};
  std::vector<Segment> told{{last_.begin, 0}, {last_.end, 0}};
  told.insert(told.end(), last_.segments.begin(), last_.segments.end());
  const std::vector<comm::Buffer> gathered =
      comm::gather(communicator, 0, comm::Buffer::of(std::span<const Segment>(told)));
  comm::Buffer news;
  if (communicator.rank() == 0) {
    std::vector<Done> done;
    for (const comm::Buffer& from : gathered) {
      const auto segments = from.as<Segment>();
      comm::check_message(segments.size() >= 2);
      done.push_back({segments[0].end, segments[1].end, {segments.begin() + 2, segments.end()}});
    }
    if (remembers(done, primitives)) {
      cut(done);
    } else {
      cuts_.clear();
      for (int k = 0; k <= ranks_; ++k)
        cuts_.push_back(begin_of_equal_share(primitives, ranks_, k));
    }
    news = comm::Buffer::of(std::span<const std::uint64_t>(cuts_));
  }
  news = comm::broadcast(communicator, 0, std::move(news));
  const auto cuts = news.as<std::uint64_t>();
  const auto k = static_cast<std::size_t>(communicator.rank());
  last_ = {cuts[k], cuts[k + 1], {}};
  return {cuts[k], cuts[k + 1]};
}

}  // namespace delray::raster
