// Balances intervals of primitives by feedback: the work that a rank had is spread over the buckets
// of its interval in proportion to what was expected of them, and the intervals are cut anew at
// equal sums. Over some frames cuts narrow down where the work lies, finer than intervals are.
//
// Cuts stay while no rank has more than kKeep of an equal part, so that a camera at rest finds the
// same intervals. O(ranks + buckets) on rank 0.
//
// Degenerate: frames without any work leave the cuts; buckets without work keep a little, for the
// camera may come to see them.
#include "raster/distribute/primitive_shares.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "comm/collectives.h"

namespace delray::raster {
namespace {

constexpr std::size_t kBuckets = 1024;
constexpr double kKeep = 1.04;
constexpr double kLeast = 0.01;  // of the mean, that a bucket keeps

}  // namespace

std::uint64_t begin_of_equal_share(std::uint64_t all, int holders, int k) {
  const auto n = static_cast<std::uint64_t>(holders), i = static_cast<std::uint64_t>(k);
  return all / n * i + std::min(i, all % n);
}

bool PrimitiveShares::remembers(std::span<const Done> done, std::uint64_t primitives) const {
  if (cuts_.size() != done.size() + 1 || cuts_.back() != primitives) return false;
  for (std::size_t k = 0; k < done.size(); ++k)
    if (done[k].begin != cuts_[k] || done[k].end != cuts_[k + 1]) return false;
  return true;
}

void PrimitiveShares::learn(std::span<const Done> done) {
  const double per_bucket = static_cast<double>(cuts_.back()) / kBuckets;
  std::vector<double> learnt(kBuckets);
  for (const Done& of_rank : done) {
    if (of_rank.begin == of_rank.end) continue;
    const double begin = static_cast<double>(of_rank.begin) / per_bucket;
    const double end = static_cast<double>(of_rank.end) / per_bucket;
    const auto for_each_bucket = [&](auto&& f) {
      for (auto i = static_cast<std::size_t>(begin); i < kBuckets && static_cast<double>(i) < end;
           ++i) {
        const auto at = static_cast<double>(i);
        f(i, std::max(0.0, std::min(end, at + 1) - std::max(begin, at)) * work_of_bucket_[i]);
      }
    };
    double expected = 0;
    for_each_bucket([&](std::size_t, double part) { expected += part; });
    if (!(expected > 0)) continue;
    for_each_bucket(
        [&](std::size_t i, double part) { learnt[i] += part / expected * of_rank.work; });
  }
  const double mean = std::accumulate(learnt.begin(), learnt.end(), 0.0) / kBuckets;
  for (double& work : learnt) work = std::max(work, kLeast * mean);
  work_of_bucket_ = std::move(learnt);
}

void PrimitiveShares::cut() {
  const std::size_t ranks = cuts_.size() - 1;
  const double per_bucket = static_cast<double>(cuts_.back()) / kBuckets;
  const double all = std::accumulate(work_of_bucket_.begin(), work_of_bucket_.end(), 0.0);
  double before = 0;  // bucket i
  std::size_t i = 0;
  for (std::size_t k = 1; k < ranks; ++k) {
    const double wanted = all * static_cast<double>(k) / static_cast<double>(ranks);
    while (i + 1 < kBuckets && before + work_of_bucket_[i] < wanted) before += work_of_bucket_[i++];
    const double within = std::clamp((wanted - before) / work_of_bucket_[i], 0.0, 1.0);
    const double place = (static_cast<double>(i) + within) * per_bucket;
    cuts_[k] = std::clamp(static_cast<std::uint64_t>(place), cuts_[k - 1], cuts_.back());
  }
}

std::pair<std::uint64_t, std::uint64_t> PrimitiveShares::next(comm::Communicator& communicator,
                                                              std::uint64_t primitives) {
  if (communicator.size() == 1) return {0, primitives};
  const std::vector<comm::Buffer> gathered =
      comm::gather(communicator, 0, comm::Buffer::of_value(last_));
  comm::Buffer news;
  if (communicator.rank() == 0) {
    std::vector<Done> done;
    double sum = 0, most = 0;
    for (const comm::Buffer& from : gathered) {
      done.push_back(from.as<Done>()[0]);
      sum += done.back().work;
      most = std::max(most, done.back().work);
    }
    if (!remembers(done, primitives)) {
      cuts_.resize(done.size() + 1);
      for (int k = 0; k <= communicator.size(); ++k)
        cuts_[static_cast<std::size_t>(k)] =
            begin_of_equal_share(primitives, communicator.size(), k);
      work_of_bucket_.assign(kBuckets, 1);
    } else if (most * static_cast<double>(done.size()) > kKeep * sum) {
      learn(done);
      cut();
    }
    news = comm::Buffer::of(std::span<const std::uint64_t>(cuts_));
  }
  news = comm::broadcast(communicator, 0, std::move(news));
  const auto cuts = news.as<std::uint64_t>();
  const auto k = static_cast<std::size_t>(communicator.rank());
  last_ = {cuts[k], cuts[k + 1], 0};
  return {cuts[k], cuts[k + 1]};
}

}  // namespace delray::raster
