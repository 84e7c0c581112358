// What every scheme sends and composites of dense images, rank by rank, is what its closed form in
// docs/compositing.md says.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <map>
#include <string>

#include "comm/ledger.h"
#include "comm/recording.h"
#include "comm/simulated.h"
#include "composite/metadata_only.h"
#include "composite/scheme.h"
#include "composite/schemes/radices.h"

namespace delray::composite {
namespace {

// Of one rank, in pixels.
struct Counts {
  std::uint64_t sent = 0, received = 0, composited = 0;
  bool operator==(const Counts&) const = default;
};
std::ostream& operator<<(std::ostream& out, const Counts& counts) {
  return out << counts.sent << " sent, " << counts.received << " received, " << counts.composited
             << " composited";
}

struct Form {
  std::function<Counts(std::uint64_t a, int n, int rank)> counts;
  std::function<int(std::uint64_t a, int n)> rounds;
};

int power_below(int n) { return static_cast<int>(std::bit_floor(static_cast<unsigned>(n))); }
int log_below(int n) { return std::bit_width(static_cast<unsigned>(n)) - 1; }
int log_above(int n) { return std::bit_width(static_cast<unsigned>(n - 1)); }
std::uint64_t u(int i) { return static_cast<std::uint64_t>(i); }

Counts alike(std::uint64_t moved) { return {moved, moved, moved}; }
// A (1 - 1 / n), which every rank sends and merges where all own equal pieces.
Counts equal_pieces(std::uint64_t a, int n, int /*rank*/) { return alike(a - a / u(n)); }

Counts centralized(std::uint64_t a, int n, int rank) {
  const std::uint64_t merged = rank == 0 ? u(n - 1) * a : 0;
  return {rank > 0 ? a : 0, merged, merged};
}

Counts pipeline(std::uint64_t a, int n, int rank) {
  const std::uint64_t merged = rank < n - 1 ? a : 0;
  return {rank > 0 ? a : 0, merged, merged};
}

Counts tree(std::uint64_t a, int n, int rank) {
  std::uint64_t merged = 0;
  for (int distance = 1; distance < n && (rank & distance) == 0; distance *= 2) {
    if (rank + distance < n) merged += a;
  }
  return {rank > 0 ? a : 0, merged, merged};
}

Counts folded(std::uint64_t a, int n, int rank) {
  const int p = power_below(n);
  Counts counts = alike(a - a / u(p));
  if (rank >= 2 * (n - p)) return counts;
  if (rank % 2 == 1) return {a, 0, 0};
  counts.received += a;
  counts.composited += a;
  return counts;
}

Counts remainder(std::uint64_t a, int n, int rank) {
  Counts counts;
  for (; n > 1; n /= 2, rank /= 2) {
    const bool odd = n % 2 == 1;
    if (odd && rank == n - 1) {
      counts.sent += a;
      return counts;
    }
    a /= 2;
    const std::uint64_t merged = odd && rank >= n - 3 ? 2 * a : a;
    counts.sent += a;
    counts.received += merged;
    counts.composited += merged;
  }
  return counts;
}

Counts telescoping(std::uint64_t a, int n, int rank) {
  bool larger = false;
  int p = power_below(n);
  for (; rank >= p; larger = true) {
    rank -= p;
    n -= p;
    p = power_below(n);
  }
  const std::uint64_t swapped = a - a / u(p);
  const std::uint64_t merged = swapped + (n > p ? a / u(p) : 0);
  return {swapped + (larger ? a / u(p) : 0), merged, merged};
}

Counts two_three_four(std::uint64_t a, int n, int rank) {
  if (n == 1) return {};
  const int groups = power_below(n) / 2;
  int group = 0;
  while (rank >= (group + 1) * n / groups) ++group;
  const int first = group * n / groups, size = (group + 1) * n / groups - first;
  if (rank - first > 1) return {a, 0, 0};
  const std::uint64_t swapped = a / 2 - a / 2 / u(groups);
  const std::uint64_t merged = a / 2 * u(size - 1) + swapped;
  return {a / 2 + swapped, merged, merged};
}

struct Interval {
  std::uint64_t begin, end;
};

// The pieces that the ranks of a group own in the end, by rank; counts of all ranks are added up.
std::vector<Interval> two_three_swap(std::uint64_t a, int first, int count, int height,
                                     std::vector<Counts>& counts) {
  if (height == 0) return {{0, a}};
  const double most = std::pow(3, height - 1);
  const int parts = (count + 1) / 2 <= most ? 2 : 3;
  std::vector<Interval> before;
  for (int i = 0; i < parts; ++i) {
    const int begin = count * i / parts, end = count * (i + 1) / parts;
    for (const Interval& piece :
         two_three_swap(a, first + begin, end - begin, height - 1, counts)) {
      before.push_back(piece);
    }
  }
  std::vector<std::size_t> order(before.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t k) { return before[i].begin < before[k].begin; });
  std::vector<Interval> after(before.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t i = order[k];
    after[i] = {a * k / u(count), a * (k + 1) / u(count)};
    const std::uint64_t size = after[i].end - after[i].begin;
    const std::uint64_t low = std::max(before[i].begin, after[i].begin);
    const std::uint64_t kept = std::max(low, std::min(before[i].end, after[i].end)) - low;
    Counts& mine = counts[static_cast<std::size_t>(first) + i];
    mine.sent += before[i].end - before[i].begin - kept;
    mine.received += u(parts) * size - kept;
    mine.composited += u(parts - 1) * size;
  }
  return after;
}

Counts two_three_swap_of(std::uint64_t a, int n, int rank) {
  std::vector<Counts> counts(static_cast<std::size_t>(n));
  two_three_swap(a, 0, n, log_below(n), counts);
  return counts[static_cast<std::size_t>(rank)];
}

Counts bus(std::uint64_t a, int n, int rank) {
  const std::uint64_t merged = u(rank == 0 ? n - 1 : rank) * a;
  return {u(rank == 0 ? n - 1 : n - rank) * a, merged, merged};
}

Counts radix_k(std::uint64_t a, int n, int rank) {
  const internal::Radices plan = internal::choose_radices(n, {});
  const internal::RadixPlace place = internal::place_of(plan, rank);
  if (place.member < 0) return {a, 0, 0};
  const std::uint64_t exchanged = a - a / u(plan.members);
  const std::uint64_t merged = exchanged + u(place.extra) * (a / u(plan.block()));
  return {exchanged, merged, merged};
}

int radix_k_rounds(int n) {
  return static_cast<int>(internal::choose_radices(n, {}).radices.size());
}

int mesh_rounds(int n) {
  int columns = 1;
  for (int i = 2; i <= n; ++i) {
    if (n % i == 0 && std::abs(i - std::sqrt(n)) < std::abs(columns - std::sqrt(n))) columns = i;
  }
  return columns + n / columns - 2;
}

Counts tiles(std::uint64_t a, int n, int rank) {
  const std::uint64_t count = u(n) * std::clamp<std::uint64_t>(a / u(n) / 4096, 1, 16);
  std::uint64_t own = 0;
  for (std::uint64_t i = u(rank); i < count; i += u(n)) own += a * (i + 1) / count - a * i / count;
  return {a - own, u(n - 1) * own, u(n - 1) * own};
}

std::map<std::string, Form> forms() {
  const auto one = [](std::uint64_t, int n) { return n > 1 ? 1 : 0; };
  const auto below = [](std::uint64_t, int n) { return log_below(n); };
  const auto above = [](std::uint64_t, int n) { return log_above(n); };
  return {
      {"centralized", {centralized, one}},
      {"pipeline",
       {pipeline,
        [](std::uint64_t a, int n) {
          return n > 1 ? n - 2 + static_cast<int>(std::clamp<std::uint64_t>(a / 65536, 1, 64)) : 0;
        }}},
      {"tree", {tree, above}},
      {"binary-swap", {folded, above}},
      {"binary-swap:remainder", {remainder, below}},
      {"binary-swap:telescoping", {telescoping, above}},
      {"binary-swap:234", {two_three_four, below}},
      {"2-3-swap", {two_three_swap_of, below}},
      {"radix-k", {radix_k, [](std::uint64_t, int n) { return radix_k_rounds(n); }}},
      {"mesh", {equal_pieces, [](std::uint64_t, int n) { return mesh_rounds(n); }}},
      {"direct-send", {equal_pieces, one}},
      {"bus", {bus, [](std::uint64_t, int n) { return n > 1 ? n : 0; }}},
      {"tiles", {tiles, one}},
  };
}

constexpr std::size_t kBytes = kPixelBytes8;

TEST(ClosedForms, TellWhatEveryRankSendsAndComposites) {
  const auto all = forms();
  for (const Scheme& scheme : schemes()) {
    ASSERT_TRUE(all.contains(scheme.name)) << scheme.name;
    const Form& form = all.at(scheme.name);
    std::vector<int> rank_counts{32, 64};
    for (int n = 1; n <= 17; ++n) rank_counts.push_back(n);
    for (const int n : rank_counts) {
      SCOPED_TRACE(std::string(scheme.name) + ", " + std::to_string(n) + " ranks");
      // Divisible by all numbers of pieces, of which there are no more than ranks.
      const std::uint64_t a = n == 17 ? 342720 : n > 17 ? 181440 : 720720;
      std::vector<std::vector<comm::Event>> events(static_cast<std::size_t>(n));
      comm::run_simulated(n, {}, 1, [&](comm::Communicator& communicator) {
        comm::Recording recording(communicator,
                                  events[static_cast<std::size_t>(communicator.rank())]);
        scheme.compose(recording, make_metadata_only_dense(a, kBytes, false), {});
      });
      std::uint64_t sent = 0, composited = 0;
      for (int rank = 0; rank < n; ++rank) {
        const comm::Totals totals =
            comm::totals(events[static_cast<std::size_t>(rank)], rank, comm::Phase::compose);
        // A message of tiles is preceded by one of four bytes that tells its number.
        const bool numbered = std::string(scheme.name) == "tiles";
        const std::uint64_t sent_numbers = numbered ? totals.messages_sent / 2 * 4 : 0;
        const std::uint64_t got_numbers = numbered ? totals.messages_received / 2 * 4 : 0;
        const Counts counted{(totals.bytes_sent - sent_numbers) / kBytes,
                             (totals.bytes_received - got_numbers) / kBytes,
                             totals.work[static_cast<std::size_t>(comm::Work::pixels_composited)]};
        EXPECT_EQ(counted, form.counts(a, n, rank)) << "rank " << rank;
        EXPECT_EQ((totals.bytes_sent - sent_numbers) % kBytes, 0U);
        sent += counted.sent;
        composited += counted.composited;
      }
      EXPECT_GE(sent, u(n - 1) * a);
      EXPECT_GE(composited, u(n - 1) * a);
      EXPECT_EQ(comm::totals(comm::Ledger{events}, comm::Phase::compose).rounds,
                u(form.rounds(a, n)));
    }
  }
}

// Where all ranks listen to one bus that carries a pixel a second, it takes as many seconds as
// there are pixels in the images that travel: of `bus` one of each rank, however many listen.
TEST(ClosedForms, OverABusTheSchemeOfThatNameSendsEachImageOnce) {
  comm::Network network;
  network.latency = network.overhead = 0;
  network.seconds_per_byte = 1.0 / kBytes;
  network.topology.shape = comm::Shape::bus;
  network.seconds_per_work.fill(0);
  for (const std::string name : {"bus", "direct-send"}) {
    for (int n = 2; n <= 17; ++n) {
      SCOPED_TRACE(name + ", " + std::to_string(n) + " ranks");
      const std::uint64_t a = 720720;
      const std::vector<double> finished =
          comm::run_simulated(n, network, 1, [&](comm::Communicator& communicator) {
            compose(communicator, make_metadata_only_dense(a, kBytes, false), name);
          });
      const std::uint64_t images = name == "bus" ? u(n) : u(n - 1);
      // Before, ranks agree: three words from each in ceil(log2 n) rounds.
      const std::uint64_t agreement = u(n) * u(std::bit_width(u(n - 1))) * 24 / kBytes;
      EXPECT_NEAR(*std::max_element(finished.begin(), finished.end()),
                  static_cast<double>(images * a + agreement), 1);
    }
  }
}

}  // namespace
}  // namespace delray::composite
